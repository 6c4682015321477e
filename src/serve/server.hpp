#pragma once
#include <filesystem>
#include <memory>
#include <string>

namespace ejecta {

struct ServeOptions {
  std::filesystem::path folder = ".";
  std::filesystem::path program;  ///< `ejecta`, which runs the cases
  int port = 0;                   ///< 0: any that is free
};

/// The workbench: a page in the browser of this machine, and what it asks for. Serves from the moment it is
/// made until it goes; runs that it started go on.
class Workbench {
 public:
  /// Throws InputError where the folder is none or the port is taken.
  explicit Workbench(const ServeOptions& options);
  ~Workbench();
  Workbench(const Workbench&) = delete;
  Workbench& operator=(const Workbench&) = delete;

  /// To open in the browser: with the token that nobody else knows.
  std::string address() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The page that was built into the program, or empty.
std::string_view workbench_page();

}  // namespace ejecta
