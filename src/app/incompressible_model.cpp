#include "app/incompressible_model.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/grid_sampler.hpp"
#include "app/jet_source.hpp"
#include "app/round_jet.hpp"
#include "base/error.hpp"
#include "base/state_reader.hpp"
#include "case/expression.hpp"
#include "flow/piso/incompressible.hpp"

namespace ejecta {
namespace {

/// Compiled state of a boundary, region or exact solution.
struct StateFormula {
  std::array<Expression, 3> velocity;
  bool has_velocity = false, varies = false;
  double k = 0, second = 0;

  StateFormula(const StateSpec& s, bool omega, double ambient_k, double ambient_second) {
    if (s.velocity)
      for (std::size_t d = 0; d < 3; ++d) {
        velocity[d] = Expression((*s.velocity)[d]);
        varies = varies || velocity[d].uses_time();
      }
    has_velocity = s.velocity.has_value();
    k = s.k.value_or(ambient_k);
    second = ambient_second;
    if (s.epsilon) second = omega ? *s.epsilon / (0.09 * k) : *s.epsilon;
  }
  Vec3 at(const Vec3& x, double t) const {
    return {velocity[0](x.x(), x.y(), x.z(), t), velocity[1](x.x(), x.y(), x.z(), t),
            velocity[2](x.x(), x.y(), x.z(), t)};
  }
};

class IncompressibleModel : public FlowModel {
 public:
  IncompressibleModel(const Case& c, const Grid& grid)
      : case_(c),
        grid_(grid),
        density_(c.fluid.density),
        nu_(c.fluid.viscosity / c.fluid.density),
        omega_(c.flow.turbulence == TurbulenceModel::k_omega_sst),
        jet_(make_jet_source(c)) {
    // Still air: a trace of turbulence whose eddy viscosity equals the molecular one.
    ambient_k_ = 1e-4;
    ambient_second_ = omega_ ? ambient_k_ / nu_ : 0.09 * ambient_k_ * ambient_k_ / nu_;
    IncompressibleSetup setup;
    setup.density = density_;
    setup.viscosity = nu_;
    setup.corrections = c.flow.corrections;
    setup.acceleration = c.flow.body_force;
    setup.round_jet_correction = c.flow.round_jet_correction;
    if (c.flow.turbulence == TurbulenceModel::k_epsilon) setup.turbulence = TwoEquationModel::k_epsilon;
    if (c.flow.turbulence == TurbulenceModel::k_omega_sst) setup.turbulence = TwoEquationModel::k_omega_sst;
    const auto& s = c.exact.source;
    if (s[0] != "0" || s[1] != "0" || s[2] != "0")
      setup.source = [f = std::array<Expression, 3>{Expression(s[0]), Expression(s[1]), Expression(s[2])}](
                         const Vec3& x, double t) {
        return Vec3(f[0](x.x(), x.y(), x.z(), t), f[1](x.x(), x.y(), x.z(), t), f[2](x.x(), x.y(), x.z(), t));
      };
    std::array<Boundary, 6> faces;
    for (int f = 0; f < 6; ++f) faces[static_cast<std::size_t>(f)] = make_boundary(f);
    flow_ = std::make_unique<Incompressible>(grid, faces, setup);
    initialise();
  }

  double stable_dt(double time) override {
    double dt = std::min(flow_->stable_dt(case_.run.courant), case_.run.time_step_max);
    if (!jet_) return dt;
    // A jet that starts must not outrun the step that lets it in, nor open and close unseen within one.
    dt = std::min(dt, 0.01 * case_.valve.duration);
    const double h = grid_.axis(2).width.front(), z = grid_.axis(2).face.front();
    for (int n = 0; n < 60; ++n) {
      const double limit = case_.run.courant * h / std::max(jet_->fastest(time + dt, z), 1e-30);
      if (limit >= dt) break;
      dt = std::max(limit, 0.5 * dt);
    }
    return dt;
  }
  double courant(double dt) const override { return flow_->courant(dt); }
  void advance(double time, double dt, SolidMask& solids) override {
    flow_->advance(time, dt, solids);
    last_time_ = time + dt;
  }
  double density() const override { return density_; }
  std::array<ConstFieldView, 3> velocity() const override { return flow_->velocity(); }

