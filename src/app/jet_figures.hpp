#pragma once
#include "jet/analysis.hpp"
#include "jet/measured.hpp"
#include "output/figures.hpp"

namespace ejecta {

/// From here on the far part of a centreline is drawn by itself, m: the paper's box begins there.
inline constexpr double kFarView = 40e-3;

/// Total gauge pressure over the height: kPa over mm.
output::Figure centreline_figure(const std::string& title);
output::FigureSeries centreline_series(const std::string& label, const Centreline& line);
/// The part of a figure with x >= from.
output::Figure beyond(const output::Figure& figure, double from, const std::string& title);

/// Measured points: positions in mm (or times in ms), pressures in kPa.
output::FigureSeries measured_series(const std::string& label, const MeasuredCurve& curve);

/// Density gradient near the orifice, axis across the picture, flow to the right: as a schlieren photograph
/// grey = exp(-10 |grad rho| / largest).
output::Picture schlieren_picture(const JetModel& jet);

/// "paper, Figure 9" for a probe on the axis, 13, 14, 15 for 4, 8, 10 mm beside it; else the name alone.
std::string probe_title(const ProbeSpec& probe);

}  // namespace ejecta
