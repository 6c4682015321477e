#include "serve/guard.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>

#include "base/error.hpp"

namespace ejecta {
namespace {

std::string random_token() {
  std::array<unsigned char, 24> bytes;
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Error("the system gives no random numbers");
  std::string token;
  for (const unsigned char b : bytes) token += fmt::format("{:02x}", b);
  return token;
}

/// The value of a cookie of that name.
std::string cookie(const std::string& all, const std::string& name) {
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find(';', at), all.size());
    std::size_t begin = all.find_first_not_of(' ', at);
    if (begin < end && all.compare(begin, name.size() + 1, name + "=") == 0)
      return all.substr(begin + name.size() + 1, end - begin - name.size() - 1);
    at = end + 1;
  }
  return "";
}

}  // namespace

Guard::Guard(int port) : port_(port), token_(random_token()) {}

std::string Guard::cookie_name() const { return fmt::format("ejecta-{}", port_); }

bool Guard::is_token(const std::string& given) const {
  if (given.size() != token_.size()) return false;
  unsigned differ = 0;  // in the same time wherever they differ
  for (std::size_t n = 0; n < given.size(); ++n)
    differ |= static_cast<unsigned char>(given[n]) ^ static_cast<unsigned char>(token_[n]);
  return differ == 0;
}

std::string Guard::refusal(const Request& request) const {
  bool here = false, own_page = request.origin.empty();
  for (const char* name : {"127.0.0.1", "localhost"}) {
    here = here || request.host == fmt::format("{}:{}", name, port_);
    own_page = own_page || request.origin == fmt::format("http://{}:{}", name, port_);
  }
  if (!here) return "this server answers on this machine only";
  if (!own_page) return "pages of other sites may not ask this server";
  if (!is_token(request.token) && !is_token(cookie(request.cookies, cookie_name())))
    return "open the address that `ejecta serve` printed: it has a token that lets you in";
  return "";
}

}  // namespace ejecta
