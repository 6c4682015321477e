#include "simulation/jet_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "base/thread_budget.hpp"
#include "case/load.hpp"
#include "jet/settled.hpp"
#include "output/report.hpp"
#include "output/run_directory.hpp"
#include "simulation/archive.hpp"
#include "simulation/jet_figures.hpp"

namespace ejecta {
namespace {

using nlohmann::ordered_json;

ordered_json settled_entry(const SettledJet& jet) {
  return {{"thrust_N", jet.thrust},
          {"momentum_N", jet.momentum_at_stand_off},
          {"velocity_m_s", jet.at_stand_off.velocity.z()},
          {"mach", jet.at_stand_off.mach},
          {"total_gauge_Pa", jet.at_stand_off.total_gauge},
          {"settled_s", jet.time},
          {"steps", jet.steps}};
}

/// The velocities found for each pressure, beside the formula's.
output::Figure velocities_figure(const std::vector<double>& gauge, const ordered_json& jets) {
  output::Figure f{"Equivalent inlet velocity", "supply, gauge [kPa]", "velocity [m/s]"};
  for (const auto& [label, key] :
       {std::pair{"momentum formula", "equivalent_velocity_formula_m_s"},
        {"same momentum at the stand-off", "equivalent_velocity_momentum_m_s"},
        {"same total pressure at the stand-off", "equivalent_velocity_total_pressure_m_s"}}) {
    output::FigureSeries s{label, {}, {}};
    for (std::size_t n = 0; n < gauge.size(); ++n)
      if (jets[n].contains(key)) s.x.push_back(1e-3 * gauge[n]), s.y.push_back(jets[n][key]);
    s.dashed = f.series.empty();
    if (!s.x.empty()) f.series.push_back(std::move(s));
  }
  return f;
}

}  // namespace

std::optional<ordered_json> sweep_jet(const Case& original, const Context& context) {
  const ThreadBudget budget(context.threads);
  Case c = original;
  std::sort(c.jet.sweep_pressures.begin(), c.jet.sweep_pressures.end());
  std::sort(c.jet.sweep_velocities.begin(), c.jet.sweep_velocities.end());
  if (c.jet.sweep_pressures.empty() && c.jet.sweep_velocities.empty())
    throw InputError(fmt::format("{} has no jets to sweep", c.path),
                     {.expected = "jet.sweep_pressures or jet.sweep_velocities",
                      .example = "[jet] sweep_pressures = [\"400 kPa gauge\", \"700 kPa gauge\"]"});
  if (context.files)
    output::RunDirectory::require_creatable(context.files->directory, context.files->overwrite);
  const double height = c.launch.stand_off, start = wall_seconds();
  output::Figure lines = centreline_figure("Total pressure on the axis");

  ordered_json slow = ordered_json::array(), fast = ordered_json::array();
  std::vector<double> momenta, totals, gauges;
  for (const double velocity : c.jet.sweep_velocities) {
    const auto settled = settled_jet(incompressible_jet(c, velocity), height, context.note, context.stop);
    if (!settled) return std::nullopt;
    const SettledJet& jet = *settled;
    momenta.push_back(jet.momentum_at_stand_off);
    totals.push_back(jet.at_stand_off.total_gauge);
    slow.push_back(settled_entry(jet));
    slow.back()["inlet_velocity_m_s"] = velocity;
    lines.series.push_back(centreline_series(fmt::format("incompressible, {:.0f} m/s", velocity), jet.line));
    lines.series.back().dashed = true;
  }
  for (const double supply : c.jet.sweep_pressures) {
    Case at = c;
    at.valve.supply_pressure = supply;
    const auto settled = settled_jet(at, height, context.note, context.stop);
    if (!settled) return std::nullopt;
    const SettledJet& jet = *settled;
    gauges.push_back(supply - c.environment.pressure);
    ordered_json e = settled_entry(jet);
    e["supply_gauge_Pa"] = gauges.back();
    const ShockStructure shocks = shock_structure(jet.line, Gas{c.fluid.gamma, c.fluid.gas_constant});
    e["mach_disk_m"] = shocks.mach_disk;
    e["behind_over_normal_shock"] = shocks.behind_over_normal_shock;
    e["equivalent_velocity_formula_m_s"] = jet.equivalent_velocity;
    if (!slow.empty()) {
      e["equivalent_velocity_momentum_m_s"] =
          where_square_reaches(c.jet.sweep_velocities, momenta, jet.momentum_at_stand_off);
      e["equivalent_velocity_total_pressure_m_s"] =
          where_square_reaches(c.jet.sweep_velocities, totals, jet.at_stand_off.total_gauge);
    }
    fast.push_back(std::move(e));
    lines.series.push_back(
        centreline_series(fmt::format("compressible, {:.0f} kPa", 1e-3 * gauges.back()), jet.line));
  }

  const ordered_json result{{"title", c.run.title},
                            {"outcome", "jets swept"},
                            {"stand_off_m", height},
                            {"threads", thread_count()},
                            {"wall_time_s", wall_seconds() - start},
                            {"compressible", fast},
                            {"incompressible", slow}};
  if (!context.files) return result;
  const RunFiles& files = *context.files;
  const auto directory = output::RunDirectory::create(files.directory, files.overwrite);
  const output::Provenance provenance{.command = files.command,
                                      .case_path = c.path,
                                      .input = input_of(c),
                                      .threads = thread_count(),
                                      .overrides = files.overrides,
                                      .files = files_of(c)};
  directory.write_case(provenance.input);
  directory.write_manifest(output::make_manifest(provenance));
  output::Figures figures;
  if (!fast.empty()) figures.add(velocities_figure(gauges, fast));
  figures.add(beyond(lines, 1e3 * far_field_from(c), "Total pressure on the axis, far field"));
  figures.add(std::move(lines));
  figures.write(directory.figures());
  directory.write_result(result);
  directory.forget_earlier();
  if (c.output.report) output::write_report(directory.path());
  return result;
}

}  // namespace ejecta
