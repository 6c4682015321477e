#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "serve/server.hpp"

/// For libFuzzer (cmake/fuzz.cmake): what anybody might send to the workbench. An input begins with what it
/// is:
///   G PATH                    somebody with the token gets PATH
///   P PATH, newline, BODY     and posts BODY there
///   R BYTES                   as they are; TOKEN and PORT in them are those of the server
/// It must go on serving, touch nothing outside its folder and give away nothing from there.
namespace ejecta {

std::string_view workbench_page() { return ""; }

namespace {

namespace fs = std::filesystem;

constexpr const char* kSecret = "what lies outside is nobody's business";
constexpr const char* kCase =
    "[run]\nend_time = \"1 ms\"\n[flow]\nsolver = \"none\"\n[[body]]\nname = \"ball\"\n";

[[noreturn]] void fail(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  std::abort();
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

std::string read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class Target {
 public:
  Target() : outside_(fs::temp_directory_path() / ("ejecta-http-fuzz-" + std::to_string(::getpid()))) {
    fs::create_directories(folder());
    write(outside_ / "secret.toml", kSecret);
    tidy();
    workbench_ = std::make_unique<Workbench>(ServeOptions{.folder = folder(), .program = "/bin/true"});
    const std::string address = workbench_->address();
    const std::size_t colon = address.rfind(':'), slash = address.find('/', colon);
    port_ = address.substr(colon + 1, slash - colon - 1);
    token_ = address.substr(address.find("token=") + 6);
    static const fs::path left = outside_;
    std::atexit([] {
      std::error_code none;
      fs::remove_all(left, none);
    });
  }

  std::string ask(const std::string& input) {
    if (input.empty()) return "";
    const std::string rest = input.substr(1);
    if (input[0] == 'G') return send("GET " + rest.substr(0, rest.find('\n')) + head() + "\r\n");
    if (input[0] == 'P') {
      const std::size_t line = std::min(rest.find('\n'), rest.size());
      const std::string body = line < rest.size() ? rest.substr(line + 1) : "";
      return send("POST " + rest.substr(0, line) + head() + "Content-Length: " + std::to_string(body.size()) +
                  "\r\n\r\n" + body);
    }
    return send(replaced(replaced(rest, "TOKEN", token_), "PORT", port_), true);
  }

  void look(const std::string& input, const std::string& answer) {
    // libFuzzer puts what is compared into its inputs, and some answers repeat what was asked.
    if (answer.find(kSecret) != std::string::npos && input.find(kSecret) == std::string::npos)
      fail("it gave away what lies outside");
    if (++looks_ % 64 != 0) return;
    std::string alive;
    for (int tries = 0; (alive = ask("G/api/cases")).find(" 200 ") == std::string::npos; ++tries)
      if (tries == 100) fail("it does not serve any more: " + alive + trouble_);
    for (const auto& entry : fs::directory_iterator(outside_))
      if (entry.path() != folder() && entry.path().filename() != "secret.toml")
        fail("it wrote " + entry.path().string());
    if (read(outside_ / "secret.toml") != kSecret) fail("it wrote outside");
    if (looks_ % 4096 == 0) tidy();
  }

 private:
  fs::path folder() const { return outside_ / "folder"; }
  std::string head() const {
    return " HTTP/1.1\r\nHost: 127.0.0.1:" + port_ + "\r\nCookie: ejecta-" + port_ + "=" + token_ +
           "\r\nConnection: close\r\n";
  }

  void tidy() {
    for (const auto& entry : fs::directory_iterator(folder())) fs::remove_all(entry.path());
    write(folder() / "ball.toml", kCase);
    fs::create_symlink(outside_ / "secret.toml", folder() / "link.toml");
    fs::create_directories(folder() / "old.run");
    write(folder() / "old.run" / "manifest.json", R"({"case": "ball.toml"})");
    write(folder() / "old.run" / "result.json", R"({"title": "old"})");
  }

  static std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
      text.replace(at, what.size(), by);
    return text;
  }

  /// Its answer, or what came of it in a moment. `cut`: nothing more will come.
  std::string send(const std::string& bytes, bool cut = false) {
    const int connection = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(port_)));
    const timeval moment{0, 300000};
    ::setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &moment, sizeof moment);
    ::setsockopt(connection, SOL_SOCKET, SO_SNDTIMEO, &moment, sizeof moment);
    sockaddr_in from{};  // another each time: a port that was used rests for a minute
    from.sin_family = AF_INET;
    from.sin_addr.s_addr = htonl(INADDR_LOOPBACK + ++connections_ % 60000);
    ::bind(connection, reinterpret_cast<const sockaddr*>(&from), sizeof from);
    trouble_.clear();
    if (::connect(connection, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
      trouble_ = std::string("no connection: ") + std::strerror(errno);
      ::close(connection);
      return "";
    }
    std::size_t sent = 0;
    while (sent < bytes.size()) {
      const ssize_t n = ::send(connection, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) break;
      sent += static_cast<std::size_t>(n);
    }
    if (cut) ::shutdown(connection, SHUT_WR);  // httplib says nothing to who has hung up half way
    std::string answer;
    char piece[16384];
    ssize_t got = 0;
    while (answer.size() < (1U << 18) && (got = ::recv(connection, piece, sizeof piece, 0)) > 0)
      answer.append(piece, static_cast<std::size_t>(got));
    if (answer.empty())
      trouble_ = got == 0 ? "it hangs up" : std::string("no answer: ") + std::strerror(errno);
    ::close(connection);
    return answer;
  }

  fs::path outside_;
  std::unique_ptr<Workbench> workbench_;
  std::string port_, token_;
  std::string trouble_;  ///< of the last request, where it had no answer
  std::uint64_t looks_ = 0;
  std::uint32_t connections_ = 0;
};

}  // namespace
}  // namespace ejecta

/// The library itself is built without sanitizers, and does not mark what its containers leave free.
extern "C" const char* __asan_default_options() { return "detect_container_overflow=0:detect_leaks=0"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static ejecta::Target& target = *new ejecta::Target;
  const std::string input(reinterpret_cast<const char*>(data), size);
  target.look(input, target.ask(input));
  return 0;
}
