#pragma once
#include <array>

#include "flow/fluid_fraction.hpp"
#include "flow/gas/boundary.hpp"
#include "flow/gas/gas_flow.hpp"
#include "flow/gas/geometry.hpp"

namespace ejecta::gas {

/// What grains smaller than a cell change in a step of gas (paper Eqs 1 to 3, model A). e: the gas's part of
/// a cell; C what is carried through a face, P the pressure and stress on it:
///
///   e1 U1 = e0 U0 - dt [div(e C) + e1 div P + (0, D u1 - S, (p + H_ref) de/dt + w)]
///
/// Pressure and stress act on the gas's part of a cell, so that gas at rest stays so wherever e jumps
/// (e grad p, the "nozzling" term); on the rest they act through the grains. -p de/dt is what grains work on
/// the gas as they come, w what the gas works on them by its drag. In the pressure equation
///
///   e dp = -dt K (div(e q) + de/dt)
///
/// and drag is implicit, over half the step for what it carries, over the whole of it for what it is.
class GasGrains {
 public:
  /// density: kg/m3, with which FluidFraction is normalised.
  GasGrains(const Grid& grid, const GasConstants& gas, double density);

  /// Cells and faces of a step of dt (s) in which grains take room.
  void begin(FluidFraction& f, const Boundaries& boundaries, double dt);

  /// Ghosts of faces through which a velocity is given, which is that of gas alone: in between grains it is
  /// faster, and its pressure falls by their drag.
  void fill_inlets(const Boundaries& boundaries, Block& w) const;

  /// Velocities of the faces of the middle of the step, and what a change of pressure adds to them, with
  /// drag.
  void drag_faces(const Block& middle, std::array<Field, 3>& velocity,
                  std::array<Field, 3>& conductance) const;
  /// Both times the open part of the faces, and back.
  void narrow_faces(std::array<Field, 3>& velocity, std::array<Field, 3>& conductance) const;
  void widen_faces(std::array<Field, 3>& velocity, std::array<Field, 3>& conductance) const;
  /// What the pressure equation of a cell has instead of the whole volume: e of it, and de/dt.
  void leave_to_gas(const Block& middle, Field& residual, Field& diagonal) const;
  /// Of a lower face along an axis, by its offset.
  Real open(int axis, std::ptrdiff_t face) const {
    return open_[static_cast<std::size_t>(axis)].view().origin[face];
  }

  /// Velocities of the cells of the middle with drag.
  void drag_middle(Block& middle) const;
  /// e q of the faces from q, m/s.
  const std::array<Field, 3>& carry(const std::array<const Field*, 3>& velocity);
  /// To which fluxes() writes with nothing carried: P of every face.
  std::array<Block, 3>& surface() { return surface_; }
  const Field& nothing() const { return nothing_; }

  /// Contents of the cells, e U, at the end of the step in `u` and at its beginning in `start`, from those of
  /// a step with the fluxes e C + P and no grains; fills f.push.
  void balance(FluidFraction& f, const Block& middle, Block& start, Block& u);
  /// Of contents makes U of the gas, and lets drag act; fills f.seen.
  void settle(FluidFraction& f, Block& u);

  /// Drag over dt where grains take no room of the gas; fills f.seen.
  void drag_alone(FluidFraction& f, double dt, Block& u) const;

  /// The gas's part of every cell after the last step.
  Field& part() { return part_; }
  double density() const { return density_; }
  /// Energy that grains took in the step, J, from what balance() was given; `part`: of the gas in every cell
  /// where they take no room.
  double energy_taken(const FluidFraction& f, const Block& middle, bool room, ConstFieldView part) const;

 private:
  /// Both become change(value, open part of the face).
  template <class Change>
  void change_faces(std::array<Field, 3>& velocity, std::array<Field, 3>& conductance,
                    const Change& change) const;

  const Grid& grid_;
  GasConstants gas_;
  double density_;
  double dt_ = 0.0;                      // s, of the step
  const FluidFraction* acts_ = nullptr;  // in the step
  Field part_, middle_part_, growth_;    // e at the end and in the middle of the step; de/dt, 1/s
  std::array<Field, 3> open_, flow_;     // of faces: e; e q, m/s
  std::array<Block, 3> surface_;
  Field nothing_;
};

}  // namespace ejecta::gas
