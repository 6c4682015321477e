#pragma once
#include <stdexcept>
#include <string>
#include <utility>

namespace ejecta {

/// Library code throws these with context (key, file:line, value, unit); only app/ turns them into exit
/// codes.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What helps to mend an input. Empty parts are not shown.
struct Advice {
  std::string key{};       ///< of what the message is about: "exponents" of a body
  std::string expected{};  ///< what would be right
  std::string example{};   ///< a line that works
};

/// The user's input is wrong: exit code 2.
struct InputError : Error {
  explicit InputError(const std::string& what, Advice help = {}) : Error(what), advice(std::move(help)) {}
  Advice advice;
};

/// The computation left the realm of numbers: exit code 3. The message says where, when and what to try.
struct DivergedError : Error {
  using Error::Error;
};

}  // namespace ejecta
