#include "output/vtk_rectilinear.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/parallel.hpp"

namespace ejecta::output {
namespace {

/// Packs one plane of a component into the interleaved array of the file.
struct PackPlane {
  ConstFieldView from;
  float* to;
  int components, component;
  double scale, offset;
  Range3 r;
  void operator()(int plane) const {
    const std::ptrdiff_t nx = r.i1 - r.i0, ny = r.j1 - r.j0;
    const int k = r.k0 + plane;
    for (int j = r.j0; j < r.j1; ++j) {
      const Real* row = from.row(j, k) + r.i0;
      float* out = to + ((plane * ny + (j - r.j0)) * nx) * components + component;
      for (std::ptrdiff_t i = 0; i < nx; ++i)
        out[i * components] = static_cast<float>(scale * row[i] + offset);
    }
  }
};

}  // namespace

void RectilinearWriter::write(const std::filesystem::path& path, double time,
                              std::span<const CellField> fields) {
  write(path, time, fields, grid_->range());
}

void RectilinearWriter::write(const std::filesystem::path& path, double time,
                              std::span<const CellField> fields, const Range3& r) {
  const std::array<int, 3> first{r.i0, r.j0, r.k0}, last{r.i1, r.j1, r.k1};
  const std::string extent =
      fmt::format("0 {} 0 {} 0 {}", last[0] - first[0], last[1] - first[1], last[2] - first[2]);
  file_.begin("RectilinearGrid");
  file_.text(fmt::format(" WholeExtent=\"{}\">\n", extent));
  file_.time(time);
  file_.text(fmt::format("<Piece Extent=\"{}\">\n<Coordinates>\n", extent));
  for (std::size_t d = 0; d < 3; ++d) {
    const std::vector<double>& face = grid_->axis(static_cast<int>(d)).face;
    file_.array(std::string(1, "xyz"[d]), 1,
                std::span<const double>(face).subspan(static_cast<std::size_t>(first[d]),
                                                      static_cast<std::size_t>(last[d] - first[d] + 1)));
  }
  file_.text("</Coordinates>\n<CellData>\n");
  const std::size_t cells = std::size_t(r.i1 - r.i0) * std::size_t(r.j1 - r.j0) * std::size_t(r.k1 - r.k0);
  for (const CellField& f : fields) {
    float* to = file_.float_array(f.name, f.components, cells * static_cast<std::size_t>(f.components));
    for (int c = 0; c < f.components; ++c)
      for_each_index(r.k1 - r.k0, PackPlane{f.component[static_cast<std::size_t>(c)], to, f.components, c,
                                            f.scale, f.offset, r});
  }
  file_.text("</CellData>\n</Piece>\n");
  file_.write(path);
}

Range3 slice_range(const Grid& grid, int axis, double position) {
  Range3 r = grid.range();
  const int n = grid.axis(axis).cell_at(position);
  std::array<std::pair<int*, int*>, 3> ends{{{&r.i0, &r.i1}, {&r.j0, &r.j1}, {&r.k0, &r.k1}}};
  const auto [low, high] = ends[static_cast<std::size_t>(axis)];
  *low = n;
  *high = n + 1;
  return r;
}

}  // namespace ejecta::output
