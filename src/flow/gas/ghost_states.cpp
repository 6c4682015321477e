#include <algorithm>
#include <cmath>

#include "flow/gas/boundary.hpp"

namespace ejecta::gas {
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

constexpr int kMostIterations = 40;
constexpr double kMachTolerance = 1e-7;

/// Isentropic flow out of a reservoir.
struct NozzleSide {
  double gamma, gas_constant, total_pressure, total_temperature;
  double temperature(double mach) const {
    return total_temperature / (1.0 + 0.5 * (gamma - 1.0) * mach * mach);
  }
  double pressure(double mach) const {
    return total_pressure * std::pow(temperature(mach) / total_temperature, gamma / (gamma - 1.0));
  }
  double velocity(double mach) const { return mach * std::sqrt(gamma * gas_constant * temperature(mach)); }
};

/// Gas inside met by a wave of its acoustic family: the velocity it takes on behind the wave when its
/// pressure becomes p; a shock when p is higher, else a rarefaction (Toro, Riemann Solvers, section 4.2).
struct WaveInside {
  double gamma, density, pressure, start;
  double velocity(double p) const {
    const double p0 = pressure;
    if (p > p0) {
      const double a = 2.0 / ((gamma + 1.0) * density), b = (gamma - 1.0) / (gamma + 1.0) * p0;
      return start + (p - p0) * std::sqrt(a / (p + b));
    }
    const double c = std::sqrt(gamma * p0 / density);
    return start + 2.0 * c / (gamma - 1.0) * (std::pow(p / p0, 0.5 * (gamma - 1.0) / gamma) - 1.0);
  }
};

}  // namespace

Primitive inlet_total_pressure(const GasConstants& gas, double total_pressure, double total_temperature,
                               const Primitive& inside) {
  const NozzleSide nozzle{double(gas.gamma), double(gas.gas_constant), total_pressure, total_temperature};
  const WaveInside wave{double(gas.gamma), double(inside.rho),
                        double(inside.p) + double(gas.reference_pressure), double(inside.un)};
  // The gas inside has to yield less speed than the nozzle at the same pressure: increasing in the Mach
  // number.
  const auto surplus = [&](double mach) {
    return nozzle.velocity(mach) - wave.velocity(nozzle.pressure(mach));
  };
  Primitive w = inside;
  if (surplus(0.0) >= 0.0) {
    w.un = 0;
    return w;
  }
  double low = 0.0, high = 1.0, at_low = surplus(low), at_high = surplus(high);
  if (at_high <= 0.0) low = 1.0;
  for (int n = 0; n < kMostIterations && low < 1.0 && high - low > kMachTolerance; ++n) {
    // Illinois variant of regula falsi
    const double mach = (low * at_high - high * at_low) / (at_high - at_low), value = surplus(mach);
    if (value > 0.0) {
      high = mach;
      at_high = value;
      at_low *= 0.5;
    } else {
      low = mach;
      at_low = value;
      at_high *= 0.5;
    }
    if (std::abs(value) < kMachTolerance * nozzle.velocity(1.0)) low = high = mach;
  }
  const double p = nozzle.pressure(low);
  w.rho = Real(p / (nozzle.gas_constant * nozzle.temperature(low)));
  w.un = Real(nozzle.velocity(low));
  w.p = Real(p - double(gas.reference_pressure));
  return w;
}

GhostStates ghost_states(const Condition& condition, const GasConstants& gas, const Primitive& first,
                         const Primitive& second, const Primitive& outside, Real anchor) {
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
      const Primitive g = open_to(gas, first, outside, first.p + anchor * (outside.p - first.p));
      return {g, g};
    }
    case BoundaryType::slip:
    case BoundaryType::symmetry:
    case BoundaryType::periodic:
      break;
  }
  return {mirrored(first), mirrored(second)};
}

}  // namespace ejecta::gas
