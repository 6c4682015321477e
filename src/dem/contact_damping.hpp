#pragma once

namespace ejecta {

/// The damping gamma for which a contact of force F - gamma F sqrt(m/(2 E)) v, E the energy of F, gives back
/// the coefficient of restitution e in (0, 1]. In the coordinate u = sqrt(2 E) every such contact is the
/// linear oscillator u'' = -u - gamma u':
///   tension allowed: gamma = -2 ln e / sqrt(ln^2 e + pi^2), to u = 0;
///   clamped at F >= 0, to the instant of zero force: e = exp(-z t/w), t = atan2(2 z w, 2 z^2 - 1), z =
///   gamma/2, w^2 = 1 - z^2 (Schwager & Poeschel 2007, Granular Matter 9:465), by bisection.
double contact_damping(double restitution, bool allow_tension);

}  // namespace ejecta
