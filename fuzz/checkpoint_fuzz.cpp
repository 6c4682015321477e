// Feeds arbitrary bytes to the checkpoint reader (libFuzzer). Whatever the bytes, the reader either reads
// them or throws Error; everything else is a finding. Damaged content never reaches HDF5, whose own parser is
// not made for hostile files: the seal is checked first.
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "output/checkpoint.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int fd = ::memfd_create("checkpoint", 0);
  static const std::string path = fmt::format("/proc/self/fd/{}", fd);
  if (::ftruncate(fd, 0) != 0 || ::pwrite(fd, data, size, 0) != static_cast<ssize_t>(size)) std::abort();
  try {
    const ejecta::output::CheckpointReader reader(path);
    std::vector<double> bodies(reader.size("bodies"));
    reader.get("bodies", std::span<double>(bodies));
    std::vector<float> field(reader.size("flow/velocity_x"));
    reader.get("flow/velocity_x", std::span<float>(field));
    if (reader.has("nothing/of/this/name")) std::abort();
  } catch (const ejecta::Error&) {
    // Refused with a message: what a damaged file deserves.
  }
  return 0;
}
