#pragma once
#include <array>
#include <optional>
#include <vector>

#include "base/vec.hpp"
#include "case/case.hpp"

/// Sizes of boxes and bodies as far as the case alone tells them; the true geometry is the business of grid
/// and shape.
namespace ejecta {

struct Box {
  Vec3 low{0, 0, 0}, high{0, 0, 0};  ///< m
  bool contains(const Vec3& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
};

/// The computed box; nothing when the case has no grid.
std::optional<Box> grid_box(const Case&);
/// Widths of the cells of one block: a geometric series with last/first = grading.
double cell_width(double length, int cells, double grading, int index);
/// Cells of each block times `factor`, at least one; directions of a single cell stay as they are.
void refine(GridSpec&, double factor);
/// Middles of the cells of an axis, ascending, m.
std::vector<double> cell_centres(const AxisSpec& axis);
/// Largest width of the cells of an axis that touch [from, to], or the nearest cell's; m.
double widest_cell(const AxisSpec& axis, double from, double to);

/// The face through which the jet enters: the first of type "jet" or with an orifice on it, 0..5 = x_min,
/// x_max, y_min, ...
std::optional<int> jet_face(const Case&);
/// From jet.nozzle along the jet to the plane of that face, m; of a case with a grid and a jet.
double jet_height(const Case&);

/// From one valve of a sorter to the next, m.
double valve_pitch(const Case&);

/// Half edge lengths of the box around a body in its own axes, m; zero for a mesh, which only the file knows.
Vec3 half_extent(const BodySpec&);
/// Where the body is when it matters: at the start, or on the jet's axis if it comes from the belt, m.
Vec3 place_of_interest(const Case&, const BodySpec&);

/// The block of an axis with the smallest cells.
struct FineBlock {
  std::size_t block = 0;
  double low = 0.0, high = 0.0, cell = 1e300;  ///< m, its ends and the width of its cells
};
FineBlock fine_block(const AxisSpec& axis);

}  // namespace ejecta
