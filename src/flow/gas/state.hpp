#pragma once
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "grid/field.hpp"

/// What the compressible solver keeps in a cell. Pressure is held as the difference to a reference pressure,
/// and the energy as that to gas at rest at this pressure: air at rest is exactly zero, so that in float
/// small disturbances keep their digits.
namespace ejecta::gas {

/// Order of the components in a Block. Conserved / primitive: density; three momenta / velocities; energy
/// p'/(gamma-1) + rho u^2/2 / pressure p'; rho k / k; rho e / e with e the second turbulent quantity (epsilon
/// or omega).
enum Component : int { kRho, kU, kV, kW, kP, kK, kE, kComponents };

/// Cell-centred (or face) values of all components.
using Block = std::array<Field, kComponents>;

/// Non-owning view of a Block: equal strides, one offset for all components.
template <class T>
struct BlockView {
  std::array<T*, kComponents> origin{};
  std::ptrdiff_t sy = 0, sz = 0;
  EJECTA_KERNEL std::ptrdiff_t offset(int i, int j, int k) const { return i + j * sy + k * sz; }
  EJECTA_KERNEL T& at(int c, std::ptrdiff_t n) const { return origin[static_cast<std::size_t>(c)][n]; }
};

template <class T, class B>
BlockView<T> view_block(B& block) {
  BlockView<T> v;
  for (std::size_t c = 0; c < kComponents; ++c) v.origin[c] = block[c].view().origin;
  v.sy = block[0].view().sy;
  v.sz = block[0].view().sz;
  return v;
}

/// Gives a cell k and e, in its primitive and its conserved values.
inline void set_turbulence(Block& primitive, Block& conserved, int i, int j, int k_index, Real k, Real e) {
  const Real rho = primitive[kRho](i, j, k_index);
  primitive[kK](i, j, k_index) = k;
  primitive[kE](i, j, k_index) = e;
  conserved[kK](i, j, k_index) = rho * k;
  conserved[kE](i, j, k_index) = rho * e;
}

/// Primitive state of a cell or of one side of a face; `p` is the difference to the reference pressure.
/// `un` is the velocity along the direction of the sweep, `ut`, `us` across it.
struct Primitive {
  Real rho, un, ut, us, p;
  Real k = 0, e = 0;
};

/// Flux through a face per area: of mass, of the three momenta, of energy. The turbulent quantities ride on
/// the mass flux.
struct Flux {
  Real mass, un, ut, us, energy;
};

/// Constants of the gas as kernels need them.
struct GasConstants {
  Real gamma = Real(1.4);
  Real reference_pressure = 0;  ///< Pa
  Real gas_constant = Real(287.05);
  Real inv_gamma_minus_1 = Real(2.5);
  /// Enthalpy of the reference state per volume, gamma/(gamma - 1) p_ref
  Real reference_enthalpy = 0;

  GasConstants() = default;
  GasConstants(double g, double r, double reference)
      : gamma(Real(g)),
        reference_pressure(Real(reference)),
        gas_constant(Real(r)),
        inv_gamma_minus_1(Real(1.0 / (g - 1.0))),
        reference_enthalpy(Real(g / (g - 1.0) * reference)) {}

  /// K of dp = -K div u dt, Pa; p is the difference to the reference.
  EJECTA_KERNEL Real stiffness(Real p) const { return gamma * reference_pressure + (gamma - 1) * p; }
  EJECTA_KERNEL Real sound_speed_squared(Real rho, Real p) const {
    return gamma * (p + reference_pressure) / rho;
  }
};

}  // namespace ejecta::gas
