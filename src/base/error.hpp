#pragma once
#include <stdexcept>
#include <string>

namespace ejecta {

/// Library code throws these with context (key, file:line, value, unit); only app/ turns them into exit
/// codes.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The user's input is wrong: exit code 2.
struct InputError : Error {
  using Error::Error;
};

/// The computation left the realm of numbers: exit code 3. The message says where, when and what to try.
struct DivergedError : Error {
  using Error::Error;
};

}  // namespace ejecta
