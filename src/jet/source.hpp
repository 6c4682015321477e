#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "base/text.hpp"
#include "case/case.hpp"
#include "grid/grid.hpp"
#include "jet/inflow.hpp"

namespace ejecta {

/// The jet of a case as a boundary state over position and time, whatever it comes from, in axes of its own:
/// the origin in the orifice, z along the jet. JetInlet places it in the box.
class JetSource {
 public:
  virtual ~JetSource() = default;
  /// At a cell; half widths of the cell, m.
  virtual InflowState at(const Vec3& position, double half_x, double half_y, double time) const = 0;
  /// Highest axial velocity at `time` at a height above the orifice, m/s.
  virtual double fastest(double time, double height) const = 0;
  virtual std::vector<double> events() const = 0;
  virtual double dead_from() const = 0;  ///< s: no more air enters
};

/// `note` is told when a jet has to be computed first, which takes minutes.
std::unique_ptr<JetSource> make_jet_source(const Case& c, const Note& note = {});

/// True when a boundary or patch of the case is a jet.
bool has_jet(const Case& c);

}  // namespace ejecta
