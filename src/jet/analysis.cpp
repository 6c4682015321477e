#include "jet/analysis.hpp"

#include <algorithm>
#include <cmath>

namespace ejecta {
namespace {

constexpr std::size_t kCellsBehind = 4;      ///< within which a captured shock has reached its pressure
constexpr double kLeastAxialVelocity = 1.0;  ///< m/s: below it there is no jet whose width could be told

double half_radius(const JetModel& jet, double z, double on_axis) {
  const Axis& r = jet.grid().axis(0);
  double before = on_axis, at_before = r.face.front();
  for (const double x : r.centre) {
    const double w = jet.sample({x, 0.0, z}).velocity.z();
    if (w < 0.5 * on_axis) {
      const double share = (before - 0.5 * on_axis) / (before - w);
      return at_before + share * (x - at_before) - r.face.front();
    }
    before = w;
    at_before = x;
  }
  return 0.0;
}

double supersonic_radius(const JetModel& jet, double z) {
  const Axis& r = jet.grid().axis(0);
  const double y = jet.grid().lower().y();
  double mach = jet.sample({r.centre.back(), y, z}).mach;
  for (auto i = r.centre.size() - 1; i-- > 0;) {
    const double inner = jet.sample({r.centre[i], y, z}).mach;
    if (inner >= 1.0)
      return r.centre[i] + (inner - 1.0) / (inner - mach) * (r.centre[i + 1] - r.centre[i]) - r.face.front();
    mach = inner;
  }
  return 0.0;
}

/// Place of the maximum of the parabola through three points around n.
double vertex(const std::vector<double>& x, const std::vector<JetSample>& s, std::size_t n) {
  const double left = (s[n].pressure - s[n - 1].pressure) / (x[n] - x[n - 1]);
  const double right = (s[n + 1].pressure - s[n].pressure) / (x[n + 1] - x[n]);
  const double at_left = 0.5 * (x[n - 1] + x[n]), at_right = 0.5 * (x[n] + x[n + 1]);
  return at_left + left / (left - right) * (at_right - at_left);
}

/// Place of a shock that the grid spreads over the cells about n, n + 1: mean of the places where the
/// pressure rises, weighed with the rises.
double smeared_shock(const Centreline& line, std::size_t n) {
  double rises = 0.0, moment = 0.0;
  for (std::size_t m = n > 0 ? n - 1 : n; m <= n + 1 && m + 1 < line.z.size(); ++m) {
    const double rise = std::max(0.0, line.samples[m + 1].pressure - line.samples[m].pressure);
    rises += rise;
    moment += rise * 0.5 * (line.z[m] + line.z[m + 1]);
  }
  return rises > 0.0 ? moment / rises : 0.5 * (line.z[n] + line.z[n + 1]);
}

}  // namespace

Centreline centreline(const JetModel& jet) {
  Centreline line;
  const Vec3 lower = jet.grid().lower();
  for (const double z : jet.grid().axis(2).centre) {
    const JetSample s = jet.sample({lower.x(), lower.y(), z});
    const double w = s.velocity.z();
    line.z.push_back(z - lower.z());
    line.samples.push_back(s);
    line.half_radius.push_back(w > kLeastAxialVelocity ? half_radius(jet, z, w) : 0.0);
    line.supersonic_radius.push_back(supersonic_radius(jet, z));
  }
  return line;
}

ShockStructure shock_structure(const Centreline& line, const Gas& gas) {
  ShockStructure found;
  const auto& s = line.samples;
  std::size_t peak = 0;
  for (std::size_t n = 1; n + 1 < s.size() && found.mach_disk == 0.0; ++n) {
    if (s[n].mach > s[peak].mach) peak = n;
    // The disk: the flow has been well above Mach 1 and falls below it within a few cells.
    if (s[peak].mach > 1.5 && s[n].mach >= 1.0 && s[n + 1].mach < 1.0) {
      // Its place is about where the Mach number falls fastest between the peak and here.
      std::size_t steepest = peak;
      for (std::size_t m = peak; m <= n; ++m)
        if (s[m].mach - s[m + 1].mach > s[steepest].mach - s[steepest + 1].mach) steepest = m;
      found.mach_disk = smeared_shock(line, steepest);
      found.peak_mach = s[peak].mach;
      double behind = 0.0;
      for (std::size_t m = steepest + 1; m < s.size() && m <= steepest + kCellsBehind; ++m)
        behind = std::max(behind, s[m].pressure);
      found.behind_over_normal_shock =
          behind / (s[peak].pressure * gas_normal_shock_ratio(gas, s[peak].mach));
    }
  }
  for (std::size_t n = 1; n + 1 < s.size() && found.pressure_maxima.size() < 8; ++n) {
    // The rise right behind the disk belongs to the disk.
    if (line.z[n] > 1.2 * found.mach_disk && line.z[n] > line.z[peak] && s[n].pressure > s[n - 1].pressure &&
        s[n].pressure >= s[n + 1].pressure && s[n].pressure > 1.02 * s.back().pressure)
      found.pressure_maxima.push_back(vertex(line.z, s, n));
  }
  if (!found.pressure_maxima.empty()) found.first_cell = found.pressure_maxima.front();
  return found;
}

FarField far_field(const Centreline& line, double equivalent_velocity, double diameter, double from,
                   double to) {
  std::vector<double> z, inverse, half;
  for (std::size_t n = 0; n < line.z.size(); ++n) {
    const double w = line.samples[n].velocity.z();
    if (line.z[n] < from || line.z[n] > to || w < kLeastAxialVelocity || line.half_radius[n] <= 0.0) continue;
    z.push_back(line.z[n]);
    inverse.push_back(equivalent_velocity / w);
    half.push_back(line.half_radius[n]);
  }
  return z.size() < 3 ? FarField{} : fit_far_field(z, inverse, half, diameter);
}

}  // namespace ejecta
