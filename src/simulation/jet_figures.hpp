#pragma once
#include "jet/analysis.hpp"
#include "jet/measured.hpp"
#include "output/figures.hpp"

namespace ejecta {

/// Where the far field of a jet begins: there its decay is fitted and drawn by itself, m above the orifice.
double far_field_from(const Case& c);

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

/// Its name and place.
std::string probe_title(const ProbeSpec& probe);

}  // namespace ejecta
