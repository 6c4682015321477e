#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/vec.hpp"
#include "case/case.hpp"
#include "flow/cut_cells.hpp"
#include "grid/grid.hpp"
#include "output/report_data.hpp"
#include "output/vtk_rectilinear.hpp"

namespace ejecta {

/// Air or liquid as the run loop sees it, whichever solver computes it.
class FlowModel {
 public:
  virtual ~FlowModel() = default;
  virtual double stable_dt(double time) = 0;
  virtual double courant(double dt) const = 0;
  virtual void advance(double time, double dt, CutCells& solids) = 0;

  virtual double density() const = 0;  ///< kg/m3, of the fluid at rest
  virtual std::array<ConstFieldView, 3> velocity() const = 0;
  /// Every field that can be written, with units in SI.
  virtual std::vector<output::CellField> fields() = 0;
  /// Names (with unit) and values at a point: velocity_x..z, pressure, total_pressure, k ...
  virtual std::vector<std::pair<std::string, std::string>> quantities() const = 0;
  virtual void sample(const Vec3& position, std::span<double> values) const = 0;

  virtual Vec3 momentum() const = 0;          ///< kg m/s in the box
  virtual double kinetic_energy() const = 0;  ///< J in the box
  virtual bool finite(Vec3* where) const = 0;
  /// Adds the ledger's entries and what only this solver knows to result.json.
  virtual void report(nlohmann::ordered_json& result) const = 0;
  /// Wall time of every operator so far.
  virtual std::vector<output::OperatorTime> operators() const = 0;
  /// Times at which boundary states have kinks, s.
  virtual std::vector<double> events() const = 0;
  /// Everything a resume needs.
  virtual std::vector<Field*> state_fields() = 0;
  virtual std::vector<double> state_numbers() const = 0;
  virtual void restore_numbers(std::span<const double> numbers, double time) = 0;
};

/// The solver the case asks for; null for flow.solver = "none".
std::unique_ptr<FlowModel> make_flow_model(const Case& c, const Grid& grid);

Grid make_grid(const Case& c);

}  // namespace ejecta
