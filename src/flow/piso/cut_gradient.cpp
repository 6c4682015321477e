#include <algorithm>
#include <cmath>

#include "flow/cut_geometry.hpp"
#include "flow/piso/cut_flow.hpp"

/// CutFlow: gradients of carriers.
namespace ejecta {
namespace {

using Cell = std::array<int, 3>;
using Triple = std::array<Real, 3>;

/// Most differences of one cell: its faces; walls along three axes that go on in four directions, two each.
constexpr int kMostDifferences = 6 + 3 * 4 * 2;
/// Length of the columns behind a face that counts at least, widths of a cell.
constexpr Real kLeastColumn = Real(0.05);
/// Rise of the pressure towards an edge over its fall into the cell of the edge from which on its peak counts
/// as lying before the edge.
constexpr Real kPeak = Real(1) / 16;
/// Closed part of a face of the next cell beyond that of this one at which half of a wall counts to go on
/// there.
constexpr Real kHalfGoesOn = Real(0.02);

/// Of a cell, in entries of a field with the steps of `f`.
std::ptrdiff_t entry_of(const Cell& c, ConstFieldView f) { return c[0] + c[1] * f.sy + c[2] * f.sz; }

/// Part of a cell whose gradient along an axis is the difference across a face: columns of fluid from face to
/// face have the mean of both differences, columns that end at a wall that of their own face alone. open,
/// across: open parts of this face and of the one across.
Real columns_at(Real open, Real across, Real fluid) {
  const Real through = std::min(open, across);
  const Real ending = open > across ? std::max(fluid - through, kLeastColumn * (open - across)) : Real(0);
  return Real(0.5) * through + ending;
}

/// Distance of the centres of the first two cells over that of the last two, in a row along an axis.
Real ratio_of_distances(const Grid& grid, const Cell& a, const Cell& b, const Cell& c) {
  Real first = 0, second = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    const Real* centre = grid.metrics(int(d)).centre;
    first += std::abs(centre[a[d]] - centre[b[d]]);
    second += std::abs(centre[b[d]] - centre[c[d]]);
  }
  return first / second;
}

/// visit(part of it, the next cell, the one after) for the directions in which the wall that closes the
/// d-face `face` of a cell goes on, away from the edge of the body in that cell.
template <class Visit>
void for_each_way_on(const Grid& grid, const CutCells& cut, const Cell& cell, int d, const Cell& face,
                     const Visit& visit) {
  struct Way {
    Real gain;
    Cell next, after;
  };
  std::array<Way, 4> ways;
  std::size_t count = 0;
  Real total = 0;
  const ConstFieldView closed = cut.closed[static_cast<std::size_t>(d)].view();
  for (int side = 0; side < 6; ++side) {
    if (side / 2 == d || !grid.active(side / 2)) continue;
    const std::size_t t = static_cast<std::size_t>(side / 2);
    const int up = side % 2, step = up ? 1 : -1;
    const auto moved = [t](Cell at, int by) {
      at[t] += by;
      return at;
    };
    const Cell next = moved(cell, step), after = moved(cell, 2 * step), next_face = moved(face, step);
    if (after[t] < 0 || after[t] >= grid.n(side / 2) || cut.index(next[0], next[1], next[2]) <= 0 ||
        cut.index(after[0], after[1], after[2]) < 0)
      continue;
    const Cell to_next = moved(cell, up), to_after = moved(next, up);
    if (cut.closed[t](to_next[0], to_next[1], to_next[2]) >= Real(1) ||
        cut.closed[t](to_after[0], to_after[1], to_after[2]) >= Real(1))
      continue;
    const Real gain = closed(next_face[0], next_face[1], next_face[2]) - closed(face[0], face[1], face[2]);
    if (gain <= Real(0)) continue;
    total += gain;
    ways[count++] = {gain, next, after};
  }
  for (std::size_t n = 0; n < count; ++n)
    visit(ways[n].gain / (total + kHalfGoesOn), ways[n].next, ways[n].after);
}

}  // namespace