  std::vector<output::CellField> fields() override {
    const auto u = flow_->velocity();
    std::vector<output::CellField> all{
        output::vector_field("velocity", u[0], u[1], u[2]),
        output::scalar_field("pressure", flow_->pressure_field().view(), density_)};
    if (const TwoEquation* t = flow_->turbulence()) {
      all.push_back(output::scalar_field("k", t->k().view()));
      all.push_back(output::scalar_field(omega_ ? "omega" : "epsilon", t->second().view()));
      all.push_back(output::scalar_field("eddy_viscosity", t->eddy_viscosity()));
    }
    return all;
  }
  std::vector<std::pair<std::string, std::string>> quantities() const override {
    std::vector<std::pair<std::string, std::string>> q{{"velocity_x", "m/s"},
                                                       {"velocity_y", "m/s"},
                                                       {"velocity_z", "m/s"},
                                                       {"pressure", "Pa"},
                                                       {"total_pressure", "Pa"}};
    if (flow_->turbulence()) q.insert(q.end(), {{"k", "m2/s2"}, {"eddy_viscosity", "m2/s"}});
    return q;
  }
  void sample(const Vec3& x, std::span<double> values) const override {
    const GridSampler at(grid_, x);
    const auto u = flow_->velocity();
    for (std::size_t d = 0; d < 3; ++d) values[d] = at(u[d]);
    values[3] = density_ * at(flow_->pressure_field().view());
    values[4] =
        values[3] + 0.5 * density_ * (values[0] * values[0] + values[1] * values[1] + values[2] * values[2]);
    if (const TwoEquation* t = flow_->turbulence()) {
      values[5] = at(t->k().view());
      values[6] = at(t->eddy_viscosity());
    }
  }

  Vec3 momentum() const override { return flow_->momentum(); }
  double kinetic_energy() const override { return flow_->kinetic_energy(); }
  bool finite(Vec3* where) const override { return flow_->finite(where); }

  void report(nlohmann::ordered_json& result) const override {
    const FlowLedger& l = flow_->ledger();
    const Vec3 change = flow_->momentum() - momentum_at_start_;
    Vec3 lost = change - l.momentum_through_boundaries + l.impulse_on_solids;
    if (grid_.axisymmetric()) lost.x() = 0.0;  // radial momentum is not conserved
    const double scale =
        std::max({l.momentum_through_boundaries.norm(), l.impulse_on_solids.norm(), change.norm(), 1e-30});
    auto& ledger = result["ledger"];
    ledger["mass_relative_residual"] =
        l.mass_in > 0.0 ? std::abs(l.mass_through_boundaries) / l.mass_in : 0.0;
    ledger["momentum_relative_residual"] = lost.norm() / scale;
    ledger["momentum_through_boundaries_N_s"] = {l.momentum_through_boundaries.x(),
                                                 l.momentum_through_boundaries.y(),
                                                 l.momentum_through_boundaries.z()};
    ledger["impulse_on_solids_N_s"] = {l.impulse_on_solids.x(), l.impulse_on_solids.y(),
                                       l.impulse_on_solids.z()};
    ledger["largest_divergence"] = flow_->largest_divergence();
    ledger["leak_m_s"] = l.leak;
    if (jet_ && grid_.axisymmetric()) {
      const double d = case_.valve.orifice_diameter, z0 = case_.jet.nozzle.z();
      const double exit = jet_->fastest(last_time_, grid_.axis(2).face.front());
      const TwoEquation* t = flow_->turbulence();
      if (const auto jet = analyse_round_jet(grid_, flow_->velocity()[2], flow_->pressure_field().view(),
                                             t ? t->eddy_viscosity() : ConstFieldView{}, nu_, d, exit,
                                             z0 + 30.0 * d, z0 + 0.8 * (grid_.axis(2).face.back() - z0)))
        result["round_jet"] = {{"decay", jet->decay},
                               {"spreading", jet->spreading},
                               {"decay_times_spreading", jet->decay * jet->spreading},
                               {"momentum_variation", jet->momentum_variation}};
    }
  }

