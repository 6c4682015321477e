#include "simulation/sorter_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/build_info.hpp"
#include "output/results_table.hpp"
#include "simulation/assumptions.hpp"
#include "sorter/launch.hpp"

namespace ejecta {
namespace {

using Json = nlohmann::ordered_json;

const std::array<const char*, Products::ratios> ratio_names{"recovery",      "purity",         "loss",
                                                            "recovery_mass", "purity_mass",    "loss_mass",
                                                            "yield_mass",    "standing_alone", "seen_alone"};

void put_share(Json& r, const std::string& name, const Share& s) {
  if (!s.known) {
    for (const char* end : {"", "_low", "_high"}) r[name + end] = nullptr;
    return;
  }
  r[name] = s.value;
  r[name + "_low"] = s.low;
  r[name + "_high"] = s.high;
}

double over(double a, double b) { return b > 0.0 ? a / b : 0.0; }

Json fates(const Case& c, const Tally& total) {
  Json table = Json::array();
  for (std::size_t f = 0; f < kFates; ++f) {
    Json row{{"fate", word(static_cast<Fate>(f))},
             {"product", goes_to_ejects(static_cast<Fate>(f)) ? "ejected" : "kept"}};
    double number = 0.0, mass = 0.0;
    Json classes = Json::object();
    for (std::size_t k = 0; k < c.classes.size(); ++k) {
      classes[c.classes[k].name] = {{"number", total.kinds[k].number[f]},
                                    {"mass_kg", total.kinds[k].mass[f]}};
      number += total.kinds[k].number[f];
      mass += total.kinds[k].mass[f];
    }
    row["number"] = number;
    row["mass_kg"] = mass;
    row["classes"] = classes;
    table.push_back(row);
  }
  return table;
}

Json class_rows(const Case& c, const Tally& total) {
  Json rows = Json::array();
  for (std::size_t k = 0; k < c.classes.size(); ++k) {
    double ejected = 0.0, ejected_mass = 0.0;
    for (std::size_t f = 0; f < kFates; ++f)
      if (goes_to_ejects(static_cast<Fate>(f))) {
        ejected += total.kinds[k].number[f];
        ejected_mass += total.kinds[k].mass[f];
      }
    rows.push_back({{"name", c.classes[k].name},
                    {"belongs_in", c.classes[k].eject ? "ejected" : "kept"},
                    {"particles", total.number(k)},
                    {"mass_kg", total.mass(k)},
                    {"ejected", ejected},
                    {"ejected_kg", ejected_mass}});
  }
  return rows;
}

}  // namespace

Json json_of(const SorterState& s) {
  Json sums = Json::array();
  for (const ShareSums& one : s.products.sums)
    sums.push_back({one.a, one.b, one.aa, one.ab, one.bb, one.pieces, one.count});
  return {{"cells", s.cells}, {"wall_time_s", s.wall_time}, {"total", s.products.total.values()},
          {"sums", sums},     {"vessel_Pa", s.vessel},      {"lowest_vessel_Pa", s.lowest_vessel}};
}

SorterState sorter_state(const Json& json, std::size_t kinds) {
  SorterState s{.cells = json.at("cells"), .wall_time = json.at("wall_time_s")};
  if (s.cells == 0) return s;
  s.products.total = Tally::of_values(json.at("total").get<std::vector<double>>(), kinds);
  for (std::size_t n = 0; n < s.products.sums.size(); ++n) {
    const auto v = json.at("sums").at(n).get<std::array<double, 7>>();
    s.products.sums[n] = {v[0], v[1], v[2], v[3], v[4], v[5], v[6]};
  }
  s.vessel = json.at("vessel_Pa").get<std::vector<double>>();
  s.lowest_vessel = json.at("lowest_vessel_Pa");
  return s;
}

Json sorter_result(const Case& c, const Sorter& sorter, const SorterState& state) {
  const Tally& total = state.products.total;
  double particles = 0.0, mass = 0.0, area = 0.0, slipping = 0.0, late_squares = 0.0, met = 0.0,
         in_another = 0.0, ejected_mass = 0.0, kept_mass = 0.0, ejected = 0.0;
  for (std::size_t k = 0; k < total.kinds.size(); ++k) {
    particles += total.number(k);
    mass += total.mass(k);
    area += total.kinds[k].area;
    slipping += total.kinds[k].slipping;
    late_squares += total.kinds[k].late_squares;
    met += total.kinds[k].met;
    in_another += total.kinds[k].in_another;
    for (std::size_t f = 0; f < kFates; ++f) {
      const bool out = goes_to_ejects(static_cast<Fate>(f));
      (out ? ejected_mass : kept_mass) += total.kinds[k].mass[f];
      if (out) ejected += total.kinds[k].number[f];
    }
  }
  const double time = total.length / c.launch.belt_speed, air = sorter.air_use().normal_m3(total.air);
  Json r{{"title", c.run.title},
         {"kind", "sort"},
         {"particles", particles},
         {"fed_kg", mass},
         {"belt_m", total.length},
         {"time_s", time},
         {"throughput_t_h", over(3.6 * mass, time)},
         {"throughput_asked_t_h", 3.6 * c.sorter.throughput},
         {"cover", over(area, total.length * c.sorter.belt_width)}};
  r["slipping_at_camera"] = over(slipping, particles);
  r["arrival_error_s"] = std::sqrt(over(late_squares, particles));
  r["met_in_air"] = over(met, particles);
  r["lay_in_each_other"] = in_another;
  for (std::size_t n = 0; n < ratio_names.size(); ++n)
    put_share(r, ratio_names[n], state.products.sums[n].share());
  r["products"] = {{"ejected", {{"particles", ejected}, {"mass_kg", ejected_mass}}},
                   {"kept", {{"particles", particles - ejected}, {"mass_kg", kept_mass}}}};
  r["classes"] = class_rows(c, total);
  r["fates"] = fates(c, total);
  r["objects"] = total.objects;
  r["objects_cut"] = total.cut;
  r["shots"] = total.shots;
  r["valve_openings"] = total.openings;
  r["dead_valves"] = sorter.manifold().dead_count();
  r["air_Nm3"] = air;
  r["air_Nm3_per_t"] = over(1e3 * air, mass);
  r["air_Nm3_per_t_ejected"] = over(1e3 * air, ejected_mass);
  r["air_least_work_kWh_per_t"] = over(sorter.air_use().least_work(total.air) / 3.6e6 * 1e3, mass);
  if (sorter.vessel().is_there()) r["vessel_lowest_Pa"] = state.lowest_vessel;
  r["tier"] = "fast";
  r["resolved_shots"] = 0;
  r["wall_time_s"] = state.wall_time;
  r["particles_per_s"] = over(particles, state.wall_time);
  r["version"] = output::version();
  r["assumptions"] = Json::array();
  for (const output::Assumption& a : assumptions(c))
    r["assumptions"].push_back({{"what", a.what}, {"value", a.value}, {"reason", a.reason}, {"key", a.key}});
  r["assumptions"].push_back({{"what", "Centre of every particle above the jets"},
                              {"value", fmt::format("{:.4g} mm", 1e3 * c.launch.stand_off)},
                              {"reason", "one path for all sizes, as in the paper's runs"},
                              {"key", "launch.stand_off"}});
  return r;
}

std::string fates_table(const Json& result) {
  output::ResultsTable table{.columns = {"fate", "product", "number", "mass [kg]"}, .rows = {}};
  for (const auto& k : result.at("classes"))
    for (const char* what : {" number", " mass [kg]"})
      table.columns.push_back(k.at("name").get<std::string>() + what);
  for (const auto& row : result.at("fates")) {
    std::vector<nlohmann::json> cells{row.at("fate"), row.at("product"), row.at("number"), row.at("mass_kg")};
    for (const auto& [name, k] : row.at("classes").items())
      for (const char* what : {"number", "mass_kg"}) cells.push_back(k.at(what));
    table.rows.push_back(std::move(cells));
  }
  return output::csv_text(table);
}

constexpr double kPathStep = 2e-3;  ///< s, of the paths in the report

Json sorter_view(const Case& c, const SortedStretch& stretch) {
  const auto rounded = [](double metres) { return std::round(metres * 1e5) / 1e5; };
  Json view{{"belt_speed_m_s", c.launch.belt_speed}, {"belt_width_m", c.sorter.belt_width},
            {"camera_m", c.camera.distance},         {"drop_m", c.launch.drop_distance},
            {"stand_off_m", c.launch.stand_off},     {"gravity_m_s2", c.environment.gravity.z()},
            {"valve_pitch_m", valve_pitch(c)},       {"valves", c.manifold.valves}};
  const double plate = c.splitter.edge ? (*c.splitter.edge)[0] : c.splitter.distance;
  LaunchSpec launch = c.launch;
  launch.offset_along = 0.0;
  const double edge = c.splitter.edge ? (*c.splitter.edge)[1]
                                      : launch_height_at(launch, Vec3::Zero(), c.environment.gravity, plate) +
                                            c.splitter.height;
  view["plate_m"] = {plate, edge};
  double last = 0.0;
  view["particles"] = Json::array();
  for (const ShownParticle& s : stretch.shown) {
    Json outline = Json::array(), path = Json::array();
    for (const Vec3& v : outline_of(s.particle))
      outline.push_back({rounded(s.particle.x - v.x()), rounded(v.y() - s.particle.y)});  // along the motion
    if (!s.track.states.empty())
      for (double time = s.track.from; time < s.track.passes + kPathStep; time += kPathStep) {
        const Vec3 v = s.track.at(time).position;
        path.push_back({rounded(v.x()), rounded(v.y()), rounded(v.z())});
      }
    view["particles"].push_back({{"kind", s.particle.kind},
                                 {"x", rounded(s.particle.x)},
                                 {"y", rounded(s.particle.y)},
                                 {"fate", word(s.fate)},
                                 {"outline", outline},
                                 {"path_from_s", s.track.from},
                                 {"path", path}});
    last = std::max(last, s.particle.x);
  }
  view["path_step_s"] = kPathStep;
  view["length_m"] = last;
  view["objects"] = Json::array();
  for (const SeenObject& o : stretch.objects)
    if (o.x_low > -0.05 && o.x_low < last)
      view["objects"].push_back(
          {rounded(o.x_low), rounded(o.x_high), rounded(o.y_low), rounded(o.y_high), o.eject});
  view["pulses"] = Json::array();
  for (std::size_t v = 0; v < stretch.pulses.size(); ++v)
    for (const ValvePulse& p : stretch.pulses[v])
      if (p.to > 0.0 && p.from < last / c.launch.belt_speed)
        view["pulses"].push_back({v, rounded(p.from), rounded(p.to)});
  return view;
}

std::string sorter_sentence(const Json& r) {
  const auto percent = [&](const char* name) {
    return r.at(name).is_null() ? std::string("unknown")
                                : fmt::format("{:.1f} % ({:.1f} to {:.1f})", 100 * r.at(name).get<double>(),
                                              100 * r.at(std::string(name) + "_low").get<double>(),
                                              100 * r.at(std::string(name) + "_high").get<double>());
  };
  std::string text = fmt::format(
      "{:.0f} particles, {:.3g} t/h: recovery {}, purity {}, loss {}; {:.3g} Nm3 of air a tonne",
      r.at("particles").get<double>(), r.at("throughput_t_h").get<double>(), percent("recovery_mass"),
      percent("purity_mass"), percent("loss_mass"), r.at("air_Nm3_per_t").get<double>());
  if (r.contains("vessel_lowest_Pa"))
    text +=
        fmt::format("; its vessel falls to {:.3g} bar absolute", 1e-5 * r["vessel_lowest_Pa"].get<double>());
  return text;
}

}  // namespace ejecta
