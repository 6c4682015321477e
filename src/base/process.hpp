#pragma once
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ejecta {

/// Starts a program: words[0], then its arguments; with a `log` it gets nothing to read and writes its errors
/// there, else it has our terminal. Whoever kills us asks it to stop. Its id; throws Error where there is no
/// process to be had. It ends with 127 where there is no such program.
pid_t start_process(std::vector<std::string> words, const std::filesystem::path& log = {});

/// Starts a program that has our terminal and waits for its end: its exit code (ExitCode). What asks us to
/// stop asks it too.
int run_process(std::vector<std::string> words, const std::function<bool()>& stop);

}  // namespace ejecta
