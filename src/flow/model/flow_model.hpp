#pragma once
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/stopwatch.hpp"
#include "base/vec.hpp"
#include "case/case.hpp"
#include "flow/cut_cells.hpp"
#include "flow/fluid_fraction.hpp"
#include "flow/model/inflow.hpp"
#include "grid/cell_field.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// Longest step while a jet may blow, as a share of its pulse: it must not open and close unseen within one.
inline constexpr double kStepOfPulse = 0.01;

/// What a run has to say in numbers: result[group][name], without a group result[name].
struct Figure {
  std::string group, name;
  std::vector<double> value;  ///< one number or a vector
};

/// Air or liquid as the run loop sees it, whichever solver computes it.
class FlowModel {
 public:
  virtual ~FlowModel() = default;
  virtual double stable_dt(double time) = 0;
  virtual double courant(double dt) const = 0;
  virtual void advance(double time, double dt, CutCells& solids) = 0;
  /// With grains in it. Throws Error where the solver knows none.
  virtual void advance_with_grains(double time, double dt, CutCells& solids, FluidFraction& grains);

  virtual double density() const = 0;  ///< kg/m3, of the fluid at rest
  virtual FluidSeen seen() const = 0;
  /// Every field that can be written, with units in SI.
  virtual std::vector<CellField> fields() = 0;
  /// Names (with unit) and values at a point: velocity_x..z, pressure, total_pressure, k ...
  virtual std::vector<std::pair<std::string, std::string>> quantities() const = 0;
  virtual void sample(const Vec3& position, std::span<double> values) const = 0;

  virtual Vec3 momentum() const = 0;          ///< kg m/s in the box
  virtual double kinetic_energy() const = 0;  ///< J in the box
  virtual bool finite(Vec3* where) const = 0;
  /// The ledger's entries and what only this solver knows.
  virtual std::vector<Figure> report() const = 0;
  /// Wall time of every operator so far.
  virtual std::vector<OperatorTime> operators() const = 0;
  /// Everything a resume needs.
  virtual std::vector<NamedField> state_fields() = 0;
  virtual std::vector<double> state_numbers() const = 0;
  virtual void restore_numbers(std::span<const double> numbers, double time) = 0;
};

/// The solver the case asks for; null for flow.solver = "none". `inflow`: what its jets bring;
/// throws Error where the case has one and the inflow none.
std::unique_ptr<FlowModel> make_flow_model(const Case& c, const Grid& grid, Inflow inflow = {});

Grid make_grid(const Case& c);

}  // namespace ejecta
