#pragma once
#include <array>
#include <filesystem>
#include <span>
#include <string>

#include "grid/grid.hpp"
#include "output/vtk_appended.hpp"

namespace ejecta::output {

/// A scalar (one component) or vector (three) at cell centres, without copying it: what is written is
/// scale * value + offset.
struct CellField {
  std::string name;
  std::array<ConstFieldView, 3> component{};
  int components = 1;
  double scale = 1.0, offset = 0.0;
};
CellField scalar_field(std::string name, ConstFieldView values, double scale = 1.0, double offset = 0.0);
CellField vector_field(std::string name, ConstFieldView x, ConstFieldView y, ConstFieldView z);

/// Writes cell fields of a Grid as .vtr (VTK rectilinear grid, Float32). An axisymmetric grid is written in
/// its own coordinates: x is the radius.
class RectilinearWriter {
 public:
  explicit RectilinearWriter(const Grid& grid) : grid_(&grid) {}

  /// All cells, or those of `range`.
  void write(const std::filesystem::path& path, double time, std::span<const CellField> fields);
  void write(const std::filesystem::path& path, double time, std::span<const CellField> fields,
             const Range3& range);

 private:
  const Grid* grid_;
  VtkAppended file_;
};

/// The one layer of cells normal to `axis` that holds `position` (m): a slice as RectilinearWriter writes it.
Range3 slice_range(const Grid& grid, int axis, double position);

}  // namespace ejecta::output
