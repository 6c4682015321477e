#!/usr/bin/env python3
"""What the k-epsilon model itself says of a free round jet, without any of Ejecta's code.

Far from its orifice the jet is self-similar: with eta = r / x and velocity 1 on the axis at x = 1,

    u = U(eta) / x,   k = K(eta) / x^2,   epsilon = E(eta) / x^4,   Phi = int U eta d eta,   r v = x (eta^2 U - Phi)

and the boundary-layer equations become (nu = C_mu K^2 / E, P = nu U'^2)

    U' = -U Phi / (eta nu)
    0 = 2 U K + Phi / eta K' + (eta nu K')' / eta + P - E
    0 = 4 U E + Phi / eta E' + (eta nu / sigma E')' / eta + (C1 P - C2 E + C3 chi E) E / K,   chi = (K/E)^3 U'^2 v / (4 eta)

solved by central differences and implicit steps in a pseudo-time until nothing changes. Prints the spreading
S = d r_half / dx, the decay B (U_c = B U_0 D / x) and B S.

    self_similar_jet.py          standard k-epsilon: S 0.120
    self_similar_jet.py 0.79     with Pope's (1978) round-jet term, C3 = 0.79, of stretched vortices alone as in Ejecta: S 0.085
    self_similar_jet.py 0.79 both  with that of compressed ones, at the edge, too: S 0.086
"""
import sys
import numpy as np

C_MU, C1, C2, SIGMA_E = 0.09, 1.44, 1.92, 1.3
CELLS, EDGE = 120, 0.3
STEP, STEPS = 0.02, 5000
NU_LEAST = 1e-5  # keeps the edge of the jet, where nu ends, smooth on the grid


def implicit_step(q, power, nu, phi_over_eta, source, sink, edge, face, eta, h):
    """q after a step of dq/dt = power q + phi/eta q' + (eta nu q')'/eta + source - sink q."""
    conductance = face * np.concatenate([[0.0], 0.5 * (nu[1:] + nu[:-1]), [2 * nu[-1]]]) / h
    below, above = conductance[:-1] / (eta * h), conductance[1:] / (eta * h)
    matrix = np.diag(1 / STEP + below + above + sink)
    below, above = below - phi_over_eta / (2 * h), above + phi_over_eta / (2 * h)
    matrix += np.diag(-below[1:], -1) + np.diag(-above[:-1], 1)
    matrix[0, 0] -= below[0]  # symmetric about the axis
    right = q / STEP + power * q + source
    right[-1] += above[-1] * edge
    return np.linalg.solve(matrix, right)


def spreading_and_decay(c3, compressed):
    face = np.linspace(0.0, EDGE, CELLS + 1)
    eta, h = 0.5 * (face[1:] + face[:-1]), face[1]
    grid = (face, eta, h)
    u, k, e = (1 + 60 * eta**2) ** -2, 0.08 * np.exp(-80 * eta**2) + 1e-6, 0.12 * np.exp(-80 * eta**2) + 1e-7
    for n in range(STEPS):
        nu = C_MU * k * k / e + NU_LEAST
        through = np.concatenate([[0.0], np.cumsum(u * eta * h)])
        phi = 0.5 * (through[1:] + through[:-1])
        rate = phi / (eta * nu)  # -U' / U
        fall = np.concatenate([[0.25 * h * rate[0]], 0.5 * h * (rate[1:] + rate[:-1])])
        u = 0.95 * u + 0.05 * np.exp(-np.minimum(np.cumsum(fall), 60.0))
        shear, v = u * rate, eta * u - phi / eta
        produced = nu * shear**2
        # Durbin's limit of the time scale bounds the start; in the settled jet it is far away.
        tau = np.minimum(k / e, 1 / (np.sqrt(3) * C_MU * shear + 1e-12))
        pope = c3 * min(1.0, n / 1500) * 0.25 * tau**3 * shear**2 * v / eta * e * e / k
        pope = pope if compressed else np.maximum(pope, 0)
        k, e = (
            np.maximum(implicit_step(k, 2 * u, nu, phi / eta, produced, e / k, 1e-7, *grid), 1e-9),
            np.maximum(implicit_step(e, 4 * u, nu / SIGMA_E, phi / eta, C1 * produced * e / k + np.maximum(pope, 0),
                                     C2 * e / k + np.maximum(-pope, 0) / e, 1e-8, *grid), 1e-10),
        )
    i = int(np.argmax(u < 0.5))
    return eta[i - 1] + (u[i - 1] - 0.5) / (u[i - 1] - u[i]) * h, 1 / np.sqrt(8 * np.sum(u * u * eta * h))


if __name__ == "__main__":
    S, B = spreading_and_decay(float(sys.argv[1]) if len(sys.argv) > 1 else 0.0, "both" in sys.argv)
    print(f"S {S:.4f}   B {B:.3f}   B S {S * B:.4f}")
