#pragma once
#include <vector>

#include "case/case.hpp"
#include "jet/source.hpp"

namespace ejecta {

/// The air of one valve around its axis, at any place and time after its command, from the stored profile of
/// its jet.
///
/// Above the plane of the profile the jet is a cone with its tip in the orifice: u(r, z, t) = (z0/z) u(r
/// z0/z, z0, t'), which keeps its momentum, and t' = t - the time that the head of the jet takes from z0 to
/// z, which runs at half the velocity on the axis (Hill & Ouellette 1999). A command longer than the stored
/// one holds the jet as it is when the stored command ends; a shorter one ends it as the stored one ends, as
/// strong as it was by then.
class JetField {
 public:
  /// `source`: the jet of the case's valve and command.
  JetField(const Case& c, const JetSource& source);

  struct Air {
    double axial = 0.0, radial = 0.0;  ///< m/s, along the axis and away from it
  };
  /// `r`: from the axis; `z`: above the orifice, m; `t`: since a command that lasts `lasts`, s. `widening`:
  /// how much wider than the free jet it is taken to be, with the same momentum (see AirCoefficients).
  Air at(double r, double z, double t, double lasts, double widening = 1.0) const;
  /// m, of the free jet at that height: outside of it the air is still.
  double reach(double z) const { return reach_ * z; }
  /// s: the air of a command that lasts `lasts` is still at height z from this time on.
  double still_from(double z, double lasts) const { return ends_ + lasts - stored_ + lag(z); }
  double density() const { return density_; }  ///< kg/m3
  /// m, from the axis to where the velocity is half of that on it, over the height, of the open valve.
  double half_radius() const { return half_radius_; }

 private:
  double lag(double z) const;
  Air stored(double slope, double t) const;
  double density_, height_, stored_, ends_ = 0.0, reach_ = 0.0, half_radius_ = 0.0, open_velocity_ = 0.0;
  double slope_step_ = 0.0, time_step_ = 0.0;
  int slopes_ = 0, times_ = 0;
  std::vector<Air> table_;
};

}  // namespace ejecta
