#include "shape/stl.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "base/error.hpp"

namespace ejecta {
namespace {

constexpr std::size_t kHeader = 84, kRecord = 50;  // bytes: header with count; one binary triangle

std::uint32_t binary_count(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader) std::memcpy(&count, bytes.data() + 80, 4);
  return count;
}

/// A text file starts with "solid", but so do some binary ones: the length decides.
bool is_binary(std::string_view bytes) {
  if (bytes.size() >= kHeader && bytes.size() == kHeader + kRecord * std::size_t{binary_count(bytes)})
    return true;
  return bytes.substr(0, 5) != "solid";
}

std::vector<Vec3> corners_binary(std::string_view bytes, const std::string& name) {
  const std::size_t count = binary_count(bytes);
  if (bytes.size() < kHeader || (bytes.size() - kHeader) / kRecord < count)
    throw InputError(
        fmt::format("{}: a binary STL of {} triangles has {} bytes, this has {}: the file is cut short or no "
                    "STL",
                    name, count, kHeader + kRecord * count, bytes.size()));
  std::vector<Vec3> corners;
  corners.reserve(3 * count);
  for (std::size_t n = 0; n < count; ++n)
    for (std::size_t c = 0; c < 3; ++c) {
      float xyz[3];
      std::memcpy(xyz, bytes.data() + kHeader + kRecord * n + 12 * (c + 1), sizeof xyz);
      corners.emplace_back(xyz[0], xyz[1], xyz[2]);
    }
  return corners;
}

std::vector<Vec3> corners_text(std::string_view bytes, const std::string& name) {
  std::istringstream in{std::string(bytes)};
  std::vector<Vec3> corners;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string word;
    if (!(words >> word) || word != "vertex") continue;
    Vec3 p;
    if (!(words >> p.x() >> p.y() >> p.z()))
      throw InputError(fmt::format("{}:{}: expected three numbers after \"vertex\", e.g. \"vertex 0 0 1.5\"",
                                   name, number));
    corners.push_back(p);
  }
  if (corners.size() % 3 != 0)
    throw InputError(fmt::format("{}: {} vertices are no whole number of triangles", name, corners.size()));
  return corners;
}

}  // namespace

TriangleMesh parse_stl(std::string_view bytes, double scale, const std::string& name) {
  const std::vector<Vec3> corners =
      is_binary(bytes) ? corners_binary(bytes, name) : corners_text(bytes, name);
  if (corners.empty()) throw InputError(fmt::format("{}: the file holds no triangles", name));
  Vec3 low = corners.front(), high = corners.front();
  for (std::size_t n = 0; n < corners.size(); ++n) {
    if (!corners[n].allFinite())
      throw InputError(
          fmt::format("{}: corner {} of triangle {} is not a finite number", name, n % 3 + 1, n / 3 + 1));
    low = low.cwiseMin(corners[n]);
    high = high.cwiseMax(corners[n]);
  }
  const double grid = 1e-7 * (high - low).norm();
  TriangleMesh mesh;
  std::map<std::array<std::int64_t, 3>, int> known;
  // A corner may fall on either side of a rounding boundary: look into the neighbouring grid cells as well.
  const auto vertex = [&](const Vec3& p) {
    const Vec3 q = grid > 0 ? Vec3((p - low) / grid) : Vec3(0, 0, 0);
    std::array<std::int64_t, 3> cell{};
    for (std::size_t c = 0; c < 3; ++c) cell[c] = std::llround(q[static_cast<int>(c)]);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz)
          if (const auto at = known.find({cell[0] + dx, cell[1] + dy, cell[2] + dz}); at != known.end())
            return at->second;
    mesh.vertices.push_back(scale * p);
    return known[cell] = static_cast<int>(mesh.vertices.size()) - 1;
  };
  for (std::size_t n = 0; n < corners.size(); n += 3)
    mesh.triangles.push_back({vertex(corners[n]), vertex(corners[n + 1]), vertex(corners[n + 2])});
  return mesh;
}

TriangleMesh read_stl(const std::string& path, double scale) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("cannot open the mesh \"{}\"", path));
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return parse_stl(bytes, scale, path);
}

}  // namespace ejecta
