#include "simulation/jet_files.hpp"

#include <algorithm>
#include <array>

namespace ejecta {

void write_centreline(Histories& histories, double time, const std::string& name, const Centreline& line) {
  output::History& history = histories.open_anew("line-" + name, {{"position", "m"},
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
    history.add(time, row);
  }
}

LineProfile line_profile(const JetModel& jet, const LineSpec& spec) {
  LineProfile p;
  for (int n = 0; n < spec.points; ++n) {
    const Vec3 way = (spec.to - spec.from) * (double(n) / std::max(1, spec.points - 1));
    p.distance.push_back(way.norm());
    p.samples.push_back(jet.sample(spec.from + way));
  }
  return p;
}

void write_line(Histories& histories, double time, const LineSpec& spec, const LineProfile& profile) {
  output::History& history = histories.open_anew("line-" + spec.name, {{"position", "m"},
                                                                       {"velocity_x", "m/s"},
                                                                       {"velocity_z", "m/s"},
                                                                       {"mach", "1"},
                                                                       {"density", "kg/m3"},
                                                                       {"total_gauge", "Pa"},
                                                                       {"pitot_gauge", "Pa"}});
  for (std::size_t n = 0; n < profile.samples.size(); ++n) {
    const JetSample& s = profile.samples[n];
    const std::array<double, 7> row{profile.distance[n], s.velocity.x(), s.velocity.z(), s.mach,
                                    s.density,           s.total_gauge,  s.pitot_gauge};
    history.add(time, row);
  }
}

}  // namespace ejecta
