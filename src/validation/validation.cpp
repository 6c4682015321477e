#include "validation/validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"
#include "case/extent.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"

namespace ejecta {
namespace {

std::string reference_words(const ExpectSpec& e) {
  if (!e.text.empty()) return e.text;
  std::string words;
  if (e.tolerance || e.relative_tolerance) words = fmt::format("{:.6g}", e.reference);
  if (e.at_least) words += fmt::format("{}>= {:.6g}", words.empty() ? "" : ", ", *e.at_least);
  if (e.at_most) words += fmt::format("{}<= {:.6g}", words.empty() ? "" : ", ", *e.at_most);
  return words;
}

}  // namespace

Comparison compare(const ExpectSpec& e, const nlohmann::json& result) {
  Comparison c{.quantity = e.quantity,
               .computed = "missing",
               .reference = reference_words(e),
               .error = "",
               .source = e.source};
  const nlohmann::json::json_pointer pointer(e.quantity);
  if (!result.contains(pointer)) return c;
  const nlohmann::json& value = result.at(pointer);
  if (!e.text.empty()) {
    c.computed = value.is_string() ? value.get<std::string>() : value.dump();
    c.pass = c.computed == e.text;
    return c;
  }
  if (!value.is_number()) {
    c.computed = value.dump();
    return c;
  }
  const double computed = value.get<double>(), difference = computed - e.reference;
  c.computed = fmt::format("{:.6g}", computed);
  const bool about_reference = e.tolerance || e.relative_tolerance;
  if (about_reference)
    c.error = e.reference != 0.0 ? fmt::format("{:+.2f} %", 100.0 * difference / std::abs(e.reference))
                                 : fmt::format("{:+.3g}", difference);
  c.pass = std::isfinite(computed) && (!e.tolerance || std::abs(difference) <= *e.tolerance) &&
           (!e.relative_tolerance || std::abs(difference) <= *e.relative_tolerance * std::abs(e.reference)) &&
           (!e.at_least || computed >= *e.at_least) && (!e.at_most || computed <= *e.at_most);
  return c;
}

Comparison compare_series(const ExpectSpec& e, const std::vector<nlohmann::json>& results) {
  Comparison c = compare(e, results.back());
  std::vector<double> values;
  for (const nlohmann::json& r : results) {
    const nlohmann::json::json_pointer pointer(e.quantity);
    if (!r.contains(pointer) || !r.at(pointer).is_number()) return c;
    values.push_back(r.at(pointer).get<double>());
  }
  std::vector<std::string> words;
  for (double v : values) words.push_back(fmt::format("{:.5g}", v));
  c.series = joined(words, " -> ");
  if (e.converging)
    for (std::size_t i = 2; i < values.size(); ++i)
      c.pass = c.pass && std::abs(values[i] - values[i - 1]) < std::abs(values[i - 1] - values[i - 2]);
  return c;
}

Case refined(const Case& original, double factor) {
  Case c = original;
  refine(c.grid, factor);
  if (c.convergence.scale_time_step && c.run.time_step) *c.run.time_step /= factor;
  return c;
}

nlohmann::json with_orders(const std::vector<nlohmann::json>& results, const std::vector<double>& factors) {
  nlohmann::json combined = results.back();
  for (const nlohmann::json& r : results)
    combined["levels"].push_back(r.value("errors", nlohmann::json::object()));
  const nlohmann::json finest = results.back().value("errors", nlohmann::json::object());
  for (const auto& [name, unused] : finest.items()) {
    for (std::size_t i = 1; i < results.size(); ++i) {
      const auto error = [&](std::size_t level) {
        const nlohmann::json& e = combined["levels"][level];
        return e.contains(name) && e[name].is_number() ? e[name].get<double>() : std::nan("");
      };
      const double order = std::log(error(i - 1) / error(i)) / std::log(factors[i] / factors[i - 1]);
      combined["observed_orders"][name].push_back(order);
      combined["observed_order"][name] = order;
    }
  }
  return combined;
}

bool Validation::pass() const {
  return failure.empty() &&
         std::all_of(comparisons.begin(), comparisons.end(), [](const Comparison& c) { return c.pass; });
}

namespace {

/// The comparisons become part of the run's result and of its report.
void record(const std::filesystem::path& run_directory, const std::vector<Comparison>& comparisons) {
  const std::filesystem::path file = run_directory / "result.json";
  auto result = nlohmann::ordered_json::parse(output::read_file(file));
  result["expectations"] = nlohmann::ordered_json::array();
  for (const Comparison& c : comparisons)
    result["expectations"].push_back({{"quantity", c.quantity},
                                      {"computed", c.computed},
                                      {"reference", c.reference},
                                      {"source", c.source},
                                      {"error", c.error},
                                      {"pass", c.pass}});
  output::write_file(file, result.dump(2) + '\n');
  if (std::filesystem::exists(run_directory / "report.html")) output::write_report(run_directory);
}

void run_and_compare(const std::string& path, const std::filesystem::path& out, const Runner& runner,
                     Validation& v) {
  const Case c = runner.load(path);
  if (c.expects.empty()) throw InputError(fmt::format("{}: no [[expect]], nothing to compare with", path));
  const bool series = !c.convergence.factors.empty();
  const std::vector<double> factors = series ? c.convergence.factors : std::vector<double>{1.0};
  std::vector<nlohmann::json> results;
  std::filesystem::path last;
  for (double factor : factors) {
    last = out / fmt::format("{}{}.run", v.name, series ? fmt::format("-x{:g}", factor) : "");
    const auto result = runner.run(series ? refined(c, factor) : c, last);
    if (!result) {
      v.failure = "stopped";
      return;
    }
    results.emplace_back(*result);
  }
  if (series) results.back() = with_orders(results, factors);
  for (const ExpectSpec& e : c.expects)
    v.comparisons.push_back(series ? compare_series(e, results) : compare(e, results.front()));
  record(last, v.comparisons);
}

}  // namespace

Validation validate_case(const std::string& path, const std::string& name, const std::filesystem::path& out,
                         const Runner& runner) {
  Validation v{.name = name};
  const auto failed = [&](const char* how, const std::exception& e) {
    v.failure = how;
    v.message = e.what();
  };
  try {
    run_and_compare(path, out, runner, v);
  } catch (const InputError& e) {
    failed("bad input", e);
  } catch (const DivergedError& e) {
    failed("diverged", e);
  } catch (const std::exception& e) {
    failed("failed", e);
  }
  return v;
}

std::vector<Validation> validate_cases(const std::vector<std::filesystem::path>& files,
                                       const std::filesystem::path& out, const Runner& runner,
                                       const Note& note) {
  const std::vector<std::string> names = names_of(files);
  std::vector<Validation> done;
  for (std::size_t n = 0; n < files.size() && exit_code_of(done) != exit_stopped; ++n) {
    note(fmt::format("[{}/{}] {}", n + 1, files.size(), files[n].string()));
    done.push_back(validate_case(files[n].string(), names[n], out, runner));
  }
  return done;
}

ExitCode exit_code_of(const std::vector<Validation>& list) {
  if (!list.empty() && list.back().failure == "stopped") return exit_stopped;
  const bool pass = std::all_of(list.begin(), list.end(), [](const Validation& v) { return v.pass(); });
  return pass ? exit_done : exit_validation;
}

std::string validation_table(const std::vector<Validation>& list) {
  std::string text = fmt::format("{:<44} {:>14} {:>16} {:>11}  {:<4}  {}\n", "quantity", "computed",
                                 "reference", "error", "pass", "source");
  int failed = 0;
  for (const Validation& v : list) {
    failed += v.pass() ? 0 : 1;
    text +=
        fmt::format("{}{}\n", v.name, v.failure.empty() ? "" : fmt::format(": {}\n{}", v.failure, v.message));
    for (const Comparison& c : v.comparisons) {
      text += fmt::format("  {:<42} {:>14} {:>16} {:>11}  {:<4}  {}\n", c.quantity, c.computed, c.reference,
                          c.error, c.pass ? "yes" : "NO", c.source);
      if (!c.series.empty()) text += fmt::format("    grid by grid: {}\n", c.series);
    }
  }
  return text + fmt::format("{} of {} cases pass\n", static_cast<int>(list.size()) - failed, list.size());
}

}  // namespace ejecta
