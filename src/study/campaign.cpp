#include "study/campaign.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/exit_code.hpp"
#include "base/shell_word.hpp"
#include "case/load.hpp"
#include "case/words.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/verdict.hpp"

namespace ejecta {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_a_run(CampaignKind kind) { return kind == CampaignKind::run || kind == CampaignKind::jet; }

/// One command of a campaign and the directory that it fills.
class CampaignPart {
 public:
  CampaignPart(const Case& campaign, std::size_t number, const fs::path& out, const CampaignHands& hands)
      : spec_(campaign.campaign.parts[number]), file_(beside_case(campaign, spec_.file)) {
    const Case c = hands.load(file_, spec_.set);
    title_ = !spec_.title.empty() ? spec_.title : !c.run.title.empty() ? c.run.title : c.path;
    if (spec_.kind == CampaignKind::map && !c.map.enabled) refuse(number, "has no [map]");
    if (spec_.kind == CampaignKind::study && !c.study.enabled) refuse(number, "has no [study]");
    if (spec_.kind == CampaignKind::sort && !c.sorter.enabled) refuse(number, "has no [sorter]");
    if (spec_.kind == CampaignKind::run && c.sorter.enabled)
      refuse(number, "is a whole sorter: kind = \"sort\"");
    if (c.campaign.enabled) refuse(number, "is a campaign itself");
    directory_ = out / fmt::format("{:02}-{}", number + 1, fs::path(file_).stem().string());
  }

  const fs::path& directory() const { return directory_; }

  bool is_done() const { return is_finished(result()); }

  /// Goes on with what the directory holds; `anew`: from the beginning.
  std::vector<std::string> words(bool anew) const {
    std::vector<std::string> words{"ejecta",
                                   spec_.kind == CampaignKind::jet_sweep ? "jet" : word(spec_.kind)};
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
    Json r = result();
    const bool done = is_finished(r);
    Json e{{"kind", word(spec_.kind)},
           {"title", title_},
           {"figures", spec_.figures},
           {"directory", directory_.filename().string()},
           {"done", done},
           {"problem", problem}};
    if (!done) return e;
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
  bool is_finished(const Json& r) const {
    return r.is_object() && (spec_.kind != CampaignKind::map || r.value("state", "") != "running");
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

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& w : words) line += (line.empty() ? "" : " ") + shell_word(w);
  return line;
}

}  // namespace

std::string check_campaign(const Case& c, const CampaignHands& hands) {
  std::string text = fmt::format("{}: {} parts\n", c.path, c.campaign.parts.size());
  for (std::size_t n = 0; n < c.campaign.parts.size(); ++n)
    text += "  " + shell_line(CampaignPart(c, n, "", hands).words(true)) + "\n";
  return text;
}

int run_campaign(const Case& c, const CampaignOptions& o, const CampaignHands& hands) {
  const std::string name = fs::path(c.path).stem().string();
  std::vector<CampaignPart> parts;
  for (std::size_t n = 0; n < c.campaign.parts.size(); ++n) parts.emplace_back(c, n, o.out, hands);
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
    fs::create_directories(o.out);
    output::write_file(o.out / "result.json", campaign.dump(2) + "\n");
    output::write_campaign_report(campaign, runs, o.out / "report.html");
  };

  int failed = exit_done;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    if (parts[n].is_done() && !o.force) continue;
    std::vector<std::string> words = parts[n].words(o.force);
    if (o.print_commands) {
      hands.result(shell_line(words));
      continue;
    }
    fs::create_directories(o.out);
    hands.note(fmt::format("part {} of {}: {}", n + 1, parts.size(), shell_line(words)));
    if (o.quiet) words.push_back("--quiet");
    const int end = hands.command(words);
    if (end == exit_stopped) {
      report();
      return exit_stopped;
    }
    if (end != exit_done && end != exit_undecided) {
      problems[n] = fmt::format("ended with exit code {}", end);
      hands.note(fmt::format("part {} {}; the others go on", n + 1, problems[n]));
      if (failed == exit_done) failed = end;
    }
    report();
  }
  if (o.print_commands) return exit_done;
  report();
  hands.result(fmt::format("results: {}\nreport:  {}", (o.out / "result.json").string(),
                           (o.out / "report.html").string()));
  return failed;
}

}  // namespace ejecta
