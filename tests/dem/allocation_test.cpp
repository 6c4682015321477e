#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "base/parallel.hpp"
#include "scene.hpp"

namespace {
long allocations = 0;  // counted by the operators below while a test asks for it
bool counting = false;
}  // namespace

// Not inlined: the compiler would take malloc and free for strangers to new and delete.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (counting) ++allocations;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace ejecta {
namespace {

/// Spheres, clusters and boxes that lie on each other: once the buffers have their size, neither steps nor
/// new lists of candidates ask for memory.
TEST(Allocation, AStepAllocatesNothing) {
  set_thread_count(1);
  Case c = scene(stone());
  c.environment.gravity = Vec3(0, 0, -9.81);
  c.walls = {floor_at(0)};
  for (int n = 0; n < 60; ++n) {
    const Vec3 at = 9e-3 * Vec3(n % 4, n / 4 % 4, n / 16) + Vec3(1e-4 * (n % 3), 1e-4 * (n % 5), 5e-3);
    BodySpec b = n % 2 ? ball("ball " + std::to_string(n), 8e-3, at)
                       : box("box " + std::to_string(n), Vec3(6e-3, 5e-3, 6e-3), at);
    c.bodies.push_back(b);
  }
  Particles p = make_particles(c);
  for (int n = 0; n < 400; ++n) p.advance(1e-3);
  const std::int64_t lists = p.lists();
  allocations = 0;
  counting = true;
  for (int n = 0; n < 50; ++n) p.advance(1e-3);
  counting = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(p.lists(), lists) << "lists were made anew meanwhile";
  EXPECT_GT(p.contacts().size(), 50u);
}

}  // namespace
}  // namespace ejecta
