#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "case_property.hpp"

/// For libFuzzer (cmake/fuzz.cmake).
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (!ejecta::case_survives(std::string(reinterpret_cast<const char*>(data), size))) std::abort();
  return 0;
}
