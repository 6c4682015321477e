#pragma once
#include <string_view>

/// How this program was built; set by CMake (cmake/output.cmake).
namespace ejecta::output {

std::string_view version();       ///< e.g. "0.1.0"
std::string_view git_revision();  ///< `git describe` when the build was configured, or "unknown"
std::string_view compiler();      ///< e.g. "GNU 12.2.0"
std::string_view compile_flags();
std::string_view
kernels();  ///< processors these kernels are for, e.g. "x86-64-v3"; "native": of the building machine

}  // namespace ejecta::output
