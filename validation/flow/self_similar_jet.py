#!/usr/bin/env python3
"""What the k-epsilon model itself says of a free round jet, without any of Ejecta's code.

Marches the boundary-layer equations of the jet in x on a grid in eta = r / x until the profiles no longer change
and prints the spreading S = d r_half / dx, the decay B (U_c = B U_0 D / x) and B S.

    self_similar_jet.py          standard k-epsilon
    self_similar_jet.py 0.79     with Pope's (1978) round-jet term, C_epsilon3 = 0.79
"""
import sys
import numpy as np

C_MU, C1, C2, SIGMA_E = 0.09, 1.44, 1.92, 1.3
CELLS, EDGE, STEP, STEPS = 240, 0.35, 0.003, 2400


def tridiagonal(a, b, c, d):
    n = len(b)
    upper, right = np.empty(n), np.empty(n)
    upper[0], right[0] = c[0] / b[0], d[0] / b[0]
    for i in range(1, n):
        pivot = b[i] - a[i] * upper[i - 1]
        upper[i], right[i] = c[i] / pivot, (d[i] - a[i] * right[i - 1]) / pivot
    for i in range(n - 2, -1, -1):
        right[i] -= upper[i] * right[i + 1]
    return right


def march(c3):
    face = np.linspace(0.0, EDGE, CELLS + 1)
    eta, width = 0.5 * (face[1:] + face[:-1]), face[1]
    x = 1.0
    u = 1.0 / (1.0 + 46.9 * eta**2) ** 2 + 1e-4
    k, e = 0.07 * np.exp(-60 * eta**2) + 1e-6, 0.14 * np.exp(-80 * eta**2) + 1e-7
    u_before, records = None, []
    for n in range(STEPS):
        dx, nu = STEP * x, C_MU * k * k / e
        slope = np.gradient(u, eta)
        along = ((u - u_before) / dx if n else -u / x) - eta / x * slope
        rv = np.concatenate([[0.0], -np.cumsum(along * eta * x * width * x)])  # r v from continuity
        v = 0.5 * (rv[1:] + rv[:-1]) / (eta * x)
        across, shear = v - eta * u, slope / x
        produced = nu * shear**2
        tau = np.minimum(k / e, 1.0 / (np.sqrt(3.0) * C_MU * np.abs(shear) + 1e-12))
        pope = c3 * min(1.0, n / 800) * 0.25 * tau**3 * shear**2 * v / (eta * x) * e * e / k

        def step(q, sigma, source, sink, edge):
            inner = 0.5 * (nu[1:] + nu[:-1]) / sigma * face[1:-1] / width
            low = np.concatenate([[0.0], inner]) / (eta * width) / x**2
            up = np.concatenate([inner, [2 * nu[-1] / sigma * face[-1] / width]]) / (eta * width) / x**2
            plus, minus = np.maximum(across, 0) / (width * x), np.minimum(across, 0) / (width * x)
            jump = np.diff(q)
            upwind = plus * np.concatenate([[0.0], jump]) + minus * np.concatenate([jump, [edge - q[-1]]])
            a, b, c = -low - plus, u / dx + low + up + plus - minus + sink, minus - up
            b[0] -= plus[0]
            d = u / dx * q + source + upwind - across * np.gradient(q, eta) / x  # central by deferred correction
            d[-1] -= c[-1] * edge
            return tridiagonal(a, b, c, d)

        centre = u[0]
        new = (
            step(u, 1.0, 0 * u, 0 * u, 1e-4 * centre),
            np.maximum(step(k, 1.0, produced, e / k, 1e-6 * centre**2), 1e-9 * centre**2),
            np.maximum(
                step(e, SIGMA_E, C1 * produced * e / k + np.maximum(pope, 0), C2 * e / k + np.maximum(-pope, 0) / e,
                     1e-7 * centre**3 / x), 1e-10 * centre**3 / x),
        )
        u_before, (u, k, e), x = u, new, x + dx
        if n % 100 == 99:
            axis = (9 * u[0] - u[1]) / 8
            i = int(np.argmax(u < 0.5 * axis))
            half = x * (eta[i - 1] + (u[i - 1] - 0.5 * axis) / (u[i - 1] - u[i]) * width)
            records.append((x, half, axis, 2 * np.pi * np.sum(u * u * eta * width) * x * x))
    (x0, half0, axis0, _), (x1, half1, axis1, flux) = records[-3], records[-1]
    spreading = (half1 - half0) / (x1 - x0)
    decay = (x1 - x0) / (1 / axis1 - 1 / axis0) / np.sqrt(4 * flux / np.pi)
    return spreading, decay


if __name__ == "__main__":
    S, B = march(float(sys.argv[1]) if len(sys.argv) > 1 else 0.0)
    print(f"S {S:.4f}   B {B:.3f}   B S {S * B:.4f}")