  std::vector<output::OperatorTime> operators() const override {
    const FlowTimes& t = flow_->times();
    return {
        {"flow.boundaries", "states of the boundaries into ghost cells", t.boundaries, 0},
        {"flow.momentum_predictor",
         "u* = u + dt [-div(q u) + div(2 nu_eff S) - grad p]  (Eq. 2), two Heun stages", t.momentum, 0},
        {"flow.force_solids", "u* = u_solid + (d/h) (u_image - u_solid) inside solids", t.forcing, 0},
        {"flow.face_velocities", "q* = mean(u*) + dt (mean(grad p) - grad p), r = div q* / dt", t.faces, 0},
        {"flow.pressure", "div grad phi = r, exact by fast diagonalisation", t.pressure, 0},
        {"flow.correction", "q -= dt grad phi, u -= dt grad phi, p += phi", t.correction, 0},
        {"flow.turbulence", "k and epsilon or omega: transport, sources, nu_t", t.turbulence, 0},
        {"flow.ledger", "momentum and mass through the boundaries", t.ledger, 0}};
  }
  std::vector<double> events() const override { return jet_ ? jet_->events() : std::vector<double>{}; }

  std::vector<Field*> state_fields() override { return flow_->state(); }
  std::vector<double> state_numbers() const override {
    const FlowLedger& l = flow_->ledger();
    std::vector<double> n;
    for (const Vec3& v : {l.momentum_through_boundaries, l.impulse_on_solids, momentum_at_start_})
      n.insert(n.end(), {v.x(), v.y(), v.z()});
    n.insert(n.end(), {l.mass_through_boundaries, l.mass_in, l.leak});
    return n;
  }
  void restore_numbers(std::span<const double> n, double time) override {
    FlowLedger& l = flow_->ledger();
    StateReader in(n, "ledger of the air");
    for (Vec3* v : {&l.momentum_through_boundaries, &l.impulse_on_solids, &momentum_at_start_})
      *v = in.vec3();
    for (double* v : {&l.mass_through_boundaries, &l.mass_in, &l.leak}) *v = in.number();
    in.end();
    flow_->resume(time);
  }

 private:
  Boundary make_boundary(int face) const {
    const BoundarySpec& spec = case_.boundary[static_cast<std::size_t>(face)];
    const StateFormula formula(spec.state, omega_, ambient_k_, ambient_second_);
    Boundary b;
    const auto constant_turbulence = [](BoundaryState s, double k, double second) {
      s.k = static_cast<Real>(k);
      s.second = static_cast<Real>(second);
      return s;
    };
    const bool axis = grid_.axisymmetric() && face == 0 && grid_.lower().x() == 0.0;
    switch (axis ? BoundaryType::symmetry : spec.type) {
      case BoundaryType::slip:
      case BoundaryType::symmetry:
        b.kind = BoundaryKind::mirror;
        return b;
      case BoundaryType::periodic:
        b.kind = BoundaryKind::periodic;
        return b;
      case BoundaryType::pressure_outlet:
      case BoundaryType::wave_transmissive:
      case BoundaryType::free_stream:
      case BoundaryType::total_pressure: {
        b.kind = BoundaryKind::open;
        b.total_pressure = spec.type == BoundaryType::total_pressure;
        const double ambient = case_.environment.pressure;
        if (b.total_pressure && spec.total_pressure > 0.0)
          b.pressure = (spec.total_pressure - ambient) / density_;
        if (spec.state.pressure) b.pressure = Expression(*spec.state.pressure)(0, 0, 0, 0) / density_;
        b.state = [=](const Vec3&, double) { return constant_turbulence({}, formula.k, formula.second); };
        if (!spec.patches.empty())
          throw InputError(fmt::format(
              "boundary.{}: patches of an incompressible flow need a face of type wall, velocity or jet",
              face_name(face)));
        return b;
      }
      case BoundaryType::wall:
      case BoundaryType::moving_wall:
        b.kind = spec.patches.empty() ? BoundaryKind::wall : BoundaryKind::inflow;
        break;
      case BoundaryType::velocity:
      case BoundaryType::jet:
        b.kind = BoundaryKind::inflow;
        break;
    }
    if (spec.type == BoundaryType::jet && face != 4)
      throw InputError("a jet blows along +z: it enters through boundary.z_min");
    b.varies = formula.varies;
    struct Piece {
      Vec3 centre;
      double radius;
      bool jet;
      StateFormula formula;
    };
    std::vector<Piece> pieces;
    for (const PatchSpec& p : spec.patches) {
      pieces.push_back({p.centre, p.radius, p.type == BoundaryType::jet,
                        StateFormula(p.state, omega_, ambient_k_, ambient_second_)});
      b.varies = b.varies || pieces.back().jet || pieces.back().formula.varies;
    }
    const bool whole_jet = spec.type == BoundaryType::jet;
    b.varies = b.varies || whole_jet;
    b.state = [=, this](Vec3 x, double t) {
      if (grid_.axisymmetric()) x.y() = case_.jet.nozzle.y();  // all around is in the one cell
      bool jet = whole_jet;
      const StateFormula* f = &formula;
      for (const Piece& p : pieces)
        if ((x - p.centre).norm() <= p.radius) jet = p.jet, f = &p.formula;
      BoundaryState s;
      if (jet) return jet_state(x, t);
      const Vec3 v = f->at(x, t);
      for (int d = 0; d < 3; ++d) s.velocity[static_cast<std::size_t>(d)] = static_cast<Real>(v[d]);
      return constant_turbulence(s, f->k, f->second);
    };
    return b;
  }

