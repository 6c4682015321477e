#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/text.hpp"
#include "case/case.hpp"
#include "jet/analysis.hpp"

namespace ejecta {

/// A jet that has blown steadily until it no longer changes at a height.
struct SettledJet {
  Case scenario;
  double time = 0.0;  ///< s, blown for
  std::int64_t steps = 0;
  double equivalent_velocity = 0.0;  ///< m/s, of the disc that flows, by the momentum formula
  Centreline line{};
  /// N, of the air that blows forward: settles with the jet, long before the air drawn in around it does
  double momentum_at_stand_off = 0.0;
  JetSample at_stand_off{};                   ///< on the axis
  std::vector<double> heights{}, momentum{};  ///< m and N, of planes across the jet
  double thrust = 0.0;                        ///< N, through the orifice
  nlohmann::ordered_json momentum_summary{};
};

/// The same orifice with its valve open from the start. Blows four times as long as the jet's head needs to
/// `height` (m above the orifice), z = 3.0 (J/rho)^(1/4) t^(1/2) (Hill & Ouellette 1999, J. Fluids Eng.
/// 121:95), and averages the momentum over the last of them. Nothing where `stop` ended it.
std::optional<SettledJet> settled_jet(const Case& c, double height, const Note& note,
                                      const std::function<bool()>& stop = {});

/// The case with the air taken as incompressible and blown through the orifice at `velocity`, m/s; 0: at the
/// momentum-equivalent one.
Case incompressible_jet(Case c, double velocity = 0.0);

/// The x > 0 at which a quantity that grows as x^2 reaches `wanted`: linear in x^2 between the two nearest of
/// the computed pairs (ascending), beyond their ends in proportion to the last.
double where_square_reaches(const std::vector<double>& x, const std::vector<double>& y, double wanted);

}  // namespace ejecta
