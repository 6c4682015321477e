#include "app/campaign.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/exit_code.hpp"
#include "app/signals.hpp"
#include "base/error.hpp"
#include "case/load.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/verdict.hpp"
#include "simulation/body_checks.hpp"

namespace ejecta {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_a_run(CampaignKind kind) { return kind == CampaignKind::run || kind == CampaignKind::jet; }

/// One command of a campaign and the directory that it fills.
class CampaignPart {
 public:
  CampaignPart(const Case& campaign, std::size_t number, const fs::path& out)
      : spec_(campaign.campaign.parts[number]), file_(beside_case(campaign, spec_.file)) {
    const Case c = load_checked(file_, spec_.set);
    title_ = !spec_.title.empty() ? spec_.title : !c.run.title.empty() ? c.run.title : c.path;
    if (spec_.kind == CampaignKind::map && !c.map.enabled) refuse(number, "has no [map]");
    if (spec_.kind == CampaignKind::study && !c.study.enabled) refuse(number, "has no [study]");
    if (c.campaign.enabled) refuse(number, "is a campaign itself");
    directory_ = out / fmt::format("{:02}-{}", number + 1, fs::path(file_).stem().string());
  }

  const fs::path& directory() const { return directory_; }

  bool is_done() const {
    const Json r = result();
    if (!r.is_object()) return false;
    return spec_.kind != CampaignKind::map || r.value("state", "") != "running";
  }

  /// Goes on with what the directory holds; `anew`: from the beginning.
  std::vector<std::string> words(bool anew) const {
    std::vector<std::string> words{"ejecta", spec_.kind == CampaignKind::jet_sweep ? "jet" : word()};
    if (spec_.kind == CampaignKind::jet_sweep) words.push_back("--sweep");
    words.push_back(file_);
    for (const std::string& set : spec_.set) {
      words.push_back("--set");
      words.push_back(set);
    }
    words.push_back("--out");
    words.push_back(directory_.string());
    std::error_code none;
    const bool begun = fs::exists(directory_, none);
    const bool resumes = is_a_run(spec_.kind) && !fs::is_empty(directory_ / "checkpoints", none) && !none;
    if (begun && !anew && resumes) words.push_back("--resume");
    else if (begun && (anew || is_a_run(spec_.kind) || spec_.kind == CampaignKind::jet_sweep))
      words.push_back("--force");
    return words;
  }

  /// For the report; `run`: its number among the runs of the page.
  Json entry(const std::string& problem, int run) const {
    Json e{{"kind", word()},           {"title", title_},
           {"figures", spec_.figures}, {"directory", directory_.filename().string()},
           {"done", is_done()},        {"problem", problem}};
    if (!is_done()) return e;
    Json r = result();
    if (is_a_run(spec_.kind)) {
      e["run"] = run;
      e["summary"] = output::verdict_sentence(r);
      return e;
    }
    if (r.contains("summary")) e["summary"] = r["summary"];
    if (r.contains("runs"))  // which lie in the directory of their map or study
      for (Json& one : r["runs"])
        if (one.contains("directory"))
          one["directory"] = directory_.filename().string() + "/" + one["directory"].get<std::string>();
    e["result"] = std::move(r);
    return e;
  }

 private:
  std::string word() const {
    switch (spec_.kind) {
      case CampaignKind::run:
        return "run";
      case CampaignKind::jet:
        return "jet";
      case CampaignKind::jet_sweep:
        return "jet-sweep";
      case CampaignKind::map:
        return "map";
      case CampaignKind::study:
        break;
    }
    return "study";
  }
  Json result() const {
    std::error_code none;
    const fs::path path = directory_ / "result.json";
    return fs::exists(path, none) ? Json::parse(output::read_file(path), nullptr, false) : Json();
  }
  [[noreturn]] void refuse(std::size_t number, const std::string& why) const {
    throw InputError(fmt::format("part {} of the campaign: {} {}", number + 1, file_, why));
  }

