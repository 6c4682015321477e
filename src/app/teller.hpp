#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace ejecta {

void print_note(const std::string& line);    ///< to the terminal, beside what was asked for
void print_result(const std::string& line);  ///< what was asked for

/// This program, to be started again.
std::filesystem::path this_program();

/// Says every few seconds how far something is: over its last line on a terminal, else below it.
class Teller {
 public:
  explicit Teller(bool quiet);
  void tell(const std::function<std::string()>& line, bool last = false);

 private:
  bool quiet_, terminal_;
  double said_;
};

}  // namespace ejecta
