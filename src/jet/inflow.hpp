#pragma once
#include "case/case.hpp"
#include "flow/model/inflow.hpp"
#include "jet/valve.hpp"

namespace ejecta {

/// The self-similar round turbulent jet, quasi-steady behind the valve. With eta = r / (z - z0) and a =
/// (sqrt(2) - 1) / S^2:
///
///   u_z = U_c / (1 + a eta^2)^2,   u_r = U_c (eta f - G / eta),   G = eta^2 / (2 (1 + a eta^2)),   U_c = B
///   U_0 d / (z - z0)
///
/// the constant-eddy-viscosity solution (Schlichting 1933), nu_t = U_c (z - z0) / (8 a). U_0 is the
/// momentum-equivalent velocity of the valve; B = sqrt(3 a) / 2 gives the jet the thrust of the valve
/// exactly. k = 0.07 U_c^2 on the axis (Hussein, Capp & George 1994), shaped like the velocity.
class SelfSimilarJet {
 public:
  SelfSimilarJet(const JetSpec& jet, const ValveSpec& valve, double discharge_coefficient);
  double decay() const { return decay_; }
  /// `equivalent_velocity`: U_0 at the moment, m/s.
  InflowState at(const Vec3& position, double equivalent_velocity) const;

 private:
  Vec3 nozzle_;
  double diameter_, spread_, decay_, origin_;
};

/// The orifice itself as an inflow of uniform velocity (paper: 880 m/s at the inlet).
class NozzleInflow {
 public:
  NozzleInflow(const JetSpec& jet, const ValveSpec& valve);
  /// `share`: of the face cell that lies in the orifice.
  InflowState at(double share, double velocity) const;
  /// Share of the rectangle centre +- half that lies inside the orifice.
  double share(const Vec3& centre, double half_x, double half_y) const;

 private:
  Vec3 nozzle_;
  double radius_, intensity_;
};

}  // namespace ejecta
