#pragma once
#include <array>
#include <filesystem>
#include <span>
#include <string>

#include "grid/cell_field.hpp"
#include "grid/grid.hpp"
#include "output/vtk_appended.hpp"

namespace ejecta::output {

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
