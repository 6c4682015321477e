#include "flow/piso/cut_pressure.hpp"

#include <algorithm>
#include <cmath>

#include "flow/cut_geometry.hpp"

namespace ejecta {
namespace {

constexpr int kMostIterations = 60;

}  // namespace

CutPressure::CutPressure(const Grid& grid, FastDiagonalPoisson& whole,
                         const std::array<PoissonBoundary, 6>& boundary)
    : grid_(grid),
      whole_(whole),
      boundary_(boundary),
      work_(grid.make_field()),
      sources_(grid.make_field()) {}

void CutPressure::begin(const CutCells& cut) {
  entries_.clear();
  couplings_.clear();
  for (const CutCell& c : cut.cells) entries_.push_back({c.i, c.j, c.k});
  const int first_ghost = static_cast<int>(entries_.size());
  for (const GhostCell& g : cut.ghosts)  // those of solids come first
    if (cut.index(g.i, g.j, g.k) < 0) entries_.push_back({g.i, g.j, g.k});
  const auto entry = [&](int i, int j, int k) {
    const int index = cut.index(i, j, k);
    return index > 0 ? index - 1 : first_ghost - 1 - index;
  };
  for (const CutFace& f : cut.faces) {
    const int at[3] = {f.i, f.j, f.k};
    const int n = grid_.n(f.d);
    const Real area = face_area_of(grid_, f.d, {f.i, f.j, f.k});
    Coupling c{-1, -1, f.closed * area * grid_.metrics(f.d).inv_distance[at[f.d]]};
    int below[3] = {f.i, f.j, f.k};
    --below[f.d];
    if (at[f.d] == 0 || at[f.d] == n) {
      const PoissonBoundary kind = boundary_[static_cast<std::size_t>(2 * f.d + (at[f.d] == n))];
      if (kind == PoissonBoundary::neumann || (kind == PoissonBoundary::periodic && at[f.d] == n)) continue;
      if (kind == PoissonBoundary::periodic) {
        below[f.d] = n - 1;
      } else {
        c.strength *= Real(2);
        if (at[f.d] == 0) c.above = entry(f.i, f.j, f.k);
        else c.below = entry(below[0], below[1], below[2]);
        couplings_.push_back(c);
        continue;
      }
    }
    c.below = entry(below[0], below[1], below[2]);
    c.above = entry(f.i, f.j, f.k);
    couplings_.push_back(c);
  }
  Range3 box{grid_.nx(), 0, grid_.ny(), 0, grid_.nz(), 0};
  for (const Entry& e : entries_) {
    box.i0 = std::min(box.i0, e.i), box.i1 = std::max(box.i1, e.i + 1);
    box.j0 = std::min(box.j0, e.j), box.j1 = std::max(box.j1, e.j + 1);
    box.k0 = std::min(box.k0, e.k), box.k1 = std::max(box.k1, e.k + 1);
  }
  if (!entries_.empty() && whole_.has_windows()) whole_.resize(window_, box);
  for (auto* v : {&phi_, &closed_, &residual_, &z_, &direction_, &whole_direction_, &source_})
    v->resize(entries_.size());
}

void CutPressure::through_closed(const std::vector<Real>& f, std::vector<Real>& out) {
  std::fill(out.begin(), out.end(), Real(0));
  for (const Coupling& c : couplings_) {
    const Real below = c.below < 0 ? Real(0) : f[static_cast<std::size_t>(c.below)],
               above = c.above < 0 ? Real(0) : f[static_cast<std::size_t>(c.above)];
    const Real flow = c.strength * (above - below);
    if (c.below >= 0) out[static_cast<std::size_t>(c.below)] += flow;
    if (c.above >= 0) out[static_cast<std::size_t>(c.above)] -= flow;
  }
}

void CutPressure::gather(ConstFieldView f, std::vector<Real>& out) const {
  for (std::size_t n = 0; n < entries_.size(); ++n) out[n] = f(entries_[n].i, entries_[n].j, entries_[n].k);
}

double CutPressure::product(const std::vector<Real>& a, const std::vector<Real>& b) const {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += double(a[n]) * double(b[n]);
  return sum;
}

void CutPressure::scatter(const std::vector<Real>& r) {
  for (std::size_t n = 0; n < entries_.size(); ++n)
    sources_(entries_[n].i, entries_[n].j, entries_[n].k) = r[n];
}

void CutPressure::to_window(const std::vector<Real>& r) {
  const Range3& c = window_.cells;
  std::fill_n(window_.row(c.j0, c.k0),
              static_cast<std::ptrdiff_t>(window_.width) * (c.j1 - c.j0) * (c.k1 - c.k0), Real(0));
  for (std::size_t n = 0; n < entries_.size(); ++n)
    window_.row(entries_[n].j, entries_[n].k)[entries_[n].i - window_.first] = r[n];
}

void CutPressure::from_window(std::vector<Real>& out) {
  for (std::size_t n = 0; n < entries_.size(); ++n)
    out[n] = window_.row(entries_[n].j, entries_[n].k)[entries_[n].i - window_.first];
}

void CutPressure::invert(const std::vector<Real>& r, std::vector<Real>& out) {
  if (!whole_.has_windows()) {
    scatter(r);
    whole_.solve(sources_.view(), work_.view());
    return gather(work_.view(), out);
  }
  to_window(r);
  whole_.solve(window_);
  from_window(out);
}

/// With L the operator of the whole grid and C what passes closed faces, (L - C) phi = rhs. Residuals and L
/// times the directions vanish but on the entries, since L is inverted exactly.
void CutPressure::solve(const CutCells& cut, FieldView phi, double tolerance) {
  for (const GhostCell& g : cut.ghosts)
    if (cut.index(g.i, g.j, g.k) < 0) phi(g.i, g.j, g.k) = 0;  // but for round-off it is
  for (const CutCell& c : cut.cells)
    if (c.locked) phi(c.i, c.j, c.k) = 0;
  iterations_ = 0;
  if (couplings_.empty()) return whole_.solve(phi, phi);
  const bool windows = whole_.has_windows();
  if (windows) {
    whole_.begin(phi);
    whole_.read(window_);
    from_window(phi_);
  } else {
    whole_.solve(phi, phi);
    gather(phi, phi_);
  }
  through_closed(phi_, residual_);
  std::fill(source_.begin(), source_.end(), Real(0));
  // r = C phi, z = L^-1 r; steps along z, on which (L - C) is negative definite
  double before = 0.0, first = 0.0, least = 0.0;
  for (int n = 0; n < kMostIterations; ++n) {
    invert(residual_, z_);
    const double now = -product(residual_, z_);
    if (n == 0) first = now;
    least = n == 0 ? now : std::min(least, now);
    // Where nothing but round-off is left the residual grows again.
    if (!(now > tolerance * tolerance * first) || !(now > 0.0) || now > 4.0 * least) break;
    ++iterations_;
    const Real beta = n == 0 ? Real(0) : static_cast<Real>(now / before);
    for (std::size_t e = 0; e < z_.size(); ++e) {
      direction_[e] = z_[e] + (n == 0 ? Real(0) : beta * direction_[e]);
      whole_direction_[e] = residual_[e] + (n == 0 ? Real(0) : beta * whole_direction_[e]);
    }
    through_closed(direction_, closed_);
    for (std::size_t e = 0; e < closed_.size(); ++e) closed_[e] = whole_direction_[e] - closed_[e];
    const double curvature = -product(direction_, closed_);
    if (!(curvature > 0.0)) break;
    const Real alpha = static_cast<Real>(now / curvature);
    for (std::size_t e = 0; e < z_.size(); ++e) {
      source_[e] += alpha * whole_direction_[e];
      residual_[e] -= alpha * closed_[e];
    }
    before = now;
  }
  if (windows) {
    to_window(source_);
    whole_.add(window_);
    return whole_.finish(phi);
  }
  scatter(source_);
  whole_.solve(sources_.view(), work_.view());
  for_each_cell(grid_.range(),
                [=, work = work_.view()](int i, int j, int k) { phi(i, j, k) += work(i, j, k); });
  for (const Entry& e : entries_) sources_(e.i, e.j, e.k) = 0;
}

}  // namespace ejecta
