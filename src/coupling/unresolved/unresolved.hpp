#pragma once
#include <array>
#include <span>
#include <vector>

#include "coupling/unresolved/drag_law.hpp"
#include "coupling/unresolved/kernel.hpp"
#include "dem/body.hpp"
#include "dem/loads.hpp"
#include "flow/cut_cells.hpp"
#include "flow/fluid_fraction.hpp"
#include "grid/grid.hpp"

namespace ejecta {

struct UnresolvedSetup {
  double fluid_density = 0.0;  ///< kg/m3
  double viscosity = 0.0;      ///< m2/s, kinematic
  /// m/s2: acts on the fluid as well, hidden in its hydrostatic pressure, and returns as buoyancy of grains
  Vec3 gravity{0, 0, 0};
  Vec3 body_force{0, 0, 0};  ///< m/s2 that drives the fluid like a gradient of pressure
  std::array<std::array<Beyond, 2>, 3> beyond{};
  bool acts = true;           ///< on the fluid: what a grain sees is then taken without its own wake
  double kernel_width = 3.0;  ///< in grain diameters
  double (*drag)(const drag::Surroundings&) = nullptr;  ///< beta, kg/s; null: none
};

/// The drag on a grain over a flow step, and where it is mapped.
struct GrainDrag {
  double coefficient = 0;  ///< beta of the step, kg/s: the drag is coefficient * (seen - carried)
  Vec3 carried{0, 0, 0};   ///< m/s, the velocity of the grain that this form stands for
  double reynolds = 0;     ///< e d |u - v| / nu at its beginning
  double fraction = 1;     ///< of the fluid around it, e
  double inside = 0;       ///< part of its kernel that lies in the box
};

/// Two-way coupling of grains smaller than a cell with the flow (Zhou et al. 2010, model A; paper Eqs 1-3).
/// One kernel maps volume, drag and what a grain sees, so that volume and Newton's third law are exact. Drag
/// over a step is that of the exact relaxation of the grain with the coefficient held, so that no step is too
/// long. Sums are taken grain by grain in their order: any number of threads gives the same bits.
class UnresolvedCoupling {
 public:
  UnresolvedCoupling(const Grid& grid, const UnresolvedSetup& setup);

  /// Fills what stands above "results" for a step of dt (s). `here`: which grains are there. velocity: of the
  /// fluid, m/s. `cut`: cells in bodies take no grains.
  void map(std::span<const Body> grains, const std::vector<char>& here,
           const std::array<ConstFieldView, 3>& velocity, const CutCells& cut, double dt, FluidFraction& f);
  /// Force on every grain over the flow step: drag, gradient of the pressure, viscous stress, buoyancy.
  void collect(std::span<const Body> grains, const std::vector<char>& here, const FluidFraction& f,
               std::span<Load> loads);

  const std::vector<GrainDrag>& drags() const { return drags_; }
  /// Drag on every grain in the last collection, N.
  const std::vector<Vec3>& drag_forces() const { return drag_force_; }
  /// Sum of solids times volume over the cells, m3: that of the grains in the box.
  double mapped_volume(const FluidFraction& f) const;

  std::vector<double> state() const;
  void restore(std::span<const double> state, std::size_t grains);

 private:
  struct Place {
    AxisWeights axis[3];
    double scale = 0.0;        // of the product of the weights: 1 but near bodies; 0: not there
    bool near_bodies = false;  // room_ counts
    double density = 0.0;      // 1/m3, of what it leaves in cells, as it sees it
    double spread = 0.0;       // m, standard deviation of where its force acts and its velocity is seen
  };
  void note_room(const CutCells& cut);
  void place(const Body& grain, double diameter, Place& out) const;
  void list_planes();
  template <class Visit>
  void for_each_run(const Place& p, int plane, const Visit& visit) const;
  template <std::size_t kN>
  std::array<double, kN + 1> gather(const Place& p, const std::array<ConstFieldView, kN>& fields) const;
  int wrapped(int i, int d) const { return i < 0 ? i + grid_.n(d) : i >= grid_.n(d) ? i - grid_.n(d) : i; }
  /// f(cell) = sum of values(grain, n) * weight over the grains, for kN fields at once.
  template <std::size_t kN, class Values>
  void scatter(const std::array<FieldView, kN>& to, const Values& values) const;
  void find_drag(const Body& grain, std::size_t n, const std::array<ConstFieldView, 3>& velocity,
                 ConstFieldView solids, double dt);

  const Grid& grid_;
  UnresolvedSetup setup_;
  Field room_;           // part of each cell whose momentum is the fluid's, where there are bodies
  bool bodies_ = false;  // there are
  Range3 around_;        // cells that they cut and fill
  std::array<std::vector<double>, 3> inverse_widths_;  // of the cells, 1/m
  std::vector<double> diameters_, volumes_;            // of the grains, m, m3
  std::vector<Place> places_;
  std::vector<int> first_, listed_;  // grains that reach into each plane of cells, in their order
  std::vector<GrainDrag> drags_;
  std::vector<Vec3> drag_force_;
  std::vector<Vec3> pushed_;  // m/s2, of what acts on a grain besides drag, gravity and contacts
  bool mapped_ = false;
};

}  // namespace ejecta
