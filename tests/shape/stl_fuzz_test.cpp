#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>

#include "base/error.hpp"
#include "shape/shape.hpp"
#include "shape/stl.hpp"

/// Broken STL files: every one is either refused with InputError or gives a solid. Half a second by default;
/// EJECTA_FUZZ_SECONDS=600 in a build with sanitizers for the long run.
namespace ejecta {
namespace {

std::string text_of(const TriangleMesh& mesh) {
  std::string s = "solid rock\n";
  for (const auto& t : mesh.triangles) {
    s += "facet normal 0 0 1\nouter loop\n";
    for (const int c : t) {
      const Vec3& p = mesh.vertices[static_cast<std::size_t>(c)];
      s += "vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) +
           "\n";
    }
    s += "endloop\nendfacet\n";
  }
  return s + "endsolid rock\n";
}

std::string binary_of(const TriangleMesh& mesh) {
  std::string s(84 + 50 * mesh.triangles.size(), '\0');
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::memcpy(s.data() + 80, &count, 4);
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3f p = mesh.vertices[static_cast<std::size_t>(mesh.triangles[n][c])].cast<float>();
      std::memcpy(s.data() + 84 + 50 * n + 12 * (c + 1), p.data(), 12);
    }
  return s;
}

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string operator()(std::string s) {
    for (std::size_t n = pick(4) + 1; n > 0 && !s.empty(); --n) mutate(s);
    return s;
  }

 private:
  std::size_t pick(std::size_t count) { return random_() % count; }

  void mutate(std::string& s) {
    const std::size_t at = pick(s.size()), length = std::min(pick(60) + 1, s.size() - at);
    static const char* const words[] = {"nan",   "inf", "-1e999", "1e308",    "vertex",
                                        "solid", "\n",  " ",      "\0\0\0\0", "0"};
    switch (pick(7)) {
      case 0:
        s[at] = static_cast<char>(random_());
        break;
      case 1:
        s.erase(at, length);
        break;
      case 2:
        s.insert(at, s.substr(pick(s.size()), length));
        break;
      case 3:
        s.insert(at, words[pick(std::size(words))]);
        break;
      case 4:
        s.resize(at);
        break;
      case 5:  // swap two records
        if (s.size() > 84 + 100) std::swap_ranges(s.begin() + 84, s.begin() + 134, s.end() - 50);
        break;
      default:  // a huge or tiny number of triangles
        if (s.size() > 84) s[80 + pick(4)] = static_cast<char>(random_());
    }
  }

  std::mt19937 random_;
};

TEST(StlFuzz, IsRefusedOrASolid) {
  const char* wish = std::getenv("EJECTA_FUZZ_SECONDS");
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(wish ? std::atof(wish) : 0.5);
  const TriangleMesh cube = make_box(Vec3(1, 1, 1)).surface(), rock = icosphere(1);
  const std::string seeds[] = {text_of(cube), binary_of(cube), text_of(rock), binary_of(rock)};
  int refused = 0, solids = 0;
  for (unsigned n = 0; std::chrono::steady_clock::now() < end; ++n) {
    const std::string bytes = Mutator(n)(seeds[n % 4]);
    try {
      const Shape shape = make_mesh(parse_stl(bytes, 1.0, "fuzz"), "fuzz");
      ++solids;
      const MassProperties& m = shape.mass_properties();
      EXPECT_TRUE(m.volume > 0 && m.inertia.allFinite()) << n;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(solids, 0);
}

}  // namespace
}  // namespace ejecta
