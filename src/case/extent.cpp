#include "case/extent.hpp"

#include <algorithm>
#include <cmath>

namespace ejecta {

std::optional<Box> grid_box(const Case& c) {
  Box box;
  for (int a = 0; a < 3; ++a) {
    const AxisSpec& axis = c.grid.axis[static_cast<std::size_t>(a)];
    if (axis.points.size() < 2) return std::nullopt;
    box.low[a] = axis.points.front();
    box.high[a] = axis.points.back();
  }
  return box;
}

double cell_width(double length, int cells, double grading, int index) {
  if (cells <= 1) return length;
  const double ratio = std::pow(grading, 1.0 / (cells - 1));
  if (std::abs(ratio - 1.0) < 1e-12) return length / cells;
  return length * (ratio - 1.0) / (std::pow(ratio, cells) - 1.0) * std::pow(ratio, index);
}

void refine(GridSpec& grid, double factor) {
  for (AxisSpec& axis : grid.axis)
    for (int& n : axis.cells)
      if (axis.cells.size() > 1 || n > 1) n = std::max(1, static_cast<int>(std::lround(n * factor)));
}

std::vector<double> cell_centres(const AxisSpec& axis) {
  std::vector<double> centres;
  for (std::size_t b = 0; b < axis.cells.size(); ++b) {
    double low = axis.points[b];
    for (int i = 0; i < axis.cells[b]; ++i) {
      const double width = cell_width(axis.points[b + 1] - axis.points[b], axis.cells[b],
                                      axis.grading.empty() ? 1.0 : axis.grading[b], i);
      centres.push_back(low + 0.5 * width);
      low += width;
    }
  }
  return centres;
}

double widest_cell(const AxisSpec& axis, double from, double to) {
  from = std::clamp(from, axis.points.front(), axis.points.back());
  to = std::clamp(to, axis.points.front(), axis.points.back());
  double widest = 0.0;
  for (std::size_t b = 0; b < axis.cells.size(); ++b) {
    const double length = axis.points[b + 1] - axis.points[b];
    double low = axis.points[b];
    for (int i = 0; i < axis.cells[b]; ++i) {
      const double width = cell_width(length, axis.cells[b], axis.grading.empty() ? 1.0 : axis.grading[b], i);
      if (low <= to && low + width >= from) widest = std::max(widest, width);
      low += width;
    }
  }
  return widest;
}

std::optional<int> jet_face(const Case& c) {
  for (int f = 0; f < 6; ++f) {
    const BoundarySpec& face = c.boundary[static_cast<std::size_t>(f)];
    if (face.type == BoundaryType::jet ||
        std::any_of(face.patches.begin(), face.patches.end(),
                    [](const PatchSpec& p) { return p.type == BoundaryType::jet; }))
      return f;
  }
  return {};
}

double jet_height(const Case& c) {
  const int face = *jet_face(c), d = face / 2;
  const std::vector<double>& points = c.grid.axis[static_cast<std::size_t>(d)].points;
  return ((face % 2 ? points.back() : points.front()) - c.jet.nozzle[d]) / c.jet.direction.normalized()[d];
}

Vec3 half_extent(const BodySpec& b) {
  switch (b.shape) {
    case ShapeKind::sphere:
      return Vec3::Constant(0.5 * b.diameter);
    case ShapeKind::box:
    case ShapeKind::cluster:
    case ShapeKind::superquadric:
      return 0.5 * b.size;
    case ShapeKind::multisphere: {
      if (b.spheres.empty()) return Vec3::Zero();
      Vec3 low = Vec3::Constant(1e300), high = -low;
      for (const auto& s : b.spheres) {
        const Vec3 centre(s[0], s[1], s[2]);
        low = low.cwiseMin(centre - Vec3::Constant(s[3]));
        high = high.cwiseMax(centre + Vec3::Constant(s[3]));
      }
      return 0.5 * (high - low);
    }
    case ShapeKind::polyhedron: {
      if (b.vertices.empty()) return Vec3::Zero();
      Vec3 low = b.vertices.front(), high = low;
      for (const Vec3& v : b.vertices) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
      }
      return 0.5 * (high - low);
    }
    case ShapeKind::mesh:
      return Vec3::Zero();
  }
  return Vec3::Zero();
}

Vec3 place_of_interest(const Case& c, const BodySpec& b) {
  if (!b.on_belt) return b.position;
  return c.jet.nozzle + Vec3(0.0, c.launch.offset_across + b.across, c.launch.stand_off);
}

double valve_pitch(const Case& c) {
  return c.manifold.pitch > 0.0 ? c.manifold.pitch : c.sorter.belt_width / c.manifold.valves;
}

FineBlock fine_block(const AxisSpec& axis) {
  FineBlock finest;
  for (std::size_t b = 0; b < axis.cells.size(); ++b) {
    const double length = axis.points[b + 1] - axis.points[b],
                 grading = axis.grading.empty() ? 1.0 : axis.grading[b];
    const double cell = std::max(cell_width(length, axis.cells[b], grading, 0),
                                 cell_width(length, axis.cells[b], grading, axis.cells[b] - 1));
    if (cell < finest.cell) finest = {b, axis.points[b], axis.points[b + 1], cell};
  }
  return finest;
}

}  // namespace ejecta
