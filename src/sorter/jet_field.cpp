#include "sorter/jet_field.hpp"

#include <algorithm>
#include <cmath>

#include "case/extent.hpp"

namespace ejecta {
namespace {

constexpr int kSlopes = 160;
constexpr double kLargestSlope = 0.6;  ///< r/z: the edge of the box of the paper lies at 0.53
constexpr double kTimeStep = 1e-4;
constexpr double kFaint = 0.02;  ///< of the velocity on the axis: beyond it the air counts as still

}  // namespace

JetField::JetField(const Case& c, const JetSource& source)
    : density_(c.fluid.density), height_(jet_height(c)), stored_(c.valve.duration) {
  slopes_ = kSlopes;
  slope_step_ = kLargestSlope / (kSlopes - 1);
  const double begins = c.valve.opens_at;
  ends_ = source.dead_from() - begins;
  times_ = static_cast<int>(std::ceil(ends_ / kTimeStep)) + 2;
  time_step_ = kTimeStep;
  table_.resize(static_cast<std::size_t>(slopes_) * static_cast<std::size_t>(times_));
  for (int t = 0; t < times_; ++t)
    for (int s = 0; s < slopes_; ++s) {
      const double r = s * slope_step_ * height_;
      const Vec3 u = source.at(Vec3(r, 0, height_), 0.0, 0.0, begins + t * time_step_).velocity;
      if (t * time_step_ < ends_) table_[static_cast<std::size_t>(t * slopes_ + s)] = {u.z(), u.x()};
    }
  open_velocity_ = stored(0.0, stored_).axial;
  for (double slope = kLargestSlope; slope > 0.0; slope -= slope_step_) {
    const double u = stored(slope, stored_).axial;
    if (reach_ == 0.0 && u > kFaint * open_velocity_) reach_ = slope;
    if (half_radius_ == 0.0 && u > 0.5 * open_velocity_) half_radius_ = slope;
  }
}

double JetField::lag(double z) const {
  // dz/dt = u_c(z)/2, u_c = u0 z0/z
  return open_velocity_ > 0.0 ? (z * z - height_ * height_) / (height_ * open_velocity_) : 0.0;
}

JetField::Air JetField::stored(double slope, double t) const {
  const double s = slope / slope_step_, k = t / time_step_;
  if (!(k > 0.0) || k >= times_ - 1 || s >= slopes_ - 1) return {};
  const int i = static_cast<int>(s), j = static_cast<int>(k);
  const double x = s - i, y = k - j;
  const Air *a = &table_[static_cast<std::size_t>(j * slopes_ + i)], *b = a + slopes_;
  const auto mixed = [&](double p, double q, double r, double w) {
    return (1 - y) * ((1 - x) * p + x * q) + y * ((1 - x) * r + x * w);
  };
  return {mixed(a[0].axial, a[1].axial, b[0].axial, b[1].axial),
          mixed(a[0].radial, a[1].radial, b[0].radial, b[1].radial)};
}

JetField::Air JetField::at(double r, double z, double t, double lasts, double widening) const {
  if (z <= 0.0) return {};
  const double since = t - lag(z), slope = r / (widening * z);
  double then = since, strength = height_ / (widening * z);
  if (lasts > stored_ && since > stored_) then = std::max(stored_, since - (lasts - stored_));
  if (lasts < stored_ && since > lasts) {
    then = since + (stored_ - lasts);
    strength *= stored(0.0, lasts).axial / open_velocity_;
  }
  Air air = stored(slope, then);
  air.axial *= strength;
  air.radial *= strength;
  return air;
}

}  // namespace ejecta
