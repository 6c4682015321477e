#include "flow/gas/boundary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace ejecta::gas {
namespace {

/// Relaxation of a transmissive face to the far pressure, of c/L (Poinsot & Lele 1992; Rudy & Strikwerda
/// 1980)
constexpr double kRelaxation = 0.27;

/// The axes across axis d, ascending.
struct Across {
  int a, b;
};
Across across(int d) { return d == 0 ? Across{1, 2} : d == 1 ? Across{0, 2} : Across{0, 1}; }

std::ptrdiff_t stride(const Block& w, int d) {
  const auto v = w[0].view();
  return d == 0 ? 1 : d == 1 ? v.sy : v.sz;
}

/// The cell at offset n in a face's axes: velocity along the inward normal (sign) and across.
Primitive load(const BlockView<Real>& w, int d, Real sign, std::ptrdiff_t n) {
  const Across t = across(d);
  return {
      w.at(kRho, n), sign * w.at(kU + d, n), w.at(kU + t.a, n), w.at(kU + t.b, n), w.at(kP, n), w.at(kK, n),
      w.at(kE, n)};
}

void store(const BlockView<Real>& w, int d, Real sign, std::ptrdiff_t n, const Primitive& g) {
  const Across t = across(d);
  w.at(kRho, n) = g.rho;
  w.at(kU + d, n) = sign * g.un;
  w.at(kU + t.a, n) = g.ut;
  w.at(kU + t.b, n) = g.us;
  w.at(kP, n) = g.p;
  w.at(kK, n) = g.k;
  w.at(kE, n) = g.e;
}

Primitive in_face_axes(const GasState& s, int d, Real sign, const GasConstants& gas) {
  const Across t = across(d);
  return {Real(s.density),
          sign * Real(s.velocity[d]),
          Real(s.velocity[t.a]),
          Real(s.velocity[t.b]),
          Real(s.pressure - double(gas.reference_pressure)),
          Real(s.k),
          Real(s.e)};
}

bool is_open(BoundaryType type) {
  return type == BoundaryType::free_stream || type == BoundaryType::pressure_outlet ||
         type == BoundaryType::wave_transmissive;
}

}  // namespace

Boundaries::Boundaries(const Grid& grid, const GasConstants& gas) : grid_(grid), gas_(gas) {
  for (int f = 0; f < 6; ++f) {
    const Across t = across(f / 2);
    const auto cells = static_cast<std::size_t>(grid.n(t.a)) * static_cast<std::size_t>(grid.n(t.b));
    face_[static_cast<std::size_t>(f)].handle.assign(cells, 0);
    const Axis& axis = grid.axis(f / 2);
    face_[static_cast<std::size_t>(f)].anchor =
        Real(kRelaxation * (f % 2 ? axis.width.back() : axis.width.front()) / axis.length());
  }
  conditions_.push_back(Condition{});  // 0: symmetry everywhere until set
}

Boundaries::Handle Boundaries::keep(const Condition& condition) {
  constexpr std::size_t most = std::numeric_limits<Handle>::max();
  if (conditions_.size() > most) throw InputError(fmt::format("more than {} boundaries and patches", most));
  conditions_.push_back(condition);
  return static_cast<Handle>(conditions_.size() - 1);
}

int Boundaries::set_face(int face, const Condition& condition) {
  const Handle handle = keep(condition);
  Face& f = face_[static_cast<std::size_t>(face)];
  f.base = handle;
  std::fill(f.handle.begin(), f.handle.end(), handle);
  return handle;
}

int Boundaries::add_disc(int face, const Vec3& centre, double radius, const Condition& condition) {
  const Handle handle = keep(condition);
  const Across t = across(face / 2);
  Face& f = face_[static_cast<std::size_t>(face)];
  for (int b = 0; b < grid_.n(t.b); ++b)
    for (int a = 0; a < grid_.n(t.a); ++a) {
      const double da = grid_.axis(t.a).centre[static_cast<std::size_t>(a)] - centre[t.a];
      const double db = grid_.axis(t.b).centre[static_cast<std::size_t>(b)] - centre[t.b];
      const double across_y = grid_.axisymmetric() ? 0.0 : (t.a == 1 ? da : db);
      const double across_x = t.a == 1 ? db : da;
      const bool y_is_across = t.a == 1 || t.b == 1;
      const double square = y_is_across ? across_x * across_x + across_y * across_y : da * da + db * db;
      if (square < radius * radius) f.handle[static_cast<std::size_t>(a + b * grid_.n(t.a))] = handle;
    }
  return handle;
}

void Boundaries::set_states(int face, const std::function<GasState(const Vec3&)>& outside) {
  Face& f = face_[static_cast<std::size_t>(face)];
  const int d = face / 2;
  const Across t = across(d);
  const Real sign = face % 2 ? Real(-1) : Real(1);
  f.outside.resize(f.handle.size());
  Vec3 x = face % 2 ? grid_.upper() : grid_.lower();
  for (std::size_t cell = 0; cell < f.handle.size(); ++cell) {
    const int a = int(cell) % grid_.n(t.a), b = int(cell) / grid_.n(t.a);
    x[t.a] = grid_.axis(t.a).centre[static_cast<std::size_t>(a)];
    x[t.b] = grid_.axis(t.b).centre[static_cast<std::size_t>(b)];
    f.outside[cell] = in_face_axes(outside(x), d, sign, gas_);
  }
}

int Boundaries::cells_of(int face, int handle) const {
  const auto& cells = face_[static_cast<std::size_t>(face)].handle;
  return static_cast<int>(std::count(cells.begin(), cells.end(), static_cast<Handle>(handle)));
}

