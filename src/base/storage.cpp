#include "base/storage.hpp"

#include <sys/mman.h>

#include <new>

namespace ejecta {

std::unique_ptr<void, FreeStorage> allocate_storage(std::size_t bytes) {
  constexpr std::size_t kRegister = 64, kLargePage = std::size_t(1) << 21;
  const bool large = bytes >= kLargePage;
  const std::size_t unit = large ? kLargePage : kRegister, rounded = (bytes + unit - 1) / unit * unit;
  std::unique_ptr<void, FreeStorage> p(std::aligned_alloc(unit, rounded));
  if (!p) throw std::bad_alloc();
  if (large) madvise(p.get(), rounded, MADV_HUGEPAGE);  // a hint: without it only speed is lost
  return p;
}

}  // namespace ejecta
