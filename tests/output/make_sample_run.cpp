// Writes a run directory through the output room alone, with made-up numbers of the right size and kind: a
// pulsed round jet, a cube and a flat that are pushed by it, a plate. The tests of ParaView, of the Python
// reader and of the report open it. PUSH multiplies the force, 0
// leaves the bodies out. Usage: make_sample_run DIR [PUSH [CELLS_PER_10MM]]
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <vector>

#include "base/error.hpp"
#include "grid/grid.hpp"
#include "output/body_surface.hpp"
#include "output/history.hpp"
#include "output/pvd_series.hpp"
#include "output/replay.hpp"
#include "output/run_directory.hpp"
#include "output/slice_sampler.hpp"
#include "output/vtk_bodies.hpp"
#include "output/vtk_rectilinear.hpp"
#include "shape/shape.hpp"

namespace {

using namespace ejecta;
using namespace ejecta::output;

constexpr double kEnd = 0.105, kFlowEnd = 0.024, kStep = 1e-4;  // s
constexpr double kOpen = 0.004, kClose = 0.012;                 // s
constexpr double kStandOff = 0.075, kBelt = 3.0;                // m, m/s

double smooth(double x) { return x <= 0 ? 0 : x >= 1 ? 1 : x * x * (3 - 2 * x); }
double opening(double t) { return smooth((t - kOpen) / 3e-3) * (1 - smooth((t - kClose) / 1e-3)); }

/// Far field of a round jet, switched on and off with a delay that grows with z.
double jet_speed(double r, double z, double t) {
  const double half = 0.094 * z;
  const double delay = 8.0 * z * z / 90.0 * 0.5;
  return 5.9 * 1.8e-3 * 690.0 / z * opening(t - delay) *
         std::exp(-std::numbers::ln2 * r * r / (half * half)) *
         (1 + 0.1 * std::sin(900 * z - 5e3 * t) * std::exp(-std::pow((r - half) / half, 2)));
}

struct Lump {
  std::string name;
  Vec3 size, position, velocity{kBelt, 0, -0.33}, force{0, 0, 0}, torque{0, 0, 0}, spin{0, 0, 0};
  Quat orientation{1, 0, 0, 0};
  double mass() const { return 2700 * size.prod(); }

