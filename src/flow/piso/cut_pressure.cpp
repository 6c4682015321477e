#include "flow/piso/cut_pressure.hpp"

#include <algorithm>
#include <cmath>

namespace ejecta {
namespace {

constexpr int kMostIterations = 60;

}  // namespace

CutPressure::CutPressure(const Grid& grid, FastDiagonalPoisson& whole,
                         const std::array<PoissonBoundary, 6>& boundary)
    : grid_(grid),
      metrics_(grid.metrics()),
      whole_(whole),
      boundary_(boundary),
      work_(grid.make_field()),
      sources_(grid.make_field()) {}

void CutPressure::add_entry(int i, int j, int k) {
  const int n = static_cast<int>(entries_.size());
  entry_(i, j, k) = n;
  entries_.push_back({i, j, k, n});
}

void CutPressure::add_coupling(int d, std::array<int, 3> face, Real closed) {
  const std::size_t s = static_cast<std::size_t>(d);
  const int n = grid_.n(d);
  std::array<int, 3> low = face, high = face;
  --low[s];
  Real strength = face_area_of(metrics_, d, face) * metrics_[s].inv_distance[face[s]];
  const bool first = face[s] == 0, last = face[s] == n;
  bool has_low = true, has_high = true;
  if (first || last) {
    switch (boundary_[2 * s + last]) {
      case PoissonBoundary::neumann:
        return;
      case PoissonBoundary::periodic:
        if (last) return;  // stands twice
        low[s] = n - 1;
        break;
      case PoissonBoundary::dirichlet:
        strength *= Real(2);
        (first ? has_low : has_high) = false;
    }
  }
  const auto entry = [&](bool there, const std::array<int, 3>& at) {
    if (!there) return -1;
    if (entry_(at[0], at[1], at[2]) < 0) add_entry(at[0], at[1], at[2]);
    return entry_(at[0], at[1], at[2]);
  };
  const int below = entry(has_low, low), above = entry(has_high, high);
  couplings_.push_back({below, above, strength, (Real(1) - closed) * strength});
}

void CutPressure::begin(const CutCells& cut, const Boundaries& boundaries) {
  if (entry_.size() == 0 && (!cut.empty() || boundaries.discs())) {
    entry_ = Array3<int>(grid_.nx(), grid_.ny(), grid_.nz());
    entry_.fill(-1);
  }
  for (const Entry& e : entries_) entry_(e.i, e.j, e.k) = -1;
  entries_.clear();
  couplings_.clear();
  for (const CutCell& c : cut.cells) add_entry(c.i, c.j, c.k);
  for (std::size_t n = 0; n < cut.cells.size(); ++n)
    if (cut.cells[n].carrier >= 0) entries_[n].one_with = cut.cells[n].carrier;
  for (const CutFace& f : cut.faces) {
    std::array<int, 3> below{f.i, f.j, f.k};
    --below[static_cast<std::size_t>(f.d)];
    // Within a solid faces may stay open: nothing reaches it from outside.
    if (cut.index(f.i, f.j, f.k) < 0 && cut.index(below[0], below[1], below[2]) < 0) continue;
    if (boundaries.prescribed_on(f.d, {f.i, f.j, f.k})) continue;
    add_coupling(f.d, {f.i, f.j, f.k}, f.closed);
  }
  for_each_small(cut, [&](const CutCell& c, const CutCell&) {
    for (int side = 0; side < 6; ++side) {
      const std::size_t d = static_cast<std::size_t>(side / 2);
      const int n = grid_.n(side / 2);
      if (!grid_.active(side / 2)) continue;
      std::array<int, 3> face{c.i, c.j, c.k}, beyond = face;
      face[d] += side % 2;
      beyond[d] += side % 2 ? 1 : -1;
      if (cut.closed[d](face[0], face[1], face[2]) > Real(0)) continue;  // has been added
      if (boundary_[2 * d] == PoissonBoundary::periodic) {
        face[d] %= n;
        beyond[d] = (beyond[d] + n) % n;
      }
      const bool inside = beyond[d] >= 0 && beyond[d] < n;
      if (boundaries.prescribed_on(side / 2, face)) continue;
      if (side % 2 == 0 || !inside || !cut.small_at(beyond[0], beyond[1], beyond[2]))
        add_coupling(side / 2, face, Real(0));
    }
  });
  boundaries.for_each_prescribed(
      [&](int d, const std::array<int, 3>& face, const BoundaryState&) { add_coupling(d, face, Real(1)); });
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

void CutPressure::balance(const CutCells& cut, ConstFieldView phi, Real dt,
                          const std::array<FieldView, 3>& q) const {
  for_each_small(cut, [&](const CutCell& c, const CutCell& carrier) {
    const Real change = dt * (phi(c.i, c.j, c.k) - phi(carrier.i, carrier.j, carrier.k));
    for (int side = 0; side < 6; ++side) {
      const std::size_t d = static_cast<std::size_t>(side / 2);
      if (!grid_.active(side / 2)) continue;
      std::array<int, 3> face{c.i, c.j, c.k};
      face[d] += side % 2;
      Real velocity = change * metrics_[d].inv_distance[face[d]];
      if (side % 2) velocity = -velocity;
      const int last = grid_.n(side / 2);
      const bool of_box = face[d] == 0 || face[d] == last;
      if (of_box && boundary_[static_cast<std::size_t>(side)] == PoissonBoundary::dirichlet)
        velocity *= Real(2);
      q[d](face[0], face[1], face[2]) += velocity;
      if (!of_box || boundary_[static_cast<std::size_t>(side)] != PoissonBoundary::periodic) continue;
      face[d] = last - face[d];
      q[d](face[0], face[1], face[2]) += velocity;
    }
  });
}

void CutPressure::too_much(const std::vector<Real>& f, std::vector<Real>& out) {
  std::fill(out.begin(), out.end(), Real(0));
  const auto shared = [&](int n) {
    return static_cast<std::size_t>(entries_[static_cast<std::size_t>(n)].one_with);
  };
  for (const Coupling& c : couplings_) {
    Real flow = 0;
    if (c.below >= 0) flow -= c.whole * f[static_cast<std::size_t>(c.below)] - c.open * f[shared(c.below)];
    if (c.above >= 0) flow += c.whole * f[static_cast<std::size_t>(c.above)] - c.open * f[shared(c.above)];
    if (c.below >= 0) out[shared(c.below)] += flow;
    if (c.above >= 0) out[shared(c.above)] -= flow;
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

/// With L the operator of the whole grid and A that of the open parts of faces, P^T A P phi = P^T rhs. All
/// vectors of the iteration are L^-1 of sources on the entries, since L is inverted exactly; sources are
/// folded, none stands on a cell that is one with another.
bool CutPressure::solve(const CutCells& cut, FieldView phi, double tolerance) {
  for (const GhostCell& g : cut.ghosts)
    if (cut.index(g.i, g.j, g.k) < 0) phi(g.i, g.j, g.k) = 0;  // but for round-off it is
  for (const CutCell& c : cut.cells)
    if (c.locked) phi(c.i, c.j, c.k) = 0;
  iterations_ = 0;
  if (couplings_.empty()) {
    whole_.solve(phi, phi);
    return true;
  }
  const bool windows = whole_.has_windows();
  if (windows) {
    whole_.begin(phi);
    whole_.read(window_);
    from_window(phi_);
  } else {
    whole_.solve(phi, phi);
    gather(phi, phi_);
  }
  too_much(phi_, residual_);
  std::fill(source_.begin(), source_.end(), Real(0));
  // r = P^T (rhs - A P phi), z = L^-1 r; steps along z, on which P^T A P is negative definite
  double before = 0.0, first = 0.0, least = 0.0;
  bool is_met = false;
  for (int n = 0; n < kMostIterations; ++n) {
    invert(residual_, z_);
    const double now = -product(residual_, z_);
    if (n == 0) first = now;
    least = n == 0 ? now : std::min(least, now);
    is_met = !(now > tolerance * tolerance * first) || !(now > 0.0);
    // Where nothing but round-off is left the residual grows again.
    if (is_met || now > 4.0 * least) break;
    ++iterations_;
    const Real beta = n == 0 ? Real(0) : static_cast<Real>(now / before);
    for (std::size_t e = 0; e < z_.size(); ++e) {
      direction_[e] = z_[e] + (n == 0 ? Real(0) : beta * direction_[e]);
      whole_direction_[e] = residual_[e] + (n == 0 ? Real(0) : beta * whole_direction_[e]);
    }
    too_much(direction_, closed_);
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
    whole_.finish(phi);
  } else {
    scatter(source_);
    whole_.solve(sources_.view(), work_.view());
    for_each_cell(grid_.range(),
                  [=, work = work_.view()](int i, int j, int k) { phi(i, j, k) += work(i, j, k); });
    for (const Entry& e : entries_) sources_(e.i, e.j, e.k) = 0;
  }
  for (const Entry& e : entries_) {
    const Entry& other = entries_[static_cast<std::size_t>(e.one_with)];
    phi(e.i, e.j, e.k) = phi(other.i, other.j, other.k);
  }
  return is_met;
}

}  // namespace ejecta
