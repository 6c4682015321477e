#pragma once

namespace ejecta {

/// The damping alpha for which a contact of force secant * d - alpha sqrt(m secant) v gives back the
/// coefficient of restitution e in (0, 1]. Hertz (secant = k sqrt(d)):
///   tension allowed: alpha = -sqrt(5) ln e / sqrt(ln^2 e + pi^2)  (Antypov & Elliott 2011, EPL 94:50004);
///   clamped at F >= 0, the equation of motion x'' = -x^1.5 - alpha x^0.25 x' is integrated to the instant of
///   F = 0 and alpha found by bisection, because the formula would give 0.397 for e = 0.3.
double damping_hertz(double restitution, bool allow_tension);
/// The same for a linear spring (secant = k): alpha = -2 ln e / sqrt(ln^2 e + pi^2) with tension.
double damping_linear(double restitution, bool allow_tension);

}  // namespace ejecta
