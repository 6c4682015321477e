#pragma once
#include <cstddef>
#include <memory>

namespace ejecta {

struct FreeStorage {
  std::size_t offset = 0;  ///< of what was lent within what was allocated
  void operator()(void* p) const;
};

/// Uninitialised memory for an array that kernels run over: aligned to a SIMD register; large arrays lie in
/// large pages where the system lends them, so that the streams of a kernel do not wait for address
/// translation, and begin at different places within them, so that equal cells of many arrays do not drive
/// each other from the cache. Throws std::bad_alloc.
std::unique_ptr<void, FreeStorage> allocate_storage(std::size_t bytes);

}  // namespace ejecta
