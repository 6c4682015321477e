#include <algorithm>
#include <cmath>

#include "flow/godunov/boundary.hpp"

namespace ejecta::godunov {
namespace {

/// Mirror image: the normal velocity changes sign.
Primitive mirrored(Primitive w) {
  w.un = -w.un;
  return w;
}

/// Mirror image about a wall that sticks and moves with `wall`.
Primitive stuck(const Primitive& w, const Primitive& wall) {
  Primitive g = mirrored(w);
  g.ut = 2 * wall.ut - w.ut;
  g.us = 2 * wall.us - w.us;
  return g;
}

/// Static pressure `p` outside. What leaves takes its own entropy along, what enters is the gas outside with
/// the velocity it is drawn in with. Supersonic outflow hears nothing.
Primitive open_to(const GasConstants& gas, const Primitive& inside, const Primitive& outside, Real p) {
  const Real c2 = gas.sound_speed_squared(inside.rho, inside.p);
  Primitive g = inside;
  if (inside.un <= 0 && inside.un * inside.un >= c2) return g;
  g.p = p;
  g.rho = inside.rho + (p - inside.p) / c2;
  if (inside.un > 0) {
    g.rho = outside.rho * (p + gas.reference_pressure) / (outside.p + gas.reference_pressure);
    g.ut = outside.ut;
    g.us = outside.us;
    g.k = outside.k;
    g.e = outside.e;
  }
  return g;
}

Primitive inlet_velocity(const GasConstants& gas, const Primitive& inside, const Primitive& outside) {
  Primitive g = outside;
  const Real c2 = gas.sound_speed_squared(outside.rho, outside.p);
  if (outside.un > 0 && outside.un * outside.un >= c2) return g;
  g.p = inside.p;
  g.rho = outside.rho * (inside.p + gas.reference_pressure) / (outside.p + gas.reference_pressure);
  return g;
}

}  // namespace

Primitive inlet_total_pressure(const GasConstants& gas, double total_pressure, double total_temperature,
                               const Primitive& inside) {
  const double g = double(gas.gamma), b = 2.0 / (g - 1.0), reference = double(gas.reference_pressure);
  const double total_sound = g * double(gas.gas_constant) * total_temperature;  // squared
  const double invariant =
      double(inside.un) - b * std::sqrt(double(gas.sound_speed_squared(inside.rho, inside.p)));
  // c^2 + (u^2)(g-1)/2 = c0^2 with u = invariant + b c
  const double discriminant = invariant * invariant - (1.0 + b) * (invariant * invariant / b - total_sound);
  double c = discriminant > 0.0 ? (std::sqrt(discriminant) - invariant) / (1.0 + b) : 0.0;
  double u = invariant + b * c;
  if (u > c) u = c = std::sqrt(total_sound * 2.0 / (g + 1.0));
  Primitive w = inside;
  if (total_pressure <= double(inside.p) + reference || u <= 0.0) {
    w.un = 0;
    return w;
  }
  const double ratio = c * c / total_sound;
  const double p = total_pressure * std::pow(ratio, g / (g - 1.0));
  w.rho = Real(p / (double(gas.gas_constant) * total_temperature * ratio));
  w.un = Real(u);
  w.p = Real(p - reference);
  return w;
}

GhostStates ghost_states(const Condition& condition, const GasConstants& gas, const Primitive& first,
                         const Primitive& second, const Primitive& outside, Real remembered) {
  switch (condition.type) {
    case BoundaryType::wall:
    case BoundaryType::moving_wall:
      return {stuck(first, outside), stuck(second, outside)};
    case BoundaryType::velocity:
    case BoundaryType::jet: {
      const Primitive g = inlet_velocity(gas, first, outside);
      return {g, g};
    }
    case BoundaryType::total_pressure: {
      Primitive g = inlet_total_pressure(gas, condition.total_pressure, condition.total_temperature, first);
      if (g.un == 0) return {mirrored(first), mirrored(second)};  // shut
      g.ut = g.us = 0;
      g.k = outside.k;
      g.e = outside.e;
      return {g, g};
    }
    case BoundaryType::pressure_outlet:
    case BoundaryType::free_stream: {
      const Primitive g = open_to(gas, first, outside, outside.p);
      return {g, g};
    }
    case BoundaryType::wave_transmissive: {
      const Primitive g = open_to(gas, first, outside, remembered);
      return {g, g};
    }
    case BoundaryType::slip:
    case BoundaryType::symmetry:
    case BoundaryType::periodic:
      break;
  }
  return {mirrored(first), mirrored(second)};
}

}  // namespace ejecta::godunov
