#include "flow/model/flow_model.hpp"

#include "base/error.hpp"
#include "case/extent.hpp"

#include "flow/model/compressible_model.hpp"
#include "flow/model/incompressible_model.hpp"

namespace ejecta {

void FlowModel::advance_with_grains(double, double, CutCells&, FluidFraction&) {
  throw Error("this solver knows no grains");
}

Grid make_grid(const Case& c) {
  std::array<Axis, 3> axis;
  for (std::size_t d = 0; d < 3; ++d) {
    const AxisSpec& a = c.grid.axis[d];
    axis[d] = make_axis(a.points, a.cells, a.grading);
  }
  return Grid(axis[0], axis[1], axis[2], c.grid.geometry == Geometry::axisymmetric);
}

std::unique_ptr<FlowModel> make_flow_model(const Case& c, const Grid& grid, Inflow inflow) {
  if (c.flow.solver != FlowSolver::none && jet_face(c) && !inflow.at && !inflow.supply)
    throw Error("the case has a jet, but nobody said what it brings (Inflow)");
  switch (c.flow.solver) {
    case FlowSolver::none:
      return nullptr;
    case FlowSolver::incompressible:
      return make_incompressible_model(c, grid, std::move(inflow));
    case FlowSolver::compressible:
    case FlowSolver::compressible_piso:
      break;
  }
  return make_compressible_model(c, grid, std::move(inflow));
}

}  // namespace ejecta
