#pragma once
#include <CLI/CLI.hpp>
#include <string>

/// The words of the command line, its help and the schema as other programs take them.
namespace ejecta {

/// ejecta(1), in roff.
std::string man_page(const CLI::App& program);

/// Completion for bash: commands, their options, keys of --set, topics of `explain`, kinds of `new`.
std::string bash_completion(const CLI::App& program);

}  // namespace ejecta
