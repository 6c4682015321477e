#pragma once
#include <array>
#include <functional>
#include <vector>

#include "flow/cut_cells.hpp"
#include "flow/piso/momentum.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// What turbulence there is for the law of the wall; origins null: laminar flow. With the density of a gas
/// (kg/m3) viscosities are dynamic, Pa s; without, m2/s.
struct WallTurbulence {
  ConstFieldView k, eddy_viscosity, density;
  bool present() const { return k.origin != nullptr; }
};

/// What a step does in cut cells after the kernels have treated the whole grid as fluid. A cell that keeps
/// its momentum (a carrier) is balanced over the fluid of itself and of the small cells it carries:
///
///   V du/dt = -sum A_f [q (u_f - u) - nu_eff (grad u + grad u^T)] - V grad p - wall friction
///
/// A_f: open parts of faces. The form in u_f - u leaves alone what moves with its solid. The wall takes the
/// friction of the law of the wall and the pressure that closes the balance, V grad p - sum A_f p_f: nothing
/// else passes it.
class CutFlow {
 public:
  /// viscosity: m2/s, of a gas Pa s. `passable`: sides of the box (2 d, 2 d + 1) through which fluid comes
  /// and goes.
  CutFlow(const Grid& grid, double viscosity, const std::array<bool, 6>& passable = {});

  /// New cells, for a step of dt s: volumes of fluid, and the momentum over density (m4/s) that their change
  /// puts into the sums. p: pressure at its beginning, over density or not; `moves_gaps`: over density, it
  /// moves what gaps thinner than a cell hold.
  Vec3 begin(const CutCells& cut, const std::array<ConstFieldView, 3>& u, ConstFieldView p, bool moves_gaps,
             double dt);
  /// Part of a cell's volume whose momentum it carries: 1 in plain fluid, 0 in solids.
  ConstFieldView carried() const { return carried_.view(); }
  Field& carried_field() { return carried_; }
  double solid_volume() const { return solid_volume_; }  ///< m3 of the box without momentum
  /// To be called after the carried field has been filled from elsewhere.
  void resume();

  /// Writes terms.out of cut cells, friction included, which is counted `weight` times (density, kg/m3) in
  /// cut.friction_impulse; of ghosts it says that nothing changes. Returns the momentum over density that the
  /// displaced fluid takes along, m4/s2.
  Vec3 predict(CutCells& cut, const MomentumTerms& terms, const WallTurbulence& turbulence, double weight);
  /// What sums over the whole faces of the box count through the parts of them that solids close.
  BoundaryFlow through_closed(const MomentumTerms& terms) const;
  Vec3 pressure_on_closed(ConstFieldView p) const;  ///< m4/s2 for p over density
  /// Ghosts take what the stencils should see.
  void extend(const CutCells& cut, const std::array<FieldView, 3>& u, const WallTurbulence& turbulence);
  /// Small cells move towards their carrier as continuity has it.
  void move_small(const CutCells& cut, const std::array<ConstFieldView, 3>& q,
                  const std::array<FieldView, 3>& u) const;
  /// Small cells have no pressure of their own: they take that of their carrier, extended by the gradient
  /// beyond it.
  void extend_to_small(const CutCells& cut, FieldView p) const;
  /// What small cells hold of a sum over cells goes to their carriers.
  static void fold(const CutCells& cut, FieldView f);
  /// Cells in solids take the pressure of their donors: round-off would add up in them from step to step.
  void extend_to_solids(const CutCells& cut, FieldView p);
  /// q on the faces of cut cells, of what flows through their open parts; closed ones move with the solid.
  void face_velocities(const CutCells& cut, const std::array<ConstFieldView, 3>& u_star, ConstFieldView p,
                       Real filter_time, const std::array<FieldView, 3>& q);
  /// q through open faces of the box, of cut cells beside them: as Boundaries::fill_face_velocity, but with
  /// the pressure gradient that has moved the cell (of a small one its carrier), which knows nothing of what
  /// lies behind a closed face. `open(side, face)`: whether the pressure moves what passes there, side 2 d or
  /// 2 d + 1. To be called after face_velocities.
  using OpenFace = std::function<bool(int, const std::array<int, 3>&)>;
  void end_velocities(const CutCells& cut, const OpenFace& open, const std::array<ConstFieldView, 3>& u_star,
                      ConstFieldView p, Real dt, const std::array<FieldView, 3>& q) const;
  /// Turns q into volume flow per whole area, the solid's through the closed part, and back.
  void close(const CutCells& cut, const std::array<FieldView, 3>& q);
  void reopen(const CutCells& cut, const std::array<FieldView, 3>& q) const;
  /// Remembers u_star of cut cells, which the kernel of the correction would spoil.
  void keep(const CutCells& cut, const std::array<ConstFieldView, 3>& u_star);
  void correct(const CutCells& cut, ConstFieldView phi, Real dt, const std::array<FieldView, 3>& q,
               const std::array<FieldView, 3>& u);
  /// Adds dt density p A of every wall to cut.pressure_impulse.
  void press(CutCells& cut, ConstFieldView p, double dt_density) const;
  /// Friction of the walls of a carrier over the time `step`, implicit in its velocity; what it takes is
  /// counted `weight` times (density, kg/m3) in cut.friction_impulse.
  void rub(CutCells& cut, const CutCell& carrier, const WallTurbulence& turbulence, Real step, double weight,
           std::array<Real, 3>& velocity) const;
  /// Of p in a carrier, exact where p is linear: the mean over the columns of its fluid, and what walls at
  /// edges of bodies take beyond the pressure of their cell. What volume times gradient asks of the walls
  /// beyond the pressure of their cell makes up for the rest of it: m4/s2 for p over density.
  struct Gradient {
    std::array<Real, 3> value, beyond;
  };
  Gradient gradient(const CutCell& carrier, ConstFieldView p) const;
  /// The mean over the columns alone, of what is no pressure.
  std::array<Real, 3> mean_gradient(const CutCell& carrier, ConstFieldView f) const;
  /// Velocity of the middle of the fluid that a carrier is balanced over, as walls sweep it, m/s.
  std::array<Real, 3> middle_moves(const CutCells& cut, const CutCell& carrier) const;
  /// What the velocity along d in the middle of the open part of an inner face has beyond that in the middle
  /// of the face.
  static Real to_middle_of_open(const Grid& grid, const CutCells& cut, int d, const std::array<int, 3>& face,
                                ConstFieldView u);

