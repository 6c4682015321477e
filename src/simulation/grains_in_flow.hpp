#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "case/case.hpp"
#include "coupling/unresolved/unresolved.hpp"
#include "dem/particles.hpp"
#include "flow/model/flow_model.hpp"
#include "output/history.hpp"

namespace ejecta {

/// The grains of a case in its flow: what they leave of it, what acts on them, and what a run tells of them.
/// Grains are the bodies of Particles from `first` on.
class GrainsInFlow {
 public:
  GrainsInFlow(const Case& c, const Grid& grid, double fluid_density, std::size_t first);

  void map(const Particles& particles, const FlowModel& flow, const CutCells& cut, double dt);
  /// `loads`: of all bodies.
  void collect(const Particles& particles, std::span<Load> loads);

  FluidFraction& fraction() { return fraction_; }
  const FluidFraction& fraction() const { return fraction_; }
  const UnresolvedCoupling& coupling() const { return coupling_; }
  /// What can be written beside the fields of the flow.
  std::vector<CellField> fields() const;
  /// What the user should know: a drag law outside its range.
  std::vector<std::string> warnings() const;
  /// Largest rate, 1/s, at which the drag of the last step took the velocity of the fluid in a cell.
  double fastest_drag() const;
  double largest_reynolds() const { return largest_reynolds_; }
  double least_fraction() const { return least_fraction_; }

  std::vector<NamedField> state_fields();
  std::vector<double> state() const;
  void restore(std::span<const double> state, std::size_t grains);

 private:
  const Case& case_;
  std::size_t first_;
  FluidFraction fraction_;
  UnresolvedCoupling coupling_;
  std::vector<char> here_;
  double largest_reynolds_ = 0.0, least_fraction_ = 1.0;
};

/// Sums over the grains that are there.
struct GrainSums {
  int count = 0;
  double mass = 0.0;            ///< kg
  Vec3 centre{0, 0, 0};         ///< m, of mass
  Vec3 velocity{0, 0, 0};       ///< m/s, mean by mass
  double height = 0.0;          ///< m, z below which 95 % of them lie
  double kinetic_energy = 0.0;  ///< J
};
/// Of all, or of those of one name.
GrainSums grain_sums(const Particles& particles, std::size_t first, const std::string& name = "");

/// Mean pressure on the lower less that on the upper face of the box along z, Pa, and how far they are apart,
/// m.
struct PressureDrop {
  double pressure = 0.0, distance = 0.0;
};
PressureDrop pressure_drop(const Grid& grid, ConstFieldView pressure, double scale);

/// Columns and rows of history/grains.csv.
std::vector<output::Column> grain_columns(bool flow);

}  // namespace ejecta
