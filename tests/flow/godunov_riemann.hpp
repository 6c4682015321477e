#pragma once
#include <algorithm>
#include <cmath>

/// Exact solution of the Riemann problem of an ideal gas (Toro, Riemann Solvers, chapter 4), for tests.
namespace ejecta::test {

struct RiemannState {
  double rho, u, p;
};

class ExactRiemann {
 public:
  ExactRiemann(RiemannState l, RiemannState r, double gamma = 1.4) : l_(l), r_(r), g_(gamma) {
    double low = 1e-14 * std::min(l.p, r.p), high = 1e6 * std::max(l.p, r.p);
    for (int n = 0; n < 200; ++n) {
      const double mid = std::sqrt(low * high);
      (wave(mid, l) + wave(mid, r) + r.u - l.u > 0 ? high : low) = mid;
    }
    p_ = std::sqrt(low * high);
    u_ = 0.5 * (l.u + r.u) + 0.5 * (wave(p_, r) - wave(p_, l));
  }
  double pressure() const { return p_; }
  double velocity() const { return u_; }
  double density_left() const { return density(l_); }
  double density_right() const { return density(r_); }

  /// State on the ray x/t = s.
  RiemannState at(double s) const {
    if (s < u_) return side(l_, s);
    RiemannState mirror = side({r_.rho, -r_.u, r_.p}, -s);
    mirror.u = -mirror.u;
    return mirror;
  }

 private:
  double sound(const RiemannState& k) const { return std::sqrt(g_ * k.p / k.rho); }
  double wave(double p, const RiemannState& k) const {
    if (p > k.p) return (p - k.p) * std::sqrt(2 / ((g_ + 1) * k.rho) / (p + (g_ - 1) / (g_ + 1) * k.p));
    return 2 * sound(k) / (g_ - 1) * (std::pow(p / k.p, (g_ - 1) / (2 * g_)) - 1);
  }
  double density(const RiemannState& k) const {
    const double q = (g_ - 1) / (g_ + 1), ratio = p_ / k.p;
    return p_ > k.p ? k.rho * (ratio + q) / (q * ratio + 1) : k.rho * std::pow(ratio, 1 / g_);
  }
  RiemannState side(const RiemannState& k, double s) const {
    const double star = k.u == l_.u && k.p == l_.p ? u_ : -u_;
    const double c = sound(k);
    if (p_ > k.p) {
      const double shock = k.u - c * std::sqrt((g_ + 1) / (2 * g_) * p_ / k.p + (g_ - 1) / (2 * g_));
      return s < shock ? k : RiemannState{density(k), star, p_};
    }
    const double tail = star - c * std::pow(p_ / k.p, (g_ - 1) / (2 * g_));
    if (s < k.u - c) return k;
    if (s > tail) return {density(k), star, p_};
    const double q = 2 / (g_ + 1) + (g_ - 1) / ((g_ + 1) * c) * (k.u - s);
    return {k.rho * std::pow(q, 2 / (g_ - 1)), 2 / (g_ + 1) * (c + (g_ - 1) / 2 * k.u + s),
            k.p * std::pow(q, 2 * g_ / (g_ - 1))};
  }
  RiemannState l_, r_;
  double g_, p_ = 0, u_ = 0;
};

}  // namespace ejecta::test
