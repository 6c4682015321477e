#include "coupling/unresolved/grain_drag.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/unresolved/own_wake.hpp"

namespace ejecta::drag {
namespace {

/// (1 - exp(-x)) / x
EJECTA_KERNEL double relaxed(double x) {
  const double series =
      1 - x / 2 * (1 - x / 3 * (1 - x / 4 * (1 - x / 5 * (1 - x / 6 * (1 - x / 7 * (1 - x / 8))))));
  const double closed = (1 - std::exp(-x)) / x;
  return x < 0.1 ? series : closed;
}

/// 1/(1 - exp(-x)) - 1/x: what of dt times a steady acceleration counts in the velocity that the drag over
/// dt acts on, x relaxation times long: half without drag, all with much.
EJECTA_KERNEL double lag(double x) {
  const double square = x * x;
  const double series =
      0.5 + x * (1.0 / 12 - square * (1.0 / 720 - square * (1.0 / 30240 - square * (1.0 / 1209600))));
  const double closed = 1 / (1 - std::exp(-x)) - 1 / x;
  return x < 0.5 ? series : closed;
}

/// beta, kg/s, of the slip as it is seen, and the true slip, m/s, which is larger by what the grain itself
/// moves.
struct Response {
  double beta, slip;
};

/// own: part of the room that the grain fills as it sees it. Among many a drag law means the mean flow, which
/// all of them make, this one too.
template <double (*law)(const Surroundings&)>
EJECTA_KERNEL Response response(Surroundings s, double seen, double own, double volume, double spread,
                                double wakes) {
  const double others = std::max(1 - s.fraction - own, 0.0), part = wakes * own / (own + others);
  s.slip = seen;
  double beta = law(s), larger = 1;
  for (int again = 0; again < 2; ++again) {
    const double wake =
        part * own_wake(spread, s.slip, s.density, s.viscosity, others * beta / (s.density * volume));
    larger = 1 / (1 - std::min(beta * wake, kMostWake));
    s.slip = seen * larger;
    beta = law(s);
  }
  return {beta * larger, s.slip};
}

}  // namespace

void Batch::fill_up(std::size_t count) {
  for (Numbers* all :
       {&diameter, &volume, &mass, &is_free, &fraction, &fluid_density, &viscosity, &density, &spread,
        &slip[0], &slip[1], &slip[2], &acceleration[0], &acceleration[1], &acceleration[2]})
    std::fill(*all + count, *all + kSize, (*all)[count - 1]);
}

template <double (*law)(const Surroundings&)>
void find_drag(const Step& step, Batch& b) {
  constexpr double kShort = 0.01;  // relaxation times
  for_each_in_lanes(
      0, Batch::kSize, [&](int n) __attribute__((always_inline)) {
        const Surroundings s{b.diameter[n], 0, b.fraction[n], b.fluid_density[n], b.viscosity[n]};
        const double own = b.volume[n] * b.density[n];
        const auto respond = [&](double seen) __attribute__((always_inline)) {
          return response<law>(s, seen, own, b.volume[n], b.spread[n], step.wakes);
        };
        const auto size = [](double x, double y, double z) __attribute__((always_inline)) {
          return std::sqrt(x * x + y * y + z * z);
        };
        const double slip[3] = {b.slip[0][n], b.slip[1][n], b.slip[2][n]},
                     a[3] = {b.acceleration[0][n], b.acceleration[1][n], b.acceleration[2][n]};
        const Response first = respond(size(slip[0], slip[1], slip[2]));
        // Once more with the mean slip of the step, where that differs.
        const double rest = -b.mass[n] / first.beta, part = relaxed(step.dt * first.beta / b.mass[n]);
        const auto mean = [&](int c) __attribute__((always_inline)) {
          return rest * a[c] + part * (slip[c] - rest * a[c]);
        };
        const double again = respond(size(mean(0), mean(1), mean(2))).beta;
        const double beta = step.dt * first.beta > kShort * b.mass[n] ? again : first.beta;
        const double x = step.dt * beta / b.mass[n], moves = b.is_free[n];
        b.coefficient[n] = moves > 0 ? beta * relaxed(x) : first.beta;
        const double met = moves * lag(x) * step.dt;
        for (int c = 0; c < 3; ++c) b.gain[c][n] = met * a[c];
        b.reynolds[n] = s.fraction * s.diameter * first.slip / s.viscosity;
      });
}

const std::array<Law, 7> kLaws{{{},
                                {stokes, find_drag<stokes>, 1.0, 0.99},
                                {schiller_naumann, find_drag<schiller_naumann>, 2e5, 0.99},
                                {di_felice, find_drag<di_felice>, 2e5, 0.35},
                                {rong, find_drag<rong>, 1000.0, 0.37},
                                {koch_hill, find_drag<koch_hill>, 1000.0, 0.35},
                                {gidaspow, find_drag<gidaspow>, 2e5, 0.35}}};

}  // namespace ejecta::drag