template <class Visit>
void Boundaries::for_each_face_cell(int face, bool ghosts, const Visit& visit) const {
  const int d = face / 2;
  const Across t = across(d);
  // Ghosts of the axes filled before are part of the face, so that edges and corners get values.
  const int ga = ghosts && t.a < d ? kGhosts : 0, gb = ghosts && t.b < d ? kGhosts : 0;
  const int na = grid_.n(t.a), nb = grid_.n(t.b);
  for_each_index(nb + 2 * gb, [&](int row) {
    const int b = row - gb, inside_b = std::clamp(b, 0, nb - 1);
    for (int a = -ga; a < na + ga; ++a)
      visit(a, b, static_cast<std::size_t>(std::clamp(a, 0, na - 1) + inside_b * na));
  });
}

void Boundaries::fill_face(Block& w, int face) const {
  const int d = face / 2, n = grid_.n(d);
  const Across t = across(d);
  const Real sign = face % 2 ? Real(-1) : Real(1);
  const int first = face % 2 ? n - 1 : 0, inward = face % 2 ? -1 : 1;
  const Face& f = face_[static_cast<std::size_t>(face)];
  const std::ptrdiff_t s = stride(w, d), sa = stride(w, t.a), sb = stride(w, t.b);
  const auto v = view_block<Real>(w);
  // Air drawn in through the rim of a cylinder gets faster on its way: u r is kept. An even velocity would
  // make up for the difference by a pressure of rho c u h/(2 R).
  const Metrics r = grid_.metrics(0);
  const bool rim = grid_.axisymmetric() && face == 1;
  const Real narrower = rim ? r.centre[n - 1] / r.centre[n] : Real(1);
  const Real narrowest = rim ? r.centre[n - 1] / r.centre[n + 1] : Real(1);
  for_each_face_cell(face, true, [&](int a, int b, std::size_t cell) {
    const Condition& c = conditions_[f.handle[cell]];
    const std::ptrdiff_t at = first * s + a * sa + b * sb, step = inward * s;
    const Primitive one = load(v, d, sign, at), two = n > 1 ? load(v, d, sign, at + step) : one;
    GhostStates g = {one, one};  // an axis of one cell carries no flux and no gradient
    const bool own = !f.outside.empty() && f.handle[cell] == f.base;
    if (n > 1)
      g = ghost_states(c, gas_, one, two, own ? f.outside[cell] : in_face_axes(c.state, d, sign, gas_),
                       f.anchor);
    if (is_open(c.type)) {
      g.first.un *= narrower;
      g.second.un *= narrowest;
    }
    store(v, d, sign, at - step, g.first);
    store(v, d, sign, at - 2 * step, g.second);
  });
}

void Boundaries::fill_periodic(Block& w, int axis) const {
  const Across t = across(axis);
  const int n = grid_.n(axis);
  const std::ptrdiff_t s = stride(w, axis), sa = stride(w, t.a), sb = stride(w, t.b);
  for_each_face_cell(2 * axis, true, [&](int a, int b, std::size_t) {
    for (Field& field : w) {
      Real* row = field.view().origin + a * sa + b * sb;
      for (int g = 1; g <= kGhosts; ++g) {
        row[-g * s] = row[(n - g) * s];
        row[(n - 1 + g) * s] = row[(g - 1) * s];
      }
    }
  });
}

void Boundaries::extend(Field& field) const {
  for (int axis = 0; axis < 3; ++axis) {
    if (!grid_.active(axis)) continue;
    const Across t = across(axis);
    const FieldView v = field.view();
    const std::array<std::ptrdiff_t, 3> stride{1, v.sy, v.sz};
    const std::ptrdiff_t s = stride[static_cast<std::size_t>(axis)];
    const std::ptrdiff_t last = (grid_.n(axis) - 1) * s;
    const bool periodic = is_periodic(axis);
    for_each_face_cell(2 * axis, false, [&](int a, int b, std::size_t) {
      Real* row =
          v.origin + a * stride[static_cast<std::size_t>(t.a)] + b * stride[static_cast<std::size_t>(t.b)];
      row[-s] = periodic ? row[last] : row[0];
      row[last + s] = periodic ? row[0] : row[last];
    });
  }
}

bool Boundaries::is_wall(int face) const {
  const BoundaryType type = conditions_[face_[static_cast<std::size_t>(face)].base].type;
  return type == BoundaryType::wall || type == BoundaryType::moving_wall;
}

bool Boundaries::has_patches(int face) const {
  const Face& f = face_[static_cast<std::size_t>(face)];
  return std::any_of(f.handle.begin(), f.handle.end(), [&](Handle handle) { return handle != f.base; });
}

bool Boundaries::holds_gas_back(int face) const {
  const std::vector<Handle>& cells = face_[static_cast<std::size_t>(face)].handle;
  return std::any_of(cells.begin(), cells.end(), [&](Handle handle) {
    const BoundaryType type = conditions_[handle].type;
    return type == BoundaryType::wall || type == BoundaryType::moving_wall || type == BoundaryType::slip ||
           type == BoundaryType::total_pressure;
  });
}

bool Boundaries::is_periodic(int axis) const {
  return conditions_[face_[static_cast<std::size_t>(2 * axis)].base].type == BoundaryType::periodic &&
         grid_.n(axis) >= kGhosts;
}

void Boundaries::fill(Block& w) const {
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == 1 && !grid_.active(1)) continue;  // a flow in the x-z plane reads nothing along y
    if (is_periodic(axis)) {
      fill_periodic(w, axis);
    } else {
      fill_face(w, 2 * axis);
      fill_face(w, 2 * axis + 1);
    }
  }
}

}  // namespace ejecta::gas