  const CampaignPartSpec& spec_;
  std::string file_, title_;
  fs::path directory_;
};

/// Runs this program with these words, which has the terminal; what asks us to stop asks it too. Its exit
/// code.
int run_this_program(std::vector<std::string> words, const SignalWatch& signals) {
  std::vector<char*> argv;
  for (std::string& w : words) argv.push_back(w.data());
  argv.push_back(nullptr);
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  const pid_t child = ::fork();
  if (child < 0) throw Error(fmt::format("cannot start a process: {}", std::strerror(errno)));
  if (child == 0) {
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
  }
  bool asked = false;
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (signals.stop_requested() && !asked) {
      ::kill(child, SIGTERM);
      asked = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (asked) return exit_stopped;
  return WIFEXITED(status) ? WEXITSTATUS(status) : exit_failure;
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& w : words) {
    const bool plain = w.find_first_of(" \"'$\\") == std::string::npos;
    line += (line.empty() ? "" : " ") + (plain ? w : "'" + w + "'");
  }
  return line;
}

}  // namespace

std::string check_campaign(const Case& c) {
  std::string text = fmt::format("{}: {} parts\n", c.path, c.campaign.parts.size());
  for (std::size_t n = 0; n < c.campaign.parts.size(); ++n)
    text += "  " + shell_line(CampaignPart(c, n, "").words(true)) + "\n";
  return text;
}

int run_campaign(const CampaignOptions& o) {
  const Case c = load_checked(o.path);
  if (!c.campaign.enabled)
    throw InputError(
        fmt::format("{} has no [campaign]\n  expected: the cases that belong to it\n"
                    "  example:  [[campaign.part]] kind = \"run\", case = \"10mm-cubic.toml\"",
                    o.path));
  const std::string name = fs::path(o.path).stem().string();
  const fs::path out = o.out.empty() ? name + ".campaign" : o.out;
  std::vector<CampaignPart> parts;
  for (std::size_t n = 0; n < c.campaign.parts.size(); ++n) parts.emplace_back(c, n, out);
  std::vector<std::string> problems(parts.size());

  const auto report = [&] {
    std::vector<fs::path> runs;
    Json entries = Json::array();
    for (std::size_t n = 0; n < parts.size(); ++n) {
      entries.push_back(parts[n].entry(problems[n], static_cast<int>(runs.size())));
      if (entries.back().contains("run")) runs.push_back(parts[n].directory());
    }
    const std::string title = c.campaign.title.empty() ? name : c.campaign.title;
    const Json campaign{{"title", title}, {"kind", "campaign"}, {"parts", entries}};
    output::write_file(out / "result.json", campaign.dump(2) + "\n");
    output::write_campaign_report(campaign, runs, out / "report.html");
  };

  int code = exit_done;
  SignalWatch signals;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    if (parts[n].is_done() && !o.force) continue;
    std::vector<std::string> words = parts[n].words(o.force);
    if (o.print_commands) {
      fmt::print("{}\n", shell_line(words));
      continue;
    }
    fs::create_directories(out);
    if (!o.quiet) fmt::print(stderr, "part {} of {}: {}\n", n + 1, parts.size(), shell_line(words));
    if (o.quiet) words.push_back("--quiet");
    const int end = run_this_program(words, signals);
    if (end == exit_stopped) {
      if (fs::exists(out / "result.json") || parts[n].is_done()) report();
      fmt::print(stderr, "stopped; go on with the same command\n");
      return exit_stopped;
    }
    if (end != exit_done && end != exit_undecided) {
      problems[n] = fmt::format("ended with exit code {}", end);
      fmt::print(stderr, "part {} {}; the others go on\n", n + 1, problems[n]);
      if (code == exit_done) code = end;
    }
    report();
  }
  if (o.print_commands) return exit_done;
  fs::create_directories(out);
  report();
  if (!o.quiet)
    fmt::print("results: {}\nreport:  {}\n", (out / "result.json").string(), (out / "report.html").string());
  return code;
}

}  // namespace ejecta