  BoundaryState jet_state(const Vec3& x, double t) const {
    const auto half = [&](int d) {
      const Axis& a = grid_.axis(d);
      return 0.5 * a.width[static_cast<std::size_t>(a.cell_at(x[d]))];
    };
    const JetState jet = jet_->at(x, half(0), grid_.axisymmetric() ? 0.0 : half(1), t);
    BoundaryState s;
    for (int d = 0; d < 3; ++d) s.velocity[static_cast<std::size_t>(d)] = static_cast<Real>(jet.velocity[d]);
    const double k = std::max(jet.k, ambient_k_);
    const double epsilon = jet.k > ambient_k_ ? jet.epsilon : 0.09 * k * k / nu_;
    s.k = static_cast<Real>(k);
    s.second = static_cast<Real>(omega_ ? epsilon / (0.09 * k) : epsilon);
    return s;
  }

  void initialise() {
    std::vector<std::pair<const InitialSpec*, StateFormula>> regions;
    for (const InitialSpec& i : case_.initial)
      regions.emplace_back(&i, StateFormula(i.state, omega_, ambient_k_, ambient_second_));
    const auto inside = [](const InitialSpec& i, const Vec3& x) {
      return !i.box || ((x - (*i.box)[0]).minCoeff() >= 0.0 && ((*i.box)[1] - x).minCoeff() >= 0.0);
    };
    if (TwoEquation* t = flow_->turbulence()) {
      t->initialise(ambient_k_, ambient_second_);
      for (const auto& [spec, formula] : regions)
        for (int k = 0; k < grid_.nz(); ++k)
          for (int j = 0; j < grid_.ny(); ++j)
            for (int i = 0; i < grid_.nx(); ++i)
              if (inside(*spec, grid_.centre(i, j, k))) t->set_at(i, j, k, formula.k, formula.second);
    }
    const auto velocity = [&](const Vec3& x) {
      Vec3 v{0, 0, 0};
      for (const auto& [spec, formula] : regions)
        if (formula.has_velocity && inside(*spec, x)) v = formula.at(x, 0.0);
      return v;
    };
    std::vector<std::pair<const InitialSpec*, Expression>> pressures;
    for (const InitialSpec& i : case_.initial)
      if (i.state.pressure) pressures.emplace_back(&i, Expression(*i.state.pressure));
    const auto pressure = [&](const Vec3& x) {
      double p = 0.0;
      for (const auto& [spec, formula] : pressures)
        if (inside(*spec, x)) p = formula(x.x(), x.y(), x.z(), 0.0) / density_;
      return p;
    };
    flow_->initialise(velocity, pressure, 0.0);
    momentum_at_start_ = flow_->momentum();
  }

  static const char* face_name(int face) {
    static constexpr const char* names[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
    return names[face];
  }

  const Case& case_;
  const Grid& grid_;
  double density_, nu_;
  bool omega_;
  double ambient_k_ = 0, ambient_second_ = 0;
  std::unique_ptr<JetSource> jet_;
  std::unique_ptr<Incompressible> flow_;
  Vec3 momentum_at_start_{0, 0, 0};
  double last_time_ = 0;
};

}  // namespace

std::unique_ptr<FlowModel> make_incompressible_model(const Case& c, const Grid& grid) {
  return std::make_unique<IncompressibleModel>(c, grid);
}

}  // namespace ejecta
