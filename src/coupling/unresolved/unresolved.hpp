#pragma once
#include <array>
#include <span>
#include <vector>

#include "coupling/unresolved/eddy_walk.hpp"
#include "coupling/unresolved/grain_drag.hpp"
#include "coupling/unresolved/grain_map.hpp"
#include "dem/body.hpp"
#include "dem/loads.hpp"
#include "flow/cut_cells.hpp"
#include "flow/fluid_fraction.hpp"
#include "grid/grid.hpp"

namespace ejecta {

struct UnresolvedSetup {
  double fluid_density = 0.0;  ///< kg/m3, of the fluid at rest
  double viscosity = 0.0;      ///< m2/s, kinematic, at that density
  bool works = false;          ///< what drag works on grains is the fluid's loss: of a gas with an energy
  /// m/s2: acts on the fluid as well, hidden in its hydrostatic pressure, and returns as buoyancy of grains
  Vec3 gravity{0, 0, 0};
  Vec3 body_force{0, 0, 0};  ///< m/s2 that drives the fluid like a gradient of pressure
  std::array<std::array<Beyond, 2>, 3> beyond{};
  bool acts = true;           ///< on the fluid: what a grain sees is then taken without its own wake
  double kernel_width = 3.0;  ///< in grain diameters
  bool disperses = false;     ///< turbulence spreads grains (eddy_walk.hpp)
  std::uint64_t seed = 0;     ///< of its eddies
  void (*drag)(const drag::Step&, drag::Batch&) = nullptr;  ///< of a law, grain_drag.hpp; null: none
};

/// The drag on a grain over a flow step: coefficient * (seen - carried), N.
struct GrainDrag {
  double coefficient = 0;  ///< beta of the step, kg/s
  Vec3 carried{0, 0, 0};   ///< m/s, the velocity of the grain that this form stands for
};

/// What grains met at the beginning of a step.
struct GrainExtremes {
  double reynolds = 0;  ///< largest e d |u - v| / nu
  double fraction = 1;  ///< least e
};

/// Two-way coupling of grains smaller than a cell with the flow (Zhou et al. 2010, model A; paper Eqs 1-3).
/// One kernel maps volume, drag and what a grain sees, so that volume and Newton's third law are exact. Drag
/// over a step is that of the exact relaxation of the grain with the coefficient held, so that no step is too
/// long.
class UnresolvedCoupling {
 public:
  UnresolvedCoupling(const Grid& grid, const UnresolvedSetup& setup);

  /// Fills what stands above "results" for a step of dt (s). `here`: which grains are there. `cut`: cells in
  /// bodies take no grains.
  void map(std::span<const Body> grains, const std::vector<char>& here, const FluidSeen& fluid,
           const CutCells& cut, double dt, FluidFraction& f);
  /// Force on every grain over the flow step: drag, gradient of the pressure, viscous stress, buoyancy. Fills
  /// f.work where the setup asks for it.
  void collect(std::span<const Body> grains, const std::vector<char>& here, FluidFraction& f,
               std::span<Load> loads);

  /// Of the last mapping.
  const GrainExtremes& extremes() const { return extremes_; }
  /// Drag on every grain in the last collection, N.
  const std::vector<Vec3>& drag_forces() const { return drag_force_; }
  /// Sum of solids times volume over the cells, m3: that of the grains in the box.
  double mapped_volume(const FluidFraction& f) const { return map_.integral(f.solids.view()); }

  std::vector<double> state() const;
  void restore(std::span<const double> state, std::size_t grains);

 private:
  void note_grains(std::span<const Body> grains);
  void find_drags(std::span<const Body> grains, const FluidSeen& fluid, ConstFieldView solids, double dt);
  /// What the drag on the grain of a place depends on, as number n of a batch. Returns the velocity of the
  /// eddy around it, m/s.
  Vec3 look_around(std::span<const Body> grains, std::size_t at, const FluidSeen& fluid,
                   ConstFieldView solids, double dt, drag::Batch& batch, std::size_t n);
  /// `alone`: the grain in the mean flow.
  Vec3 eddy_around(std::size_t at, const FluidSeen& fluid, const drag::Surroundings& alone, double dt);
  void find_work(std::span<const Body> grains, FluidFraction& f) const;

  const Grid& grid_;
  UnresolvedSetup setup_;
  GrainMap map_;
  std::vector<double> diameters_, volumes_, masses_;  // of the grains, m, m3, kg
  EddyWalk eddies_;
  std::vector<GrainDrag> drags_;
  double dt_ = 0.0;  // s, of the last mapping
  GrainExtremes extremes_;
  std::vector<Vec3> drag_force_;  // of each grain
  std::vector<Vec3> pushed_;      // m/s2, of what acts on a grain besides drag, gravity and contacts
  bool mapped_ = false;
};

}  // namespace ejecta
