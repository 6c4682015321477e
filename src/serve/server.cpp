#include "serve/server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/error.hpp"
#include "base/sha256.hpp"
#include "base/told.hpp"
#include "case/edit_text.hpp"
#include "case/template.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/results_table.hpp"
#include "serve/case_desk.hpp"
#include "serve/changes.hpp"
#include "serve/file_answer.hpp"
#include "serve/folder.hpp"
#include "serve/guard.hpp"
#include "serve/job_list.hpp"
#include "simulation/forecast.hpp"
#include "study/study.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;
using httplib::Request;
using httplib::Response;

constexpr int kThreads = 48;  ///< connections that are served at once
constexpr int kStreams = 32;  ///< of them with live events, each of which holds a thread
constexpr std::size_t kLargestText = 1 << 20, kLargestUpload = 64 << 20;
constexpr std::size_t kMostCompared = 50;
constexpr auto kBetweenLooks = std::chrono::seconds(1);  ///< so often a run says how far it is
constexpr int kShare = 200;  ///< looking at all of the folder takes at most so small a part of the time
constexpr auto kSignOfLife = std::chrono::seconds(5);

void answer(Response& response, const Json& json) {
  response.set_content(json.dump(-1, ' ', false, Json::error_handler_t::replace), "application/json");
}
void refuse(Response& response, int status, const std::string& why) {
  response.status = status;
  answer(response, {{"error", why}});
}

/// Something the page asks for contradicts what is there now.
struct Conflict : InputError {
  using InputError::InputError;
};

std::string text_of(const Json& body, const char* name) {
  if (!body.is_object() || !body.contains(name) || !body[name].is_string())
    throw InputError(fmt::format("the request has no \"{}\"", name));
  return body[name];
}

/// A whole number. One that is too large for an `int` is refused, not cut to what fits.
int number_of(const Json& body, const char* name) {
  if (!body.is_object() || !body.contains(name) || !body[name].is_number_integer())
    throw InputError(fmt::format("the request has no whole number \"{}\"", name));
  const std::string digits = body[name].dump();
  int number = 0;
  if (std::from_chars(digits.data(), digits.data() + digits.size(), number).ec != std::errc())
    throw InputError(fmt::format("{} cannot be the number \"{}\"", digits, name));
  return number;
}

}  // namespace

struct Workbench::Parts {
  Folder folder;
  JobList jobs;
  httplib::Server server;
  int port;
  Guard guard;
  double bandwidth = measured_bandwidth();
  std::atomic<int> streams{0}, temporary_files{0};

  // The folder as it was last looked at; who waits for events is woken when something has changed.
  std::mutex mutex;
  std::condition_variable changed, wanted;
  Changes changes;
  bool ends = false;
  bool look_now = true;  ///< before anybody asks: results of a thousand runs take a moment to read
  std::thread looks, serves;

  explicit Parts(const ServeOptions& o)
      : folder(o.folder), jobs(folder, o.program), port(bind(o.port)), guard(port) {
    set_limits();
    set_guard();
    add_pages();
    add_comparisons();
    add_cases();
    add_jobs();
    looks = std::thread([this] { keep_looking(); });
    serves = std::thread([this] { server.listen_after_bind(); });
  }

  ~Parts() {
    {
      const std::lock_guard lock(mutex);
      ends = true;
    }
    changed.notify_all();
    wanted.notify_all();
    while (!server.is_running()) std::this_thread::yield();  // stop() before it has begun is lost
    server.stop();
    looks.join();
    serves.join();
  }

  int bind(int wanted) {
    const int got = wanted == 0                                ? server.bind_to_any_port("127.0.0.1")
                    : server.bind_to_port("127.0.0.1", wanted) ? wanted
                                                               : -1;
    if (got < 0)
      throw InputError(fmt::format(
          "port {} is taken\n  expected: a free one, or none: then any free one is used", wanted));
    return got;
  }

