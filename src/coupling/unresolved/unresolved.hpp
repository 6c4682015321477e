#pragma once
#include <array>
#include <span>
#include <vector>

#include "coupling/unresolved/grain_drag.hpp"
#include "coupling/unresolved/kernel.hpp"
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
/// long. Grains are taken row by row of cells, those of a row in their order: neighbours meet in the cache,
/// and any number of threads gives the same bits.
class UnresolvedCoupling {
 public:
  UnresolvedCoupling(const Grid& grid, const UnresolvedSetup& setup);

  /// Fills what stands above "results" for a step of dt (s). `here`: which grains are there. velocity: of the
  /// fluid, m/s; density: of a gas, kg/m3, origin null: that of the fluid at rest. `cut`: cells in bodies
  /// take no grains.
  void map(std::span<const Body> grains, const std::vector<char>& here,
           const std::array<ConstFieldView, 3>& velocity, ConstFieldView density, const CutCells& cut,
           double dt, FluidFraction& f);
  /// Force on every grain over the flow step: drag, gradient of the pressure, viscous stress, buoyancy. Fills
  /// f.work where the setup asks for it.
  void collect(std::span<const Body> grains, const std::vector<char>& here, FluidFraction& f,
               std::span<Load> loads);

  /// Of the last mapping.
  const GrainExtremes& extremes() const { return extremes_; }
  /// Drag on every grain in the last collection, N.
  const std::vector<Vec3>& drag_forces() const { return drag_force_; }
  /// Sum of solids times volume over the cells, m3: that of the grains in the box.
  double mapped_volume(const FluidFraction& f) const;

  std::vector<double> state() const;
  void restore(std::span<const double> state, std::size_t grains);

 private:
  /// Cells of a row that are read and written together.
  static constexpr int kRun = 4;
  /// A grain and its kernel; its weights along each axis stand in weights_.
  struct Place {
    int grain = 0;
    std::array<int, 3> first{}, count{};  // cells; along x whole runs
    bool near_bodies = false;             // room_ counts
    bool in_pieces = false;               // its rows go on at the other end of the box
    Real scale = 0;                       // of the product of the weights: 1 but near bodies
    double inside = 0.0;                  // part of the kernel in the box; 0: the grain is not there
    double density = 0.0;                 // 1/m3, of what it leaves in cells, as it sees it
    double spread = 0.0;                  // m, standard deviation of where its force acts
  };
  void note_room(const CutCells& cut);
  void note_grains(std::span<const Body> grains);
  /// Lists the grains that are there by rows of cells.
  void sort_grains(std::span<const Body> grains, const std::vector<char>& here);
  void place_grains(std::span<const Body> grains);
  int place(const Body& grain, std::size_t at);
  void take_whole_runs(Place& p, Real* along) const;
  void place_near_bodies(std::size_t at);
  const Real* weights(std::size_t at, std::size_t axis) const {
    return weights_.data() + (3 * at + axis) * stride_;
  }
  template <class Visit>
  void for_each_row(std::size_t at, int plane, const Visit& visit) const;
  template <std::size_t kN>
  std::array<double, kN> gather(std::size_t at, const std::array<ConstFieldView, kN>& fields) const;
  template <std::size_t kN>
  std::array<double, kN> gather_in_pieces(std::size_t at, const std::array<ConstFieldView, kN>& fields) const;
  /// visit(place) for the grains that reach into a plane of cells, and the plane's number in their kernels.
  template <class Visit>
  void for_each_in_plane(int k, const Visit& visit) const;
  /// f(cell) = sum of values(place) * weight over the grains, for kN fields at once.
  template <std::size_t kN, class Values>
  void scatter(const std::array<FieldView, kN>& to, const Values& values) const;
  /// fields: velocity, solids, density.
  void find_drags(std::span<const Body> grains, const std::array<ConstFieldView, 5>& fields, double dt);
  void look_around(std::span<const Body> grains, std::size_t at, const std::array<ConstFieldView, 5>& fields,
                   drag::Batch& batch, std::size_t n) const;
  void find_work(std::span<const Body> grains, FluidFraction& f) const;
  int wrapped(int i, int d) const { return i < 0 ? i + grid_.n(d) : i >= grid_.n(d) ? i - grid_.n(d) : i; }

  const Grid& grid_;
  UnresolvedSetup setup_;
  Field room_;           // part of each cell whose momentum is the fluid's, where there are bodies
  bool bodies_ = false;  // there are
  Range3 around_;        // cells that they cut and fill
  std::array<std::vector<double>, 3> inverse_widths_;  // of the cells, 1/m
  std::vector<double> diameters_, volumes_, masses_;   // of the grains, m, m3, kg
  std::vector<std::array<int, 3>> cells_;              // in which they are, or were when they last were there
  std::vector<int> listed_;                            // those that are there, row by row
  std::vector<int> first_of_row_;  // in listed_ and what follows, which stand in its order
  std::vector<Place> places_;
  std::vector<Real> weights_;  // stride_ along each axis
  std::size_t stride_ = kRun;
  int reach_ = 0;  // in planes, of the grains from the one they are in
  std::vector<GrainDrag> drags_;
  double dt_ = 0.0;  // s, of the last mapping
  GrainExtremes extremes_;
  std::vector<Vec3> drag_force_;  // of each grain
  std::vector<Vec3> pushed_;      // m/s2, of what acts on a grain besides drag, gravity and contacts
  bool mapped_ = false;
};

}  // namespace ejecta
