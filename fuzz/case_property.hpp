#pragma once
#include <string>

#include "base/error.hpp"
#include "case/load.hpp"
#include "case/write.hpp"

namespace ejecta {

/// Whatever the bytes: a case is read, or refused with InputError. What was read can be written, and read
/// again to the same text. False if the second text differs; any other exception is a bug too.
inline bool case_survives(const std::string& bytes) {
  Case c;
  try {
    c = parse_case(bytes, "fuzz.toml");
  } catch (const InputError&) {
    return true;
  }
  const std::string once = write_case(c);
  return write_case(parse_case(once, "fuzz.toml")) == once;
}

}  // namespace ejecta
