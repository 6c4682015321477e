#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/exit_code.hpp"
#include "base/text.hpp"
#include "case/case.hpp"

namespace ejecta {

/// One [[expect]] against one result.
struct Comparison {
  std::string quantity, computed, reference, error, source;
  std::string series{};  ///< the values on successive grids, if there are several
  bool pass = false;
};
/// Every criterion that is given must hold; a missing quantity, null or NaN never passes.
Comparison compare(const ExpectSpec& expect, const nlohmann::json& result);

/// The same against the results of successive grids, coarse first: the finest is compared, and its change
/// from grid to grid must shrink where the expectation says so.
Comparison compare_series(const ExpectSpec& expect, const std::vector<nlohmann::json>& results);

/// The case with the cells of every axis times `factor` (an axis of one cell stays) and, if [convergence]
/// says so, a fixed time step divided by it. Throws InputError when a block would not get a whole number of
/// cells.
Case refined(const Case& c, double factor);

/// Adds to the finest result what the series shows: "levels" (the "errors" of each grid), "observed_orders"
/// (between successive grids) and "observed_order" (between the two finest), by the names under "errors":
/// order = log(e_coarse / e_fine) / log(factor ratio).
nlohmann::json with_orders(const std::vector<nlohmann::json>& results, const std::vector<double>& factors);

/// How a case becomes a result, handed in by who knows how to run it.
struct Runner {
  std::function<Case(const std::string& path)> load;
  /// Into a run directory: what its result.json says. Nothing where the run was stopped.
  std::function<std::optional<nlohmann::ordered_json>(const Case&, const std::filesystem::path& directory)>
      run;
};

struct Validation {
  std::string name;
  std::string failure{};  ///< "bad input", "diverged", "stopped" or "failed"; empty: it ran
  std::string message{};  ///< why it failed
  std::vector<Comparison> comparisons{};
  bool pass() const;
};
/// Runs one case, all its grids, into directories NAME.run or NAME-xFACTOR.run below `out`, and compares it.
/// The comparisons become part of the last result.json and of its report. Errors are kept in the result: the
/// cases after it are run all the same.
Validation validate_case(const std::string& path, const std::string& name, const std::filesystem::path& out,
                         const Runner& runner);

/// The same for each of these files, in order, until one is stopped; `note` hears of each.
std::vector<Validation> validate_cases(const std::vector<std::filesystem::path>& files,
                                       const std::filesystem::path& out, const Runner& runner,
                                       const Note& note);
ExitCode exit_code_of(const std::vector<Validation>& list);

/// The case files meant by `names`: a file, a directory, or part of the name of a shipped case; none: all
/// shipped ones that expect something. Throws InputError for a name that means nothing.
std::vector<std::filesystem::path> validation_cases(const std::vector<std::string>& names,
                                                    const std::filesystem::path& shipped);
/// A name for each file: its own, with as many folders before it as tell it from the others, "dem-settling".
std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files);
/// Where cases/, validation/ and verification/ are: $EJECTA_SHARE, or share/ejecta in the nearest folder
/// above the library, which is that of its installation or its build.
std::filesystem::path shipped_cases();
/// The file that a name means: that file, else the shipped case of that name ("tutorial").
std::string case_file(const std::string& given);

/// Quantity, computed, reference, error, pass, source; a line each.
std::string validation_table(const std::vector<Validation>& list);

}  // namespace ejecta
