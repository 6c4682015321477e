#include "base/storage.hpp"

#include <sys/mman.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace ejecta {

void FreeStorage::operator()(void* p) const { std::free(static_cast<char*>(p) - offset); }

std::unique_ptr<void, FreeStorage> allocate_storage(std::size_t bytes) {
  constexpr std::size_t kRegister = 64, kLargePage = std::size_t(1) << 21;
  constexpr std::size_t kStagger = 9 * kRegister, kPlaces = 32;
  static std::atomic<std::size_t> count{0};
  const bool large = bytes >= kLargePage;
  const std::size_t unit = large ? kLargePage : kRegister;
  const std::size_t offset = large ? count++ % kPlaces * kStagger : 0;
  const std::size_t rounded = (bytes + offset + unit - 1) / unit * unit;
  void* all = std::aligned_alloc(unit, rounded);
  if (!all) throw std::bad_alloc();
  if (large) madvise(all, rounded, MADV_HUGEPAGE);  // a hint: without it only speed is lost
  return {static_cast<char*>(all) + offset, FreeStorage{offset}};
}

}  // namespace ejecta