 private:
  /// A face of the box that solids close in part, or as a whole where fluid is locked in.
  struct ClosedEnd {
    int d;
    std::array<int, 3> face;
    double sign, area;  ///< +1 where the box lies above it; closed area, m2
  };
  /// What the difference between two cells adds to the gradient of a carrier, by entries of a field.
  struct Difference {
    std::ptrdiff_t here, beyond;
    int d;
    Real slope, pull;  ///< to the gradient, 1/m; to the balance of the pressure on open faces, m2
  };
  /// Differences across the open faces of a carrier, and after them those of its walls at edges.
  struct DifferencesOf {
    int first = 0, faces = 0, all = 0;
  };
  void list_differences(const CutCells& cut, ConstFieldView p);
  void list_walls_at_edge(const CutCells& cut, const CutCell& c, ConstFieldView p, Difference* first,
                          int& count) const;
  std::array<Real, 3> sum_of_differences(int first, int last, ConstFieldView f) const;
  void list_closed_ends(const CutCells& cut);
  /// Whether a small cell lies between walls so close that no cell of the fluid tells what moves in it.
  bool thin(const CutCells& cut, const GhostCell& g) const;
  /// The velocity there.
  std::array<Real, 3> in_gap(const CutCells& cut, const GhostCell& g, const std::array<Real, 3>& held,
                             const std::array<FieldView, 3>& u, const WallTurbulence& turbulence) const;
  /// There only the pressure moves the fluid.
  void push_thin(const CutCells& cut, ConstFieldView p, Real dt);
  /// Components of a small cell's velocity that are its carrier's: through sides of the box, where both share
  /// one pressure.
  std::array<bool, 3> bound_to_carrier(const CutCell& small) const;
  /// Nearest a centre counts to its wall, parts of a cell: friction there is implicit anyway.
  static constexpr Real kNearest = Real(0.05);
  const Grid& grid_;
  Real nu_;
  std::array<bool, 6> passable_;
  Real step_ = 0;  // s
  Field carried_;
  double solid_volume_ = 0;
  std::vector<std::array<int, 3>> touched_;           // cells whose carried_ is not 1, rows in turn
  std::vector<std::array<Real, 3>> gradient_, kept_;  // of cut.cells
  std::vector<std::array<Real, 3>> held_;             // velocity of ghosts at the beginning of the step
  std::vector<std::array<Real, 3>> values_;           // scratch of extend
  std::vector<Real> scalars_;                         // scratch of extend_to_solids
  std::vector<ClosedEnd> closed_ends_;
  std::vector<Difference> differences_;
  std::vector<DifferencesOf> differences_of_;  // of cut.cells, those that carry
  std::vector<Real> open_velocity_;            // of cut.faces while they are closed
  std::vector<Vec3> sums_;                     // scratch
};

}  // namespace ejecta
