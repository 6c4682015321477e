#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "case/case.hpp"
#include "flow/gas/state.hpp"
#include "flow/ideal_gas.hpp"
#include "grid/grid.hpp"

namespace ejecta::gas {

/// State of a gas in SI units, pressure absolute.
struct GasState {
  double density = 1.0;
  Vec3 velocity{0, 0, 0};
  double pressure = 0.0;
  double k = 0.0;  ///< m2/s2
  double e = 0.0;  ///< epsilon, m2/s3, or omega, 1/s
};

/// What acts on a face of the box or on a patch of it. Its owner may change the values between steps (a
/// valve).
struct Condition {
  BoundaryType type = BoundaryType::symmetry;
  GasState state;                  ///< outside: the gas that flows in, the pressure kept, the wall's velocity
  double total_pressure = 0.0;     ///< Pa absolute
  double total_temperature = 0.0;  ///< K
};

/// The two states beyond a face; velocities along the inward normal in `un`, along the remaining axes in
/// ascending order in `ut` and `us`; p is the difference to the reference pressure.
struct GhostStates {
  Primitive first, second;
};

/// Ghosts of `condition` from the two cells inside; `outside` is the condition's state in the face's axes.
/// `anchor` is the share of the difference to the far pressure that a transmissive face takes back: sigma
/// h/L, h the cell, L the box, so that the incoming wave is sigma c/L (p_far - p) (Poinsot & Lele 1992, J.
/// Comput. Phys. 101:104). Apart from that the gas beyond is the gas inside, and the Riemann solver sends
/// nothing back.
GhostStates ghost_states(const Condition& condition, const GasConstants& gas, const Primitive& first,
                         const Primitive& second, const Primitive& outside, Real anchor);

/// A gas of total pressure p0 (absolute) and temperature T0 that enters along +n from a convergent nozzle:
/// meets the invariant u - 2c/(gamma-1) that arrives from inside, or is sonic when that asks for more.
/// Returns zero velocity when the pressure inside is higher (the valve holds the air back).
Primitive inlet_total_pressure(const GasConstants& gas, double total_pressure, double total_temperature,
                               const Primitive& inside);

/// The six faces of a grid with their patches: fills two ghost layers of the primitive variables.
class Boundaries {
 public:
  Boundaries(const Grid& grid, const GasConstants& gas);

  /// Face 0..5 = x_min, x_max, y_min, ... gets `condition`; returns its handle.
  int set_face(int face, const Condition& condition);
  /// A disc of `radius` around `centre` on a face; returns its handle. Cells belong to it by their centre.
  int add_disc(int face, const Vec3& centre, double radius, const Condition& condition);
  /// Gives each cell of a face, its discs apart, an outside of its own: outside(centre of the face's cell)
  /// takes the place of the condition's state. To be called again when it changes; allocates the first time
  /// only.
  void set_states(int face, const std::function<GasState(const Vec3&)>& outside);
  Condition& condition(int handle) { return conditions_[static_cast<std::size_t>(handle)]; }
  const Condition& condition(int handle) const { return conditions_[static_cast<std::size_t>(handle)]; }
  /// What acts on cell a + b n_a of a face; a, b its axes in ascending order.
  const Condition& at(int face, std::size_t cell) const {
    return conditions_[face_[static_cast<std::size_t>(face)].handle[cell]];
  }
  /// Cells of a face that belong to a handle.
  int cells_of(int face, int handle) const;

  void fill(Block& w) const;
  /// First ghost layer of a derived field: that of the cell inside (periodic: of the far side).
  void extend(Field& field) const;
  bool is_wall(int face) const;  ///< apart from its patches
  bool has_patches(int face) const;
  bool is_periodic(int axis) const;
  bool holds_gas_back(int face) const;  ///< somewhere: a wall, an inlet while it is shut

 private:
  using Handle = std::uint16_t;  ///< index of a condition, one a cell
  /// Throws InputError where there are more than handles.
  Handle keep(const Condition& condition);
  struct Face {
    Handle base = 0;                 ///< of the face itself
    std::vector<Handle> handle;      ///< per cell of the face
    std::vector<Primitive> outside;  ///< per cell, where set_states gave them
    Real anchor = 0;                 ///< of ghost_states
  };
  template <class Visit>
  void for_each_face_cell(int face, bool ghosts, const Visit& visit) const;
  void fill_face(Block& w, int face) const;
  void fill_periodic(Block& w, int axis) const;
  const Grid& grid_;
  GasConstants gas_;
  std::array<Face, 6> face_;
  std::vector<Condition> conditions_;
};

}  // namespace ejecta::gas
