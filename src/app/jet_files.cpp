#include "app/jet_files.hpp"

#include <algorithm>
#include <array>

#include "output/history.hpp"

namespace ejecta {

void write_centreline(const output::RunDirectory& directory, std::span<const std::string> provenance,
                      double time, const std::string& name, const Centreline& line) {
  output::HistoryFile file(directory.history(name), provenance,
                           {{"z", "m"},
                            {"velocity_z", "m/s"},
                            {"mach", "1"},
                            {"pressure", "Pa"},
                            {"temperature", "K"},
                            {"total_gauge", "Pa"},
                            {"pitot_gauge", "Pa"},
                            {"half_radius", "m"},
                            {"supersonic_radius", "m"},
                            {"k", "m2/s2"},
                            {"epsilon", "m2/s3"}});
  for (std::size_t n = 0; n < line.z.size(); ++n) {
    const JetSample& s = line.samples[n];
    const std::array<double, 11> row{line.z[n],
                                     s.velocity.z(),
                                     s.mach,
                                     s.pressure,
                                     s.temperature,
                                     s.total_gauge,
                                     s.pitot_gauge,
                                     line.half_radius[n],
                                     line.supersonic_radius[n],
                                     s.k,
                                     s.epsilon};
    file.add(time, row);
  }
}

namespace {

Vec3 point(const LineSpec& spec, int n) {
  return spec.from + (spec.to - spec.from) * (double(n) / std::max(1, spec.points - 1));
}

}  // namespace

LineProfile line_profile(const JetModel& jet, const LineSpec& spec) {
  LineProfile p;
  for (int n = 0; n < spec.points; ++n) {
    p.distance.push_back((point(spec, n) - spec.from).norm());
    p.samples.push_back(jet.sample(point(spec, n)));
  }
  return p;
}

void write_line(const output::RunDirectory& directory, std::span<const std::string> provenance, double time,
                const LineSpec& spec, const LineProfile& profile) {
  output::HistoryFile file(directory.history(spec.name), provenance,
                           {{"x", "m"},
                            {"y", "m"},
                            {"z", "m"},
                            {"velocity_x", "m/s"},
                            {"velocity_z", "m/s"},
                            {"mach", "1"},
                            {"density", "kg/m3"},
                            {"total_gauge", "Pa"},
                            {"pitot_gauge", "Pa"}});
  for (int n = 0; n < spec.points; ++n) {
    const Vec3 x = point(spec, n);
    const JetSample& s = profile.samples[static_cast<std::size_t>(n)];
    const std::array<double, 9> row{x.x(),  x.y(),     x.z(),         s.velocity.x(), s.velocity.z(),
                                    s.mach, s.density, s.total_gauge, s.pitot_gauge};
    file.add(time, row);
  }
}

}  // namespace ejecta
