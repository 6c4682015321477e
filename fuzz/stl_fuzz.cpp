// Feeds arbitrary bytes to the STL reader (libFuzzer). Whatever the bytes, they are either refused with
// InputError or become a solid whose mass properties are finite; everything else is a finding.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "base/error.hpp"
#include "shape/shape.hpp"
#include "shape/stl.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const ejecta::Shape shape = ejecta::make_mesh(ejecta::parse_stl(bytes, 1e-3, "fuzz"), "fuzz");
    const ejecta::MassProperties& m = shape.mass_properties();
    if (!(m.volume > 0) || !m.inertia.allFinite() || !m.centre.allFinite()) std::abort();
  } catch (const ejecta::InputError&) {
    // Refused with a message: what a broken file deserves.
  }
  return 0;
}