void CutFlow::list_differences(const CutCells& cut, ConstFieldView p) {
  differences_of_.resize(cut.cells.size());
  differences_.resize(static_cast<std::size_t>(kMostDifferences) * cut.members.size());
  for_each_index(static_cast<int>(cut.cells.size()), [&](int n) {
    const CutCell& carrier = cut.cells[static_cast<std::size_t>(n)];
    if (carrier.carrier != n) return;
    DifferencesOf& of = differences_of_[static_cast<std::size_t>(n)];
    of = {kMostDifferences * carrier.first_member, 0, 0};
    Difference* const first = differences_.data() + of.first;
    Triple total{0, 0, 0};
    for_each_open_face(
        grid_, cut, carrier,
        [&](const CutCell& c, int d, const Cell& face, const Cell& beyond, Real sign, Real open, Real area) {
          const Metrics& m = grid_.metrics(d);
          const std::size_t s = static_cast<std::size_t>(d);
          const Real lower = m.weight[face[s]], weight = sign > 0 ? Real(1) - lower : lower;
          Cell across{c.i, c.j, c.k};
          across[s] += sign < 0;
          const Real part =
              columns_at(open, Real(1) - cut.closed[s](across[0], across[1], across[2]), c.fluid);
          first[of.faces++] = {entry_of({c.i, c.j, c.k}, p), entry_of(beyond, p), d,
                               sign * part * area * m.inv_distance[face[s]], sign * open * area * weight};
          total[s] += part * area;
        });
    of.all = of.faces;
    for (int m = carrier.first_member; m < carrier.first_member + carrier.members; ++m) {
      const CutCell& c = cut.cells[static_cast<std::size_t>(cut.members[static_cast<std::size_t>(m)])];
      if (c.edge > Real(0)) list_walls_at_edge(cut, c, p, first, of.all);
    }
    for (int f = 0; f < of.all; ++f) {
      Real& slope = first[f].slope;
      const Real volume = total[static_cast<std::size_t>(first[f].d)];
      slope = volume > Real(0) ? slope / volume : Real(0);
    }
  });
}

/// A cell through which an edge runs has one pressure for both sides of it, one of which may face the stream
/// and the other lie in its shadow. A wall there takes the pressure that stands before the rest of it: in
/// place of p that of the next cell along it, continued by the slope from the one after, or by that towards p
/// where it is flatter, or not at all where they have other signs (minmod); but p where the pressure rises to
/// a peak before the edge, as nothing tells how far it falls from there. All by p at the beginning of the
/// step, so that the gradient is linear within it.
void CutFlow::list_walls_at_edge(const CutCells& cut, const CutCell& c, ConstFieldView p, Difference* first,
                                 int& count) const {
  const Cell cell{c.i, c.j, c.k};
  for (int d = 0; d < 3; ++d) {
    if (!grid_.active(d)) continue;
    const std::size_t s = static_cast<std::size_t>(d);
    Cell upper = cell;
    ++upper[s];
    const Real ends = cut.closed[s](upper[0], upper[1], upper[2]) - cut.closed[s](c.i, c.j, c.k);
    if (ends == Real(0)) continue;
    const Real slope =
        c.edge * ends * face_area_of(grid_.metrics(), d, cell) * grid_.metrics(d).inv_width[cell[s]];
    for_each_way_on(grid_, cut, cell, d, ends > Real(0) ? upper : cell,
                    [&](Real part, const Cell& next, const Cell& after) {
                      const std::ptrdiff_t here = entry_of(cell, p), beside = entry_of(next, p),
                                           behind = entry_of(after, p);
                      const Real ratio = ratio_of_distances(grid_, cell, next, after);
                      const Real continued = ratio * (p.origin[beside] - p.origin[behind]),
                                 step = p.origin[here] - p.origin[beside];
                      const Real limit = step * continued > Real(0) ? std::min(step / continued, Real(1))
                                                                    : Real(step == continued);
                      if (continued > Real(0) && step < Real(0))
                        part *= std::max(Real(0), Real(1) + continued / (kPeak * step));
                      first[count++] = {here, beside, d, part * slope, Real(0)};
                      first[count++] = {behind, beside, d, part * slope * ratio * limit, Real(0)};
                    });
  }
}

std::array<Real, 3> CutFlow::sum_of_differences(int first, int last, ConstFieldView f) const {
  Triple sum{0, 0, 0};
  for (int n = first; n < last; ++n) {
    const Difference& x = differences_[static_cast<std::size_t>(n)];
    sum[static_cast<std::size_t>(x.d)] += x.slope * (f.origin[x.beyond] - f.origin[x.here]);
  }
  return sum;
}

std::array<Real, 3> CutFlow::mean_gradient(const CutCell& carrier, ConstFieldView f) const {
  const DifferencesOf& of = differences_of_[static_cast<std::size_t>(carrier.carrier)];
  return sum_of_differences(of.first, of.first + of.faces, f);
}

CutFlow::Gradient CutFlow::gradient(const CutCell& carrier, ConstFieldView p) const {
  const DifferencesOf& of = differences_of_[static_cast<std::size_t>(carrier.carrier)];
  Gradient g{sum_of_differences(of.first, of.first + of.all, p), {}};
  Triple balance{0, 0, 0};
  for (int n = of.first; n < of.first + of.faces; ++n) {
    const Difference& x = differences_[static_cast<std::size_t>(n)];
    balance[static_cast<std::size_t>(x.d)] += x.pull * (p.origin[x.beyond] - p.origin[x.here]);
  }
  const Real volume = carrier.carried * static_cast<Real>(grid_.volume(carrier.i, carrier.j, carrier.k));
  for (std::size_t d = 0; d < 3; ++d) g.beyond[d] = volume * g.value[d] - balance[d];
  return g;
}

}  // namespace ejecta