  void advance(double t, double push, double dt) {
    const Vec3 p = position;
    const double q = 0.5 * 1.18 * std::pow(jet_speed(std::hypot(p.x(), p.y()), std::max(p.z(), 0.02), t), 2);
    const double area = size.x() * size.y();
    force = push * q * area * 1.1 * Vec3(0.2 * std::tanh(p.x() / 0.01), 0.1 * std::tanh(p.y() / 0.01), 1);
    torque = push * q * area * Vec3(0, -0.02 * p.x(), 0);
    velocity += dt * (force / mass() + Vec3(0, 0, -9.81));
    position += dt * velocity;
    spin += dt * torque / (mass() * size.squaredNorm() / 12);
    const double angle = spin.norm() * dt;
    if (angle > 0) orientation = Quat(Eigen::AngleAxisd(angle, spin.normalized())) * orientation;
  }
};

nlohmann::ordered_json vec(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

void write_sample(const std::filesystem::path& directory, double push, int cells_per_10mm) {
  const RunDirectory run = RunDirectory::create(directory, true);
  const std::string case_text =
      "# Made-up case of the tests\n[run]\ntitle = \"Sample: two lumps and one jet\"\nend_time = \"90 "
      "ms\"\n\n"
      "[valve]\nsupply_pressure = \"700 kPa gauge\"\norifice_diameter = \"1.8 mm\"\nduration = \"8 ms\"\n\n"
      "[splitter]\ndistance = \"250 mm\"\nheight = \"45 mm\" # above the undisturbed path <- & \"quotes\"\n";
  const Provenance provenance{"ejecta run sample.toml", "sample.toml", case_text, 2};
  run.write_case(case_text);
  run.write_manifest(make_manifest(provenance));

  const double h = 0.01 / cells_per_10mm;
  const auto axis = [&](double from, double to) {
    return make_axis({from, to}, {static_cast<int>(std::lround((to - from) / h))}, {});
  };
  const Grid grid(axis(-0.06, 0.06), axis(-0.03, 0.03), axis(0.04, 0.14));
  Field u = grid.make_field(), v = grid.make_field(), w = grid.make_field(), p = grid.make_field();

  std::vector<Lump> lumps{{"cube", {0.01, 0.01, 0.01}, {-0.0165, 0, kStandOff + 0.0013}},
                          {"flat", {0.01, 0.01, 0.005}, {-0.034, 0.006, kStandOff + 0.0028}}};
  std::vector<BodySurface> surfaces{
      make_body_surface("cube", make_cluster(lumps[0].size, {3, 3, 3}, 0.005).surface(2e-4)),
      make_body_surface("flat", make_box(lumps[1].size).surface())};
  const bool jet_only = push == 0.0;
  if (jet_only) lumps.clear(), surfaces.clear();

  ReplayHeader header;
  header.domain = {grid.lower(), grid.upper()};
  header.rasters = {{"y = 0", 1, 0.0, {-0.06, 0.04}, {0.06, 0.14}, {240, 200}, false, false},
                    {"z = 75 mm", 2, 0.075, {-0.06, -0.03}, {0.06, 0.03}, {240, 120}, false, false}};
  header.bodies = surfaces;
  if (!jet_only)
    header.plates = {{"dividing plate", Vec3(0.25, 0, 0.072), Vec3(1, 0, 0), Vec3(0, 1, 0), 0.1, 0.1, 2e-3}};
  header.nozzles = {{Vec3(0, 0, 0), Vec3(0, 0, 1), 1.8e-3}};
  header.valve_open = {{kOpen, kClose}};
  header.valve_opening = {{0.0, 0.0}, {kOpen, 0.0}, {0.5 * (kOpen + kClose), 1.0}, {kClose, 0.0}};
  for (const Lump& lump : lumps) {
    std::vector<Vec3> path;
    for (double t = 0; t <= kEnd; t += 2e-3)
      path.push_back(lump.position + t * lump.velocity + 0.5 * t * t * Vec3(0, 0, -9.81));
    header.undisturbed.push_back(path);
  }
  ReplayFile replay(run.replay(), header);
  SliceSampler side(grid, header.rasters[0]), top(grid, header.rasters[1]);
  RectilinearWriter cells(grid);
  BodiesWriter solids(surfaces);
  PvdSeries air(run.fields(), "air"), slice(run.fields(), "slice-y0"), bodies(run.fields(), "bodies");

  const std::vector<std::string> lines = provenance_lines(provenance);
  std::vector<Column> columns;
  for (const auto& [quantity, unit] : std::initializer_list<std::pair<const char*, const char*>>{
           {"", "m"}, {"velocity_", "m/s"}, {"spin_", "rad/s"}, {"force_", "N"}, {"torque_", "N m"}})
    for (const char d : {'x', 'y', 'z'}) columns.push_back({quantity + std::string(1, d), unit});
  std::vector<HistoryFile> histories;
  for (const Lump& lump : lumps) histories.emplace_back(run.history("body-" + lump.name), lines, columns);
  HistoryFile probe(run.history("probe-axis"), lines, {{"total_pressure", "Pa"}, {"speed", "m/s"}});
  HistoryFile line(run.history("line-across"), lines, {{"position", "m"}, {"velocity_z", "m/s"}});
  HistoryFile ledger(run.history("ledger"), lines, {{"momentum_residual", "1"}, {"mass_residual", "1"}});

  const int steps = static_cast<int>(std::lround(kEnd / kStep));
  ReplayFrame frame;
  for (int n = 0; n <= steps; ++n) {
    const double t = n * kStep;
    if (n > 0)
      for (Lump& lump : lumps) lump.advance(t, push, kStep);
    const bool flowing = t <= kFlowEnd + 1e-12;
    const double speed = jet_speed(0, kStandOff, t);
    for (std::size_t b = 0; b < lumps.size(); ++b) {
      const Lump& l = lumps[b];
      std::vector<double> row;
      for (const Vec3& q : {l.position, l.velocity, l.spin, l.force, l.torque})
        row.insert(row.end(), {q.x(), q.y(), q.z()});
      histories[b].add(t, row);
    }
    probe.add(t, std::vector{0.5 * 1.18 * speed * speed, speed});
    ledger.add(t, std::vector{2e-6 * std::sin(200 * t), 1e-8 * std::cos(90 * t)});
    if (n % (flowing ? 2 : 10) != 0) continue;
    frame.time = t;
    frame.bodies.clear();
    for (const Lump& l : lumps) frame.bodies.push_back({l.position, l.orientation});
    frame.slices.clear();
    if (flowing) {
      for (int k = 0; k < grid.nz(); ++k)
        for (int j = 0; j < grid.ny(); ++j)
          for (int i = 0; i < grid.nx(); ++i) {
            const Vec3 c = grid.centre(i, j, k);
            const double s = jet_speed(std::hypot(c.x(), c.y()), c.z(), t);
            w(i, j, k) = static_cast<Real>(s);
            u(i, j, k) = static_cast<Real>(0.05 * s * c.x() / 0.01);
            p(i, j, k) = static_cast<Real>(0.5 * 1.18 * s * s);
          }
      frame.slices.resize(2);
      frame.slices[1].raster = 1;
      side.sample(u.view(), v.view(), w.view(), frame.slices[0]);
      top.sample(u.view(), v.view(), w.view(), frame.slices[1]);
    }
    replay.add(frame);
    if (flowing && n % 40 == 0) {
      const std::vector<CellField> fields{vector_field("velocity", u.view(), v.view(), w.view()),
                                          scalar_field("pressure", p.view())};
      const auto vtr = air.next(".vtr"), plane = slice.next(".vtr"), vtp = bodies.next(".vtp");
      cells.write(vtr, t, fields);
      air.add(t, vtr);
      cells.write(plane, t, fields, slice_range(grid, 1, 0.0));
      slice.add(t, plane);
      std::vector<BodyPose> poses = frame.bodies;
      BodyArray velocity{"velocity", 3, {}};
      for (const Lump& l : lumps)
        for (int d = 0; d < 3; ++d) velocity.values.push_back(l.velocity[d]);
      solids.write(vtp, t, poses, std::vector{velocity});
      bodies.add(t, vtp);
      for (double r = -0.03; r <= 0.0301; r += 1e-3)
        line.add(t, std::vector{r, jet_speed(std::abs(r), kStandOff, t)});
    }
  }

  nlohmann::ordered_json result{{"title", jet_only ? "Sample: a free jet" : "Sample: two lumps and one jet"}};
  result["bodies"] = nlohmann::ordered_json::array();
  for (std::size_t b = 0; b < lumps.size(); ++b) {
    const Lump& l = lumps[b];
    const double free_fall = -0.33 - 9.81 * kEnd, clearance = l.position.z() - 0.072;
    result["bodies"].push_back({{"name", l.name},
                                {"outcome", clearance > 0 ? "ejected" : "not ejected"},
                                {"velocity_change_z_m_s", l.velocity.z() - free_fall},
                                {"impulse_x_N_s", l.mass() * (l.velocity.x() - kBelt)},
                                {"impulse_y_N_s", l.mass() * l.velocity.y()},
                                {"impulse_z_N_s", l.mass() * (l.velocity.z() - free_fall)},
                                {"clearance_at_splitter_m", clearance},
                                {"velocity_margin_z_m_s", clearance / 0.08},
                                {"final_position_m", vec(l.position)},
                                {"final_velocity_m_s", vec(l.velocity)},
                                {"mass_kg", l.mass()}});
  }
  if (jet_only)
    result["expectations"] = {{{"quantity", "/spreading"},
                               {"computed", 0.0951},
                               {"reference", 0.094},
                               {"error", 0.0011},
                               {"pass", true},
                               {"source", "Hussein et al. 1994"}},
                              {{"quantity", "/decay"},
                               {"computed", 6.3},
                               {"reference", 5.9},
                               {"error", 0.4},
                               {"pass", false},
                               {"source", "Hussein et al. 1994"}}};
  else result["outcome"] = result["bodies"][0]["outcome"];
  result.update({{"cells", grid.cells()},
                 {"steps", steps},
                 {"simulated_time_s", kEnd},
                 {"wall_time_s", 21.4},
                 {"threads", 2},
                 {"cell_steps_per_s", 4.1e7},
                 {"max_courant", 1.31}});
  nlohmann::ordered_json& line_at_end = result["lines"]["across"];
  for (double r = -0.03; r <= 0.0301; r += 1e-3) {
    line_at_end["position_m"].push_back(r + 0.03);
    line_at_end["speed"].push_back(jet_speed(std::abs(r), kStandOff, 0.01));
  }
  result["air_kinetic_energy_J"] = 1.7e-4;
  result["ledger"] = {{"mass_relative_residual", 3.1e-8},
                      {"momentum_relative_residual", 2.2e-6},
                      {"energy_relative_residual", 5.0e-5}};
  result["operators"] = {
      {{"name", "devices.update"},
       {"equation", "valve opening -> boundary states"},
       {"seconds", 0.02},
       {"calls", 600}},
      {{"name", "map.bodies"},
       {"equation", "signed distance -> solid fraction"},
       {"seconds", 1.1},
       {"calls", 600}},
      {{"name", "flow.predict"},
       {"equation", "du/dt + div(u u) = div(nu grad u)"},
       {"seconds", 8.7},
       {"calls", 600}},
      {{"name", "flow.project"},
       {"equation", "div((1/rho) grad p) = div(u)/dt"},
       {"seconds", 9.4},
       {"calls", 1200}},
      {{"name", "bodies.advance"}, {"equation", "m dv/dt = F + m g"}, {"seconds", 0.3}, {"calls", 600}}};
  result["inputs"] = {{{"what", "Pressure upstream of the nozzle"},
                       {"value", fmt::format("{} kPa gauge", 700 * push)},
                       {"key", "valve.supply_pressure"}},
                      {{"what", "Speed along +x with which the body leaves the belt"},
                       {"value", "3 m/s"},
                       {"key", "launch.belt_speed"}}};
  result["assumptions"] = {
      {{"what", "Diameter of the orifice"},
       {"value", "1.8 mm"},
       {"reason", "The paper does not give it; measured jet constants imply 1.55-1.9 mm."},
       {"key", "valve.orifice_diameter"}},
      {{"what", "Edge of the dividing plate"},
       {"value", "250 mm behind the jet, 45 mm above the undisturbed path"},
       {"reason", "Not given by the paper; one position must reproduce its table."},
       {"key", "splitter.height"}}};
  run.write_result(result);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) throw InputError("usage: make_sample_run DIR [PUSH [CELLS_PER_10MM]]");
  write_sample(argv[1], argc > 2 ? std::stod(argv[2]) : 2.4, argc > 3 ? std::stoi(argv[3]) : 5);
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
