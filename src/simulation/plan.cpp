#include "simulation/plan.hpp"

#include <fmt/format.h>

#include "jet/inlet.hpp"
#include "simulation/coupled_model.hpp"

namespace ejecta {

std::vector<OperatorTime> planned_step(const Case& c) {
  return CoupledModel(c, planned_inflow(c)).operator_times();
}

std::string plan_text(const Case& c, const std::vector<OperatorTime>& step) {
  std::string text = fmt::format("One step of {}:", c.path);
  int n = 0;
  for (const OperatorTime& op : step) text += fmt::format("\n  {:2}. {:<26} {}", ++n, op.name, op.equation);
  return text;
}

}  // namespace ejecta
