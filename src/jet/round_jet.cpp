#include "jet/round_jet.hpp"

#include <algorithm>
#include <vector>

namespace ejecta {
namespace {

/// Slope and intercept of y over x by least squares.
std::pair<double, double> line_through(const std::vector<double>& x, const std::vector<double>& y) {
  double mx = 0, my = 0, xy = 0, xx = 0;
  for (std::size_t n = 0; n < x.size(); ++n) mx += x[n] / double(x.size()), my += y[n] / double(x.size());
  for (std::size_t n = 0; n < x.size(); ++n) xy += (x[n] - mx) * (y[n] - my), xx += (x[n] - mx) * (x[n] - mx);
  return {xy / xx, my - xy / xx * mx};
}

/// On the axis, from the two innermost cells of an even profile.
double on_axis(const Axis& r, ConstFieldView w, int k) {
  const double a = r.centre[0] * r.centre[0], b = r.centre[1] * r.centre[1];
  return (w(0, 0, k) * b - w(1, 0, k) * a) / (b - a);
}

}  // namespace

FarField fit_far_field(const std::vector<double>& z, const std::vector<double>& inverse_velocity,
                       const std::vector<double>& half_radius, double orifice_diameter) {
  const auto [slope, intercept] = line_through(z, inverse_velocity);
  return {1.0 / (slope * orifice_diameter), line_through(z, half_radius).first, -intercept / slope};
}

std::optional<RoundJet> analyse_round_jet(const Grid& grid, ConstFieldView w, ConstFieldView p,
                                          ConstFieldView nut, double viscosity, double diameter,
                                          double exit_velocity, double from, double to) {
  const Axis &r = grid.axis(0), &z = grid.axis(2);
  std::vector<double> at, inverse, half, flux;
  for (int k = 1; k + 1 < z.n; ++k) {
    const double height = z.centre[static_cast<std::size_t>(k)];
    if (height < from || height > to) continue;
    const double centre = on_axis(r, w, k);
    int i = 0;
    while (i + 1 < r.n && double(w(i + 1, 0, k)) > 0.5 * centre) ++i;
    if (i + 1 >= r.n || !(centre > 0.0)) return std::nullopt;
    const double high = w(i, 0, k), low = w(i + 1, 0, k), share = (high - 0.5 * centre) / (high - low);
    at.push_back(height);
    inverse.push_back(exit_velocity / centre);
    half.push_back(r.centre[static_cast<std::size_t>(i)] +
                   share *
                       (r.centre[static_cast<std::size_t>(i) + 1] - r.centre[static_cast<std::size_t>(i)]));
    double sum = 0.0;
    const double span = z.centre[static_cast<std::size_t>(k) + 1] - z.centre[static_cast<std::size_t>(k) - 1];
    for (int n = 0; n < r.n; ++n) {
      const double gradient = (double(w(n, 0, k + 1)) - double(w(n, 0, k - 1))) / span;
      const double nu = viscosity + (nut.origin ? double(nut(n, 0, k)) : 0.0), speed = w(n, 0, k);
      sum += grid.volume(n, 0, k) / z.width[static_cast<std::size_t>(k)] *
             (speed * speed + double(p(n, 0, k)) - 2.0 * nu * gradient);
    }
    flux.push_back(sum);
  }
  if (at.size() < 5) return std::nullopt;
  RoundJet jet;
  jet.far = fit_far_field(at, inverse, half, diameter);
  double mean = 0.0;
  for (double f : flux) mean += f / double(flux.size());
  jet.momentum_variation =
      (*std::max_element(flux.begin(), flux.end()) - *std::min_element(flux.begin(), flux.end())) / mean;
  return jet;
}

}  // namespace ejecta
