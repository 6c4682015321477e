#include "simulation/jet_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ejecta {

double far_field_from(const Case& c) {
  constexpr double kOrifices = 25.0;
  return c.jet.far_field_from > 0.0 ? c.jet.far_field_from : kOrifices * c.valve.orifice_diameter;
}

output::Figure centreline_figure(const std::string& title) {
  return {title, "z [mm]", "total gauge pressure [kPa]"};
}

output::FigureSeries centreline_series(const std::string& label, const Centreline& line) {
  output::FigureSeries s{label, {}, {}};
  for (std::size_t n = 0; n < line.z.size(); ++n) {
    s.x.push_back(1e3 * line.z[n]);
    s.y.push_back(1e-3 * line.samples[n].total_gauge);
  }
  return s;
}

output::Figure beyond(const output::Figure& figure, double from, const std::string& title) {
  output::Figure f{title, figure.x_label, figure.y_label};
  for (const output::FigureSeries& s : figure.series) {
    output::FigureSeries part{.label = s.label, .x = {}, .y = {}, .dashed = s.dashed, .points = s.points};
    for (std::size_t n = 0; n < s.x.size(); ++n)
      if (s.x[n] >= from) part.x.push_back(s.x[n]), part.y.push_back(s.y[n]);
    if (!part.x.empty()) f.series.push_back(std::move(part));
  }
  return f;
}

output::FigureSeries measured_series(const std::string& label, const MeasuredCurve& curve) {
  output::FigureSeries s{.label = label, .x = curve.x, .y = curve.y, .points = true};
  for (double& x : s.x) x *= 1e3;
  for (double& y : s.y) y *= 1e-3;
  return s;
}

output::Picture schlieren_picture(const JetModel& jet) {
  constexpr double kLong = 12.0, kWide = 4.0;  // orifice diameters shown
  constexpr double kContrast = 10.0;
  constexpr int kAcross = 240;
  const Grid& grid = jet.grid();
  const double d = jet.orifice_diameter();
  const double length = std::min(kLong * d, grid.axis(2).length()),
               half = std::min(0.5 * kWide * d, grid.axis(0).length());
  output::Picture p{fmt::format("Density gradient, {:.1f} mm long", 1e3 * length)};
  p.height = kAcross;
  p.width = static_cast<int>(std::lround(kAcross * 0.5 * length / half));
  const double pixel = length / p.width;
  const Vec3 lower = grid.lower();
  const auto density = [&](double r, double z) {
    return jet.sample({lower.x() + std::abs(r), lower.y(), lower.z() + z}).density;
  };
  std::vector<double> gradient;
  for (int row = 0; row < p.height; ++row)
    for (int column = 0; column < p.width; ++column) {
      const double r = half - (row + 0.5) * pixel, z = (column + 0.5) * pixel;
      gradient.push_back(std::hypot(density(r + 0.5 * pixel, z) - density(r - 0.5 * pixel, z),
                                    density(r, z + 0.5 * pixel) - density(r, z - 0.5 * pixel)));
    }
  const double most = std::max(1e-300, *std::max_element(gradient.begin(), gradient.end()));
  for (const double g : gradient)
    p.pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::exp(-kContrast * g / most))));
  return p;
}

std::string probe_title(const ProbeSpec& probe) {
  const double beside = std::hypot(probe.position.x(), probe.position.y());
  return fmt::format("Pressure over time, {}: {:.4g} mm from the axis, {:.4g} mm above the orifice",
                     probe.name, 1e3 * beside, 1e3 * probe.position.z());
}

}  // namespace ejecta
