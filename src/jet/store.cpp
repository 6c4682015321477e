#include "jet/store.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "base/file_lock.hpp"
#include "base/sha256.hpp"
#include "case/load.hpp"
#include "case/write.hpp"
#include "jet/cache.hpp"
#include "jet/model.hpp"

namespace ejecta {
namespace {

/// Raised whenever the numbers of a jet change for the same case, as when a default changes.
constexpr int kNumericsVersion = 5;
constexpr double kProfileInterval = 50e-6;  ///< s: a twentieth of the paper's transducer's response

Case without_outputs(Case c) {
  c.run.title.clear();
  c.path.clear();
  c.valve.trace.clear();
  c.output = {};
  c.checkpoint = {};
  c.probes.clear();
  c.lines.clear();
  c.slices.clear();
  c.measured.clear();
  c.jet.compare_incompressible = false;
  c.jet.far_field_from = 0.0;
  c.jet.sweep_pressures.clear();
  c.jet.sweep_velocities.clear();
  c.expects.clear();
  return c;
}

/// What the file of the valve's trace says; empty without one.
std::string trace_of(const Case& c) {
  if (c.valve.trace.empty()) return "";
  std::ostringstream text;
  text << std::ifstream(beside_case(c, c.valve.trace)).rdbuf();
  return text.str();
}

std::vector<double> radii_of(const JetModel& jet) {
  std::vector<double> radii = jet.grid().axis(0).centre;
  for (double& r : radii) r -= jet.grid().lower().x();
  return radii;
}

}  // namespace

std::string jet_file_name(const Case& jet, double height) {
  const std::string inputs =
      fmt::format("{}\ntrace {}\nheight {:.9g}\nprecision {}\nnumerics {}\n",
                  write_changes(without_outputs(jet)), trace_of(jet), height, kPrecision, kNumericsVersion);
  return fmt::format("jet-{}.profile", sha256_hex(inputs).substr(0, 24));
}

std::filesystem::path jet_file(const Case& jet, double height) {
  return cache_directory() / jet_file_name(jet, height);
}

std::filesystem::path shipped_jet_file(const Case& jet, double height) {
  return beside_case(jet, "jets/" + jet_file_name(jet, height));
}

JetProfile::Moment profile_moment(const JetModel& jet, double height, const std::vector<double>& radii) {
  JetProfile::Moment m{.time = jet.time(), .axial = {}, .radial = {}, .k = {}, .epsilon = {}};
  const Vec3 lower = jet.grid().lower();
  const Case& c = jet.scenario();
  const double still = c.environment.pressure / (c.fluid.gas_constant * c.environment.temperature);
  for (const double r : radii) {
    const JetSample s = jet.sample({lower.x() + r, lower.y(), lower.z() + height});
    const double same_momentum = std::sqrt(s.density / still);
    m.axial.push_back(same_momentum * s.velocity.z());
    m.radial.push_back(same_momentum * s.velocity.x());
    m.k.push_back(s.k);
    m.epsilon.push_back(s.epsilon);
  }
  return m;
}

ProfileRecorder::ProfileRecorder(const JetModel& jet, double height) : profile_(height, radii_of(jet)) {
  profile_.add(profile_moment(jet, height, profile_.radii()));
  next_ = kProfileInterval;
}

void ProfileRecorder::advance(const JetModel& jet) {
  const bool last = jet.time() >= jet.scenario().run.end_time;
  if (jet.time() < next_ && !last) return;
  next_ = jet.time() + kProfileInterval;
  profile_.add(profile_moment(jet, profile_.height(), profile_.radii()));
}

void ProfileRecorder::save(std::vector<double>& out) const {
  const auto& moments = profile_.moments();
  out.insert(out.end(), {next_, double(moments.size())});
  for (const JetProfile::Moment& m : moments) {
    out.push_back(m.time);
    for (const auto* values : {&m.axial, &m.radial, &m.k, &m.epsilon})
      out.insert(out.end(), values->begin(), values->end());
  }
}

void ProfileRecorder::load(StateReader& in) {
  next_ = in.number();
  const std::size_t points = profile_.radii().size();
  JetProfile profile(profile_.height(), profile_.radii());
  for (std::size_t left = in.count(1 + 4 * points); left > 0; --left) {
    JetProfile::Moment m{.time = in.number(), .axial = {}, .radial = {}, .k = {}, .epsilon = {}};
    for (auto* values : {&m.axial, &m.radial, &m.k, &m.epsilon}) {
      const auto numbers = in.numbers(points);
      values->assign(numbers.begin(), numbers.end());
    }
    profile.add(m);
  }
  profile_ = std::move(profile);
}

namespace {

/// Nothing where there is no such file or it is damaged.
std::optional<JetProfile> read_jet(const std::filesystem::path& file, const Note& note) {
  if (!std::filesystem::exists(file)) return {};
  try {
    return JetProfile::read(file);
  } catch (const Error& e) {
    if (note) note(fmt::format("{}; it is not used", e.what()));
    return {};
  }
}

}  // namespace

JetProfile stored_or_computed_jet(const Case& c, double height, const Note& note) {
  if (auto profile = read_jet(shipped_jet_file(c, height), note)) return *profile;
  const std::filesystem::path file = jet_file(c, height);
  if (auto profile = read_jet(file, note)) return *profile;
  // Of many runs that start together one computes the jet; the others wait for it.
  std::filesystem::create_directories(file.parent_path());
  const FileLock lock(file.parent_path() / ("lock-" + file.filename().string()));
  if (auto profile = read_jet(file, {})) return *profile;
  if (note) note(fmt::format("computing the jet of {} once; it is kept in {}", c.path, file.string()));
  JetModel jet(c);
  ProfileRecorder recorder(jet, height);
  for (Clock clock = jet.clock(); jet.time() < c.run.end_time;) {
    jet.step(clock);
    recorder.advance(jet);
  }
  recorder.profile().write(file);
  return recorder.profile();
}

}  // namespace ejecta
