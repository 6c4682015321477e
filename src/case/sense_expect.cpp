#include <fmt/format.h>

#include <cmath>

#include "case/expression.hpp"
#include "case/extent.hpp"
#include "case/findings.hpp"

/// What `ejecta validate` needs.
namespace ejecta {
namespace {

void cells_stay_whole(const Case& c, Findings& found) {
  for (const AxisSpec& axis : c.grid.axis)
    for (int n : axis.cells)
      for (double factor : c.convergence.factors) {
        const bool refined = axis.cells.size() > 1 || n > 1;
        if (!refined || std::abs(n * factor - std::round(n * factor)) < 1e-9) continue;
        found.error("convergence.factors", fmt::format("{} cells times {:g} is no whole number", n, factor),
                    "factors that keep cells whole, or an order says nothing", "factors = [1, 2, 4]");
        return;
      }
}

}  // namespace

void sense_expectations(const Case& c, Findings& found) {
  for (std::size_t n = 0; n < c.expects.size(); ++n) {
    const ExpectSpec& e = c.expects[n];
    const std::string key = fmt::format("expect.{}", n);
    if (!e.quantity.starts_with('/'))
      found.error(key + ".quantity", "not a JSON pointer", "a path that starts with /",
                  "quantity = \"/bodies/0/drag_coefficient\"");
    const bool number = e.tolerance || e.relative_tolerance || e.at_least || e.at_most || e.converging;
    if (!number && e.text.empty())
      found.error(key, "nothing to compare with", "tolerance, relative_tolerance, at_least, at_most or text",
                  "reference = 1.087, relative_tolerance = 0.03");
    if (number && !e.text.empty())
      found.error(key + ".text", "a text and a number at once", "one of the two",
                  fmt::format("text = \"{}\"", e.text));
    if (e.converging && c.convergence.factors.size() < 3)
      found.error(key + ".converging", "it takes three grids to see that changes shrink",
                  "at least three convergence.factors", "factors = [1, 2, 4]");
    if (e.relative_tolerance && e.reference == 0.0)
      found.error(key + ".relative_tolerance", "a relative tolerance about the reference 0 allows nothing",
                  "an absolute tolerance", "tolerance = 0.01");
    if (e.at_least && e.at_most && *e.at_least > *e.at_most)
      found.error(key + ".at_least", "the lower limit is above the upper one", "at_least below at_most",
                  fmt::format("at_least = {}", *e.at_most));
  }
  const auto& factors = c.convergence.factors;
  if (factors.size() == 1)
    found.error("convergence.factors", "one grid shows no order", "at least two factors",
                "factors = [1, 2, 4]");
  for (std::size_t i = 1; i < factors.size(); ++i)
    if (!(factors[i] > factors[i - 1])) {
      found.error("convergence.factors", "factors must ascend", "coarse grids first", "factors = [1, 2, 4]");
      break;
    }
  cells_stay_whole(c, found);
  if (!c.exact.velocity && !c.exact.pressure && !c.exact.density) return;
  if (c.flow.solver == FlowSolver::none)
    return found.error("exact", "an exact flow without a flow", "a flow solver",
                       "[flow] solver = \"incompressible\"");
  const std::optional<Box> box = grid_box(c);
  const auto look = [&](const char* key, const std::string& text) {
    const Expression formula(text);
    constexpr int kLooks = 9;
    for (int n = 0; n < kLooks * kLooks * kLooks; ++n) {
      const Vec3 share((n % kLooks + 0.5) / kLooks, (n / kLooks % kLooks + 0.5) / kLooks,
                       (n / (kLooks * kLooks) + 0.5) / kLooks);
      const Vec3 x = box->low + share.cwiseProduct(box->high - box->low);
      if (std::isfinite(formula(x.x(), x.y(), x.z(), c.run.end_time))) continue;
      return found.error(fmt::format("exact.{}", key),
                         fmt::format("the formula gives no number at x, y, z = {:.4g}, {:.4g}, {:.4g} mm",
                                     1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z()),
                         "a number everywhere in the box", std::string(key) + " = \"= exp(-t) * sin(x)\"");
    }
  };
  if (!box) return;
  if (c.exact.velocity)
    for (const std::string& component : *c.exact.velocity) look("velocity", component);
  if (c.exact.pressure) look("pressure", *c.exact.pressure);
  if (c.exact.density) look("density", *c.exact.density);
}

}  // namespace ejecta
