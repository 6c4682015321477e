#pragma once
#include <functional>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "case/problem.hpp"

namespace ejecta {

/// What rooms that know more than the case alone have against it; asked when nothing else is wrong.
using FurtherChecks = std::function<std::vector<Problem>(const Case&)>;

/// Reads the case file, applies `overrides` ("run.end_time=8 ms", "body.0.velocity=[...]"; list elements by
/// number or name), fills in what follows from other keys and checks the sense of it. Throws InputError that
/// lists all errors of the file, each with its line. What is only unlikely to be meant goes to `warnings`.
Case load_case(const std::string& path, const std::vector<std::string>& overrides = {},
               std::vector<Problem>* warnings = nullptr, const FurtherChecks& further = {});

/// The same from a text; `name` stands for the path in messages.
Case parse_case(const std::string& text, const std::string& name,
                const std::vector<std::string>& overrides = {}, std::vector<Problem>* warnings = nullptr,
                const FurtherChecks& further = {});

/// The same for who shows a case that may be wrong: as far as it can be read, with what is wrong in
/// `problems`.
Case examine_case(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                  std::vector<Problem>& problems, std::vector<Problem>* warnings = nullptr,
                  const FurtherChecks& further = {});

/// The tree of a case file with `overrides` applied, for those who resolve many variations of it. Throws
/// InputError with all that is no TOML.
Node case_tree(const std::string& path, const std::vector<std::string>& overrides = {});
/// The case of a tree, as load_case resolves it; `problems` gets what is wrong with it, `warnings` what is
/// only unlikely to be meant.
Case resolve_case(const Node& root, const std::string& name, std::vector<Problem>& problems,
                  const FurtherChecks& further = {}, std::vector<Problem>* warnings = nullptr);

/// The folder of the case file, to which the names of files in it are relative.
std::string folder_of(const Case& c);

/// The path of a file named in the case.
std::string beside_case(const Case& c, const std::string& file);

/// The same case with the names of its files made absolute, so that it can be read from another folder.
Case with_absolute_files(Case c);
/// The files that a case names (meshes, traces, paths, the jet's case and what that names and extends,
/// measured curves), each once, by absolute paths.
std::vector<std::string> files_of(const Case& c);

}  // namespace ejecta