  void set_limits() {
    server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    server.set_payload_max_length(kLargestUpload);
    server.set_read_timeout(5);
    server.set_write_timeout(5);
    server.set_keep_alive_timeout(2);  // an idle connection holds a thread
    server.set_tcp_nodelay(true);
    server.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                                {"X-Frame-Options", "DENY"},
                                {"Referrer-Policy", "no-referrer"},
                                {"Cache-Control", "no-store"}});
  }

  void set_guard() {
    server.set_pre_routing_handler([this](const Request& request, Response& response) {
      using Handled = httplib::Server::HandlerResponse;
      const std::string why = guard.refusal({.host = request.get_header_value("Host"),
                                             .origin = request.get_header_value("Origin"),
                                             .cookies = request.get_header_value("Cookie"),
                                             .token = request.get_param_value("token")});
      if (why.empty() && request.ranges.empty()) return Handled::Unhandled;
      if (why.empty()) refuse(response, 400, "parts of files are asked for with ?from=BYTE");
      else refuse(response, 403, why);
      return Handled::Handled;
    });
    server.set_exception_handler([](const Request&, Response& response, std::exception_ptr p) {
      try {
        std::rethrow_exception(p);
      } catch (const Conflict& e) {
        refuse(response, 409, told(e));
      } catch (const InputError& e) {
        refuse(response, 400, told(e));
      } catch (const nlohmann::json::exception&) {
        refuse(response, 400, "the request is not of the form that the page sends (JSON)");
      } catch (const std::exception& e) {
        refuse(response, 500, e.what());
      }
    });
  }

  /// Handles a request whose body is a JSON object.
  template <class Act>
  void post(const char* path, const Act& act) {
    server.Post(path, [act](const Request& request, Response& response) {
      if (request.body.size() > kLargestText)
        return refuse(response, 413, "too large: a case has at most 1 MB");
      answer(response, act(Json::parse(request.body)));
    });
  }

  void add_pages() {
    server.Get("/", [this](const Request& request, Response& response) {
      if (request.has_param("token")) {  // out of the address, so that it is in no history or screenshot
        response.set_header("Set-Cookie", fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/",
                                                      guard.cookie_name(), guard.token()));
        return response.set_redirect("/", 303);
      }
      response.set_header(
          "Content-Security-Policy",
          "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
          "connect-src 'self'; base-uri 'none'; form-action 'none'");
      const std::string_view page = workbench_page();
      if (page.empty())
        return refuse(response, 501, "this program was built without its page (npm was not there)");
      response.set_content(page.data(), page.size(), "text/html; charset=utf-8");
    });
    // Files of jobs. A page among them may not ask this server in the name of whoever looks at it.
    // ?from=BYTE: what has come behind that byte.
    server.Get(R"(/files/(.+))", [this](const Request& request, Response& response) {
      const std::filesystem::path file = folder.inside(request.matches[1]);
      if (!is_shown(file)) return refuse(response, 404, "there is no such file");
      response.set_header("Content-Security-Policy", "sandbox allow-scripts allow-downloads");
      send_file(file, request.get_param_value("from"), response);
    });
  }

  /// Runs laid over each other in one page, and their results as tables:
  /// /runs/compare.html?run=a.run&run=b.run
  void add_comparisons() {
    const auto chosen = [this](const Request& request) {
      std::vector<std::filesystem::path> all;
      const auto [begin, end] = request.params.equal_range("run");
      for (auto it = begin; it != end; ++it) {
        all.push_back(folder.inside(it->second));
        if (!std::filesystem::exists(all.back() / "result.json"))
          throw InputError(fmt::format("{} has no result", it->second));
      }
      if (all.empty() || all.size() > kMostCompared)
        throw InputError(fmt::format("choose up to {} runs", kMostCompared));
      return all;
    };
    server.Get("/runs/compare.html", [this, chosen](const Request& request, Response& response) {
      response.set_header("Content-Security-Policy", "sandbox allow-scripts allow-downloads");
      response.set_content(written([&](const auto& file) { output::write_report(chosen(request), file); }),
                           "text/html; charset=utf-8");
    });
    server.Get("/runs/results.csv", [chosen](const Request& request, Response& response) {
      response.set_header("Content-Disposition", "attachment; filename=\"results.csv\"");
      response.set_content(output::csv_text(output::results_table(chosen(request))),
                           "text/csv; charset=utf-8");
    });
    server.Get("/runs/results.xlsx", [this, chosen](const Request& request, Response& response) {
      const std::string book =
          written([&](const auto& file) { output::write_workbook(chosen(request), file); });
      response.set_header("Content-Disposition", "attachment; filename=\"results.xlsx\"");
      response.set_content(book, "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet");
    });
  }

  /// What write(file) puts into a file that is there for a moment only.
  template <class Write>
  std::string written(const Write& write) {
    const auto file = std::filesystem::temp_directory_path() /
                      fmt::format("ejecta-{}-{}", guard.token().substr(0, 16), ++temporary_files);
    struct Removed {
      std::filesystem::path file;
      ~Removed() {
        std::error_code none;
        std::filesystem::remove(file, none);
      }
    } const removed{file};
    write(file);
    return output::read_file(file);
  }

  void add_cases() {
    server.Get("/api/schema", [schema = form_of_schema().dump()](const Request&, Response& response) {
      response.set_content(schema, "application/json");
    });
    server.Get("/api/cases", [this](const Request&, Response& response) {
      answer(response, {{"folder", folder.path().string()}, {"cases", folder.content().cases}});
    });
    post("/api/open", [this](const Json& body) {
      const std::string text = read_case(text_of(body, "name"));
      return Json{{"text", text}, {"digest", sha256_hex(text)}};
    });
    post("/api/new", [this](const Json& body) {
      const std::string name = text_of(body, "name");
      require_file_name(name, ".toml");
      const auto file = folder.inside(name);
      if (std::filesystem::exists(file)) throw Conflict(fmt::format("there is a case {} already", name));
      const std::string text = case_template(template_kinds().front().name);
      output::write_file(file, text);
      return Json{{"text", text}, {"digest", sha256_hex(text)}};
    });
    post("/api/copy", [this](const Json& body) {
      const std::string name = text_of(body, "name"), copy = text_of(body, "copy");
      const std::string text = read_case(name);
      require_file_name(copy, ".toml");
      // Beside it: what it names, it finds there.
      const auto file = folder.inside((std::filesystem::path(name).parent_path() / copy).string());
      if (std::filesystem::exists(file)) throw Conflict(fmt::format("there is a case {} already", copy));
      output::write_file(file, text);
      return Json{{"name", file.lexically_relative(folder.path()).string()}};
    });
    // Saves only over what the page has seen: another page or an editor may have changed it.
    post("/api/save", [this](const Json& body) {
      const std::string name = text_of(body, "name"), text = text_of(body, "text");
      const auto file = folder.inside(name);
      require_file_name(file.filename().string(), ".toml");
      if (sha256_hex(read_case(name)) != text_of(body, "digest"))
        throw Conflict(fmt::format("{} was changed elsewhere since it was opened here", name));
      output::write_file(file, text);
      return Json{{"digest", sha256_hex(text)}};
    });
    post("/api/check", [this](const Json& body) {
      return judge_case(text_of(body, "text"), folder.inside(text_of(body, "name")).string(), bandwidth);
    });
    post("/api/set", [](const Json& body) {
      const std::string text = text_of(body, "text"), key = text_of(body, "key");
      if (body.value("remove", false)) return Json{{"text", without_key(text, key)}};
      return Json{{"text", with_key(text, key, text_of(body, "value"))}};
    });
    // A shape comes to lie beside the case that is to have it.
    server.Post("/api/upload", [this](const Request& request, Response& response) {
      const std::string name = request.get_param_value("name");
      require_file_name(name, ".stl");
      const std::filesystem::path beside = folder.inside(request.get_param_value("case")).parent_path();
      const auto file = folder.inside((beside / name).lexically_relative(folder.path()).string());
      const Json size = extent_of_stl(request.body, name);
      if (!std::filesystem::exists(file)) output::write_file(file, request.body);
      else if (output::read_file(file) != request.body)
        throw Conflict(fmt::format("there is another file {} already", name));
      answer(response, {{"name", name}, {"extent", size}});
    });
  }

  std::string read_case(const std::string& name) const {
    const auto file = folder.inside(name);
    if (file.extension() != ".toml" || !std::filesystem::is_regular_file(file))
      throw InputError(fmt::format("there is no case {}", name));
    return output::read_file(file);
  }

  void add_jobs() {
    server.Get("/api/jobs",
               [this](const Request&, Response& response) { answer(response, jobs.all(folder.content())); });
    server.Get("/api/study", [this](const Request& request, Response& response) {
      answer(response, study_result(TaskStore::open(folder.inside(request.get_param_value("name")))));
    });
    post_job("/api/start", [this](const Json& body) {
      return Json{{"job", jobs.start(text_of(body, "case"), text_of(body, "kind"))}};
    });
    post_job("/api/resume", [this](const Json& body) {
      jobs.resume(text_of(body, "job"));
      return Json::object();
    });
    post_job("/api/stop", [this](const Json& body) {
      jobs.stop(text_of(body, "job"));
      return Json::object();
    });
    post_job("/api/remove", [this](const Json& body) {
      jobs.remove(text_of(body, "job"));
      return Json::object();
    });
    post_job("/api/at-once", [this](const Json& body) {
      jobs.set_at_once(number_of(body, "count"));
      return Json::object();
    });
    server.Get("/api/events", [this](const Request&, Response& response) {
      if (++streams > kStreams) {
        --streams;
        return refuse(response, 503, "too many pages are open");
      }
      look_soon();
      auto seen = std::make_shared<std::int64_t>(0);
      response.set_chunked_content_provider(
          "text/event-stream",
          [this, seen](std::size_t, httplib::DataSink& sink) { return send_event(*seen, sink); },
          [this](bool) { --streams; });
    });
  }

  /// What changes the jobs: pages are told at once.
  template <class Act>
  void post_job(const char* path, const Act& act) {
    post(path, [this, act](const Json& body) {
      const Json done = act(body);
      look_soon();
      return done;
    });
  }

  /// What has changed since the last event, else a word now and then by which a closed page is noticed.
  bool send_event(std::int64_t& seen, httplib::DataSink& sink) {
    std::string event = ":\n\n";
    {
      std::unique_lock lock(mutex);
      changed.wait_for(lock, kSignOfLife, [&] { return ends || changes.version() != seen; });
      if (ends) return false;
      if (changes.version() != seen) event = "data: " + changes.since(seen) + "\n\n";
      seen = changes.version();
    }
    return sink.write(event.data(), event.size());
  }

  void look_soon() {
    {
      const std::lock_guard lock(mutex);
      look_now = true;
    }
    wanted.notify_all();
  }

  /// Each second at what goes on; at the whole folder as often as that costs little, or when it is asked for.
  void keep_looking() {
    using Clock = std::chrono::steady_clock;
    Folder::Content content;
    Clock::time_point all_due{};
    std::unique_lock lock(mutex);
    while (!ends) {
      wanted.wait_for(lock, kBetweenLooks, [&] { return ends || look_now; });
      const auto begins = Clock::now();
      const bool asked = look_now, all = asked || begins >= all_due;
      look_now = false;
      lock.unlock();
      Json now, rest;
      try {
        jobs.advance();
        if (streams > 0 || asked) {
          if (all) content = folder.content();
          now = jobs.all(content, all);
          if (all) all_due = Clock::now() + kShare * (Clock::now() - begins);
          rest = jobs.settings();
          rest["trouble"] = "";
          rest["folder"] = folder.path().string();
          rest["cases"] = content.cases;
        }
      } catch (const std::exception& e) {  // the folder cannot be read just now, or its queue
        rest = {{"trouble", e.what()}};
      }
      lock.lock();
      if (!rest.empty() && changes.look(now, rest)) changed.notify_all();
    }
  }
};

Workbench::Workbench(const ServeOptions& options) : parts_(std::make_unique<Parts>(options)) {}
Workbench::~Workbench() = default;

std::string Workbench::address() const {
  return fmt::format("http://127.0.0.1:{}/?token={}", parts_->port, parts_->guard.token());
}

}  // namespace ejecta
