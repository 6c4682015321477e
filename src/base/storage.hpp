#pragma once
#include <cstddef>
#include <cstdlib>
#include <memory>

namespace ejecta {

struct FreeStorage {
  void operator()(void* p) const { std::free(p); }
};

/// Uninitialised memory for an array that kernels run over: aligned to a SIMD register; large arrays lie in
/// large pages where the system lends them, so that the streams of a kernel do not wait for address
/// translation. Throws std::bad_alloc.
std::unique_ptr<void, FreeStorage> allocate_storage(std::size_t bytes);

}  // namespace ejecta
