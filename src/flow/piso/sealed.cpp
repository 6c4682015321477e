#include "flow/piso/sealed.hpp"

#include <cmath>
#include <vector>

#include "flow/cut_geometry.hpp"

namespace ejecta {
namespace {

using Cell = std::array<int, 3>;

/// Net flow, parts of all that enters or leaves, that is no round-off.
constexpr double kSomething = 1e-4;
/// Closed up to round-off.
constexpr Real kClosed = Real(1) - Real(1e-5);

}  // namespace

std::optional<Sealed> find_sealed(const Grid& grid, const CutCells& cut, const Boundaries& boundaries,
                                  const std::array<ConstFieldView, 3>& q) {
  if (cut.empty()) return std::nullopt;
  const GridMetrics& metrics = grid.metrics();
  Array3<char> seen(grid.nx(), grid.ny(), grid.nz());
  seen.fill(0);
  const auto is_fluid = [&](const Cell& c) {
    const int index = cut.index(c[0], c[1], c[2]);
    return index == 0 || (index > 0 && !cut.cells[static_cast<std::size_t>(index - 1)].locked);
  };
  std::optional<Sealed> worst;
  std::vector<Cell> front;
  for (int k = 0; k < grid.nz(); ++k)
    for (int j = 0; j < grid.ny(); ++j)
      for (int i = 0; i < grid.nx(); ++i) {
        if (seen(i, j, k) || !is_fluid({i, j, k})) continue;
        bool has_open = false;
        double net = 0.0, all = 0.0;
        Sealed part{0.0, {}};
        seen(i, j, k) = 1;
        front.assign(1, {i, j, k});
        while (!front.empty()) {
          const Cell c = front.back();
          front.pop_back();
          for (int side = 0; side < 6; ++side) {
            const std::size_t d = static_cast<std::size_t>(side / 2);
            if (!grid.active(side / 2)) continue;
            Cell face = c, next = c;
            face[d] += side % 2;
            next[d] += side % 2 ? 1 : -1;
            const Real closed = cut.closed[d](face[0], face[1], face[2]);
            if (closed >= kClosed) continue;
            const int n = grid.n(side / 2);
            const BoundaryKind kind = boundaries.kind(side);
            const bool of_box = next[d] < 0 || next[d] >= n;
            if (of_box && kind == BoundaryKind::periodic) next[d] = (next[d] + n) % n;
            if (of_box && kind != BoundaryKind::periodic) {
              if (kind == BoundaryKind::open && !boundaries.prescribed_on(side / 2, face)) has_open = true;
              const double in = (side % 2 ? -1.0 : 1.0) * (1.0 - double(closed)) *
                                double(face_area_of(metrics, side / 2, face)) *
                                double(q[d](face[0], face[1], face[2]));
              net += in;
              all += std::abs(in);
              if (std::abs(in) > 0.0) part.at = grid.centre(c[0], c[1], c[2]);
            } else if (is_fluid(next) && !seen(next[0], next[1], next[2])) {
              seen(next[0], next[1], next[2]) = 1;
              front.push_back(next);
            }
          }
        }
        part.flow = net;
        if (!has_open && std::abs(net) > kSomething * all &&
            (!worst || std::abs(net) > std::abs(worst->flow)))
          worst = part;
      }
  return worst;
}

}  // namespace ejecta
