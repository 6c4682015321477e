#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/state_reader.hpp"
#include "case/load.hpp"
#include "dem/particles.hpp"
#include "dem/rotation.hpp"
#include "dem/time_step.hpp"

/// Particles: who is there, and what is stored of them.
namespace ejecta {
namespace {

/// Added to the stored presence of a body that its release has not moved yet: the time alone does not tell.
constexpr int kWaitsForRelease = 3;
constexpr int kFresh = 6;  // likewise

constexpr double kDeepDent = 0.1;  // of the smallest width
constexpr double kGiven = 0.02;    // of what went through contacts
constexpr double kFarLeap = 0.5;   // diameters; two such balls pass each other in one step

void append(std::vector<double>& out, const Vec3& v) { out.insert(out.end(), v.data(), v.data() + 3); }

}  // namespace

int Particles::add(Body body) {
  if (!(body.mass > 0) || !(body.inertia.minCoeff() > 0))
    throw InputError(
        fmt::format("body \"{}\": mass {} kg and moments of inertia must be positive", body.name, body.mass));
  if (body.motion == Motion::prescribed && !body.course)
    body.course = std::make_shared<Course>(body.velocity, body.angular_velocity);
  const int index = static_cast<int>(bodies_.size());
  presence_.push_back(body.enters_at ? Presence::waiting : Presence::here);
  launches_.push_back({body.enters_at || time_ < body.release_at, body.velocity, body.angular_velocity});
  if (launches_.back().waiting || body.motion == Motion::fixed) {
    body.velocity.setZero();
    body.angular_velocity.setZero();
  }
  peaks_.emplace_back();
  fresh_.push_back(true);
  momentum_.push_back(body.angular_momentum());
  for (auto* v : {&force_, &torque_, &velocity_, &spin_, &listed_at_}) v->push_back(Vec3(0, 0, 0));
  turned_.push_back(0.0);
  parts_.add(body, index);
  parts_.set_here(index, presence_.back() == Presence::here);
  note_size(body.shape);
  bodies_.push_back(std::move(body));
  relist_ = true;
  return index;
}

void Particles::note_size(const Shape& shape) {
  smallest_ = std::min(smallest_, shape.bounding_radius());
  // Not of balls: dust in a jet would divide the steps of all by what no two of its grains ever come
  // together.
  if (shape.balls().size() != 1) thinnest_ = std::min(thinnest_, shape.smallest_feature());
}

void Particles::remove(int index) {
  const int first = parts_.first_ball(index), end = parts_.first_ball(index + 1);
  const int first_solid = parts_.first_polytope(index), end_solid = parts_.first_polytope(index + 1);
  const auto renamed = [](int n, int from, int to) { return n < from ? n : n < to ? -1 : n - (to - from); };
  std::vector<int> ball_names(static_cast<std::size_t>(parts_.ball_count()));
  for (int n = 0; n < parts_.ball_count(); ++n)
    ball_names[static_cast<std::size_t>(n)] = renamed(n, first, end);
  solids_.rename([&](SolidPair& p) {
    if (p.body_a == index || p.body_b == index) return false;
    for (PartKey* k : {&p.a, &p.b}) {
      if (k->kind == PartKind::ball) k->index = renamed(k->index, first, end);
      if (k->kind == PartKind::polytope) k->index = renamed(k->index, first_solid, end_solid);
    }
    p.body_a = renamed(p.body_a, index, index + 1);
    if (p.body_b >= 0) p.body_b = renamed(p.body_b, index, index + 1);
    return true;
  });
  bodies_.erase(bodies_.begin() + index);
  for (auto* v : {&momentum_, &force_, &torque_, &velocity_, &spin_, &listed_at_})
    v->erase(v->begin() + index);
  turned_.erase(turned_.begin() + index);
  peaks_.erase(peaks_.begin() + index);
  presence_.erase(presence_.begin() + index);
  fresh_.erase(fresh_.begin() + index);
  launches_.erase(launches_.begin() + index);
  parts_.clear();
  smallest_ = thinnest_ = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls_) thinnest_ = std::min(thinnest_, width_polytopes(wall.solids));
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    parts_.add(bodies_[n], static_cast<int>(n));
    parts_.set_here(static_cast<int>(n), presence_[n] == Presence::here);
    note_size(bodies_[n].shape);
  }
  balls_.rename(ball_names, parts_.ball_count());
  relist_ = true;
}

void Particles::add(Wall wall) {
  const int index = static_cast<int>(walls_.size());
  wall.first_plane = static_cast<int>(planes_.size());
  if (wall.is_plane) planes_.push_back({wall.normal, wall.offset, index});
  else
    for (const Surface::Region& r : wall.surface->regions())
      for (const double side : {1.0, -1.0})
        planes_.push_back({side * r.plane.normal, side * r.plane.offset, index});
  thinnest_ = std::min(thinnest_, width_polytopes(wall.solids));
  walls_.push_back(std::move(wall));
  for (std::size_t n = static_cast<std::size_t>(walls_.back().first_plane); n < planes_.size(); ++n)
    balls_.add(planes_[n], walls_.back());
  cover_walls();
  join_walls();
  relist_ = true;
}

/// Walls that overlap push once: of two solids the later one is what lies outside the earlier; what lies
/// wholly under a plane is covered by it, of planes that look the same way the lower. Of the last wall, with
/// all.
void Particles::cover_walls() {
  constexpr double kHair = 1e-9;  // of the size: as high
  Wall& last = walls_.back();
  const auto is_under = [](const Wall& wall, const Wall& plane) {
    const auto below = [&](const Polytope& p) {
      return plane.normal.dot(support_polytope(p, plane.normal)) - plane.offset <= kHair * p.radius;
    };
    return wall.is_plane ? wall.normal.dot(plane.normal) > 1 - 1e-15 && wall.offset <= plane.offset
                         : !wall.solids.empty() && std::all_of(wall.solids.begin(), wall.solids.end(), below);
  };
  for (Wall& wall : std::span(walls_).first(walls_.size() - 1)) {
    if (wall.covered) continue;
    if (wall.is_plane && is_under(last, wall)) last.covered = true;
    else if (last.is_plane && is_under(wall, last)) wall.covered = true;
    if (last.solids.empty()) continue;
    const std::vector<Polytope> whole = last.solids;
    for (const Polytope& q : wall.solids) {
      std::vector<Polytope> left;
      for (const Polytope& p : last.solids)
        for (Polytope& part : without(p, q)) left.push_back(std::move(part));
      last.solids = std::move(left);
    }
    last.covered = last.covered || last.solids.empty();
    const auto same = [](const Polytope& p, const Polytope& q) { return p.vertices == q.vertices; };
    if (std::equal(last.solids.begin(), last.solids.end(), whole.begin(), whole.end(), same)) continue;
    for (Polytope& p : last.solids) p.seams.clear();
    find_seams(last.solids);
  }
}

/// Walls that lie on each other, across periodic sides too, are one solid. Of the last one, with all.
void Particles::join_walls() {
  Eigen::Vector3i most;
  for (int c = 0; c < 3; ++c) most[c] = domain_.period[c] > 0 ? 1 : 0;
  std::vector<Polytope>& added = walls_.back().solids;
  const auto join = [](Polytope& p, const Polytope& q, const Vec3& shift) {
    if ((q.centre + shift - p.centre).norm() > 1.01 * (p.radius + q.radius)) return;
    find_seams(p, shift.isZero() ? q : moved(q, Mat3::Identity(), shift));
  };
  for (int x = -most.x(); x <= most.x(); ++x)
    for (int y = -most.y(); y <= most.y(); ++y)
      for (int z = -most.z(); z <= most.z(); ++z)
        for (Wall& wall : walls_) {
          const Vec3 shift = Vec3(x, y, z).cwiseProduct(domain_.period);
          const bool itself = &wall == &walls_.back();
          if (itself && shift.isZero()) continue;  // its own parts know each other
          for (Polytope& p : added)
            for (Polytope& q : wall.solids) {
              join(p, q, shift);
              if (!itself) join(q, p, -shift);
            }
        }
}

void Particles::place(int index, const Vec3& position, const Quat& orientation, const Vec3& velocity,
                      const Vec3& angular_velocity) {
  const std::size_t n = static_cast<std::size_t>(index);
  Body& b = bodies_[n];
  b.position = position;
  b.orientation = orientation;
  launches_[n] = {time_ < b.release_at, velocity, angular_velocity};
  b.velocity = launches_[n].waiting ? Vec3(0, 0, 0) : velocity;
  b.angular_velocity = launches_[n].waiting ? Vec3(0, 0, 0) : angular_velocity;
  momentum_[n] = b.angular_momentum();
  parts_.update(index, b, b.velocity, b.angular_velocity);
  fresh_[n] = true;
  relist_ = true;
}

std::vector<std::string> Particles::warnings() const {
  std::vector<std::string> sentences;
  std::size_t kept_out = 0, first = 0;
  for (std::size_t n = bodies_.size(); n-- > 0;)
    if (presence_[n] == Presence::waiting && time_ >= *bodies_[n].enters_at) ++kept_out, first = n;
  if (kept_out > 0)
    sentences.push_back(fmt::format(
        "{} never came in: other bodies or walls were in {} place{}",
        kept_out == 1 ? fmt::format("body \"{}\"", bodies_[first].name)
                      : fmt::format("{} bodies, the first of them \"{}\",", kept_out, bodies_[first].name),
        kept_out == 1 ? "its" : "their", kept_out == 1 ? "" : "s"));
  const std::string* last = nullptr;
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    if (last && bodies_[n].name == *last) continue;  // of grains, which share a name, the first
    const double width = bodies_[n].shape.smallest_feature(), share = peaks_[n].overlap / width;
    if (!(share > kDeepDent)) continue;
    last = &bodies_[n].name;
    sentences.push_back(
        fmt::format("body \"{}\" was dented by {:.3g} mm, {:.0f} % of its smallest width ({:.3g} mm): forces "
                    "of contacts that "
                    "deep are not to be trusted; a larger youngs_modulus makes them shallower",
                    bodies_[n].name, 1e3 * peaks_[n].overlap, 100 * share, 1e3 * width));
  }
  if (-contact_work_ > kGiven * exchanged_)
    sentences.push_back(fmt::format(
        "contacts gave {:.3g} J more than they took, {:.0f} % of what went through them: their steps are too "
        "long for how hard bodies are pressed; a smaller contact.time_step_fraction shortens them",
        -contact_work_, -100 * contact_work_ / exchanged_));
  if (leap_ > kFarLeap)
    sentences.push_back(fmt::format(
        "a ball moved by {:.2g} of its diameters in one step of contacts: some may have passed through each "
        "other unseen; a larger youngs_modulus or a smaller contact.time_step_fraction makes steps shorter",
        leap_));
  return sentences;
}

DemEnergy Particles::energy() const {
  DemEnergy e;
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    const Body& b = bodies_[n];
    if (presence_[n] != Presence::here) continue;
    e.kinetic += b.kinetic_energy();
    if (b.motion == Motion::free) e.potential -= b.mass * gravity_.dot(b.position);
  }
  e.elastic = balls_.elastic() + solids_.elastic();
  e.dissipated = contact_work_ - e.elastic;
  e.work = outer_work_;
  return e;
}

std::vector<ContactRecord> Particles::contacts() const {
  std::vector<ContactRecord> records;
  for (int n = 0; n < balls_.pair_count(); ++n) {
    const auto& row = balls_.row(n);
    if (!(row.half_overlap > 0)) continue;
    const auto [a, b] = balls_.pair(n);
    const BallRow& ball = parts_.row(a);
    const WallPlane* plane = b < 0 ? &planes_[static_cast<std::size_t>(-1 - b)] : nullptr;
    const Vec3 normal =
        plane ? plane->normal : domain_.nearest(ball.centre() - parts_.row(b).centre()).normalized();
    records.push_back({parts_.body_of_ball(a), plane ? -1 - plane->wall : parts_.body_of_ball(b),
                       ball.centre() - (ball.radius - row.half_overlap) * normal, normal,
                       Vec3(row.fx, row.fy, row.fz), 2 * row.half_overlap});
  }
  for (const SolidPair& p : solids_.pairs())
    if (p.touch.overlap > 0)
      records.push_back({p.body_a, p.body_b >= 0 ? p.body_b : -1 - p.b.index, p.touch.point, p.touch.normal,
                         p.force, p.touch.overlap});
  return records;
}

std::vector<double> Particles::state() const {
  std::vector<double> s{time_,
                        static_cast<double>(bodies_.size()),
                        contact_work_,
                        outer_work_,
                        power_.into_contacts,
                        power_.from_outside,
                        asked_rate_,
                        exchanged_,
                        leap_,
                        relist_ ? 1.0 : 0.0,
                        skin_};
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    const Body& b = bodies_[n];
    append(s, b.position);
    s.insert(s.end(), b.orientation.coeffs().data(), b.orientation.coeffs().data() + 4);
    append(s, b.velocity);
    append(s, momentum_[n]);
    append(s, force_[n]);
    append(s, torque_[n]);
    append(s, listed_at_[n]);
    s.push_back(turned_[n]);
    s.insert(s.end(), {peaks_[n].overlap, peaks_[n].force, peaks_[n].time});
    s.push_back(static_cast<int>(presence_[n]) + (launches_[n].waiting ? kWaitsForRelease : 0) +
                (fresh_[n] ? kFresh : 0));
  }
  balls_.save(s);
  solids_.save(s);
  return s;
}

bool Particles::exists(const SolidPair& p) const {
  const auto below = [](int n, std::size_t count) { return n >= 0 && static_cast<std::size_t>(n) < count; };
  const auto is_part = [&](const PartKey& k, int body) {
    if (k.kind == PartKind::ball)
      return k.index < parts_.ball_count() && parts_.body_of_ball(k.index) == body;
    return k.kind == PartKind::polytope && k.index >= parts_.first_polytope(body) &&
           k.index < parts_.first_polytope(body + 1);
  };
  if (!is_part(p.a, p.body_a)) return false;
  if (p.body_b >= 0) return p.b.kind == PartKind::polytope && is_part(p.b, p.body_b);
  if (!below(p.b.index, walls_.size())) return false;
  const Wall& wall = walls_[static_cast<std::size_t>(p.b.index)];
  const bool ball = p.a.kind == PartKind::ball;
  if (p.b.kind == PartKind::wall_plane) return wall.is_plane && !ball;
  if (wall.is_plane) return false;
  if (p.b.kind == PartKind::wall_triangle) return ball && below(p.b.solid, wall.surface->triangles().size());
  if (ball) return false;
  return p.b.kind == PartKind::wall_solid    ? below(p.b.solid, wall.solids.size())
         : p.b.kind == PartKind::wall_region ? below(p.b.solid, wall.surface->regions().size())
                                             : false;
}

void Particles::restore(std::span<const double> s) {
  StateReader in(s, "bodies");
  time_ = in.number();
  const int count = static_cast<int>(bodies_.size());
  in.whole(count, count);
  contact_work_ = in.number();
  outer_work_ = in.number();
  power_.into_contacts = in.number();
  power_.from_outside = in.number();
  asked_rate_ = in.number();
  exchanged_ = in.number();
  leap_ = in.number();
  relist_ = in.whole(0, 1) == 1;
  skin_ = in.number();
  for (std::size_t n = 0; n < bodies_.size(); ++n) {
    Body& b = bodies_[n];
    b.position = in.vec3();
    b.orientation.coeffs() = Eigen::Vector4d(in.numbers(4).data());
    b.velocity = in.vec3();
    momentum_[n] = in.vec3();
    force_[n] = in.vec3();
    torque_[n] = in.vec3();
    listed_at_[n] = in.vec3();
    turned_[n] = in.number();
    peaks_[n].overlap = in.number();
    peaks_[n].force = in.number();
    peaks_[n].time = in.number();
    const int stored = in.whole(0, static_cast<int>(Presence::gone) + kWaitsForRelease + kFresh);
    fresh_[n] = stored >= kFresh;
    const int there = stored % kFresh;
    presence_[n] = static_cast<Presence>(there % kWaitsForRelease);
    parts_.set_here(static_cast<int>(n), presence_[n] == Presence::here);
    launches_[n].waiting = there >= kWaitsForRelease;
    b.angular_velocity = angular_velocity(b.orientation, momentum_[n], b.inertia);
    if (b.course && !launches_[n].waiting) b.angular_velocity = b.course->spin(time_);
    parts_.update(static_cast<int>(n), b, b.velocity, b.angular_velocity);
  }
  balls_.load(in, parts_);
  solids_.load(in, count);
  in.end();
  for (const SolidPair& p : solids_.pairs())
    if (!exists(p)) throw Error("bodies: a contact of the state is of parts or walls that are not there");
}

namespace {

/// Shifts by whole periods that bring a wall, or what of it reaches over a periodic side, into the domain:
/// what lies outside of that meets nobody. A floor from one side to the other is there already.
std::vector<Vec3> wall_images(const Wall& wall, const Domain& domain) {
  std::vector<Vec3> shifts{Vec3::Zero()};
  if (wall.is_plane) return {};
  Vec3 low = wall.surface->triangles().front().corners[0], high = low;
  for (const Surface::Triangle& t : wall.surface->triangles())
    for (const Vec3& corner : t.corners) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
  for (int c = 0; c < 3; ++c) {
    const double period = domain.period[c], slack = 1e-9 * period;
    if (!(period > 0) || (low[c] <= domain.low[c] + slack && high[c] >= domain.high[c] - slack)) continue;
    const double first = std::floor((domain.low[c] + slack - high[c]) / period) + 1,
                 last = std::ceil((domain.high[c] - slack - low[c]) / period) - 1;
    std::vector<Vec3> all;
    for (const Vec3& s : shifts)
      for (double k = first; k <= last; ++k) all.push_back(s + k * period * Vec3::Unit(c));
    shifts = std::move(all);
  }
  std::erase_if(shifts, [](const Vec3& s) { return s.isZero(); });
  return shifts;
}

}  // namespace

Particles make_particles(const Case& config) {
  const std::string directory = folder_of(config);
  const ContactSpec& contact = config.contact;
  if (!(contact.time_step_fraction > 0 && contact.time_step_fraction <= 0.5))
    throw InputError(
        fmt::format("contact.time_step_fraction = {} must be in (0, 0.5]; 0.1 resolves a contact well",
                    contact.time_step_fraction));
  const Domain domain = make_domain(config.domain);
  Particles particles(config.environment.gravity, Materials(config), contact, domain);
  for (const BodySpec& spec : config.bodies) {
    Body body = make_body(spec, particles.materials(), directory);
    const double limit = contact_time(body, particles.materials(), std::max(body.velocity.norm(), 1.0));
    if (contact.time_step && !(*contact.time_step > 0 && *contact.time_step <= 0.5 * limit))
      throw InputError(
          fmt::format(
              "contact.time_step = {:.3g} s does not suit body \"{}\" of material \"{}\", whose contacts "
              "last {:.3g} s: at most half of that is stable, {:.3g} s resolves them",
              *contact.time_step, body.name, spec.material, limit, 0.1 * limit),
          {.key = "time_step",
           .expected = fmt::format("at most {:.3g} us, or none", 0.5e6 * limit),
           .example = fmt::format("time_step = \"{:.2g} us\"", 1e5 * limit)});
    for (int c = 0; c < 3; ++c)
      if (domain.period[c] > 0 && domain.period[c] < 4 * body.shape.bounding_radius())
        throw InputError(
            fmt::format("domain.{}: {:.4g} m between periodic sides is too near for body \"{}\", which would "
                        "meet itself; "
                        "at least {:.4g} m",
                        "xyz"[c], domain.period[c], body.name, 4 * body.shape.bounding_radius()),
            {.key = std::string(1, "xyz"[c]),
             .expected = "sides farther apart, or smaller bodies",
             .example = fmt::format("{} = [\"0 mm\", \"{:.3g} mm\"]", "xyz"[c],
                                    4.1e3 * body.shape.bounding_radius())});
    particles.add(std::move(body));
  }
  for (const WallSpec& spec : config.walls) particles.add(make_wall(spec, particles.materials(), directory));
  for (std::size_t n = 0; n < config.walls.size();
       ++n)  // after them all, which stand in the order of the case
    for (const Vec3& shift : wall_images(particles.walls()[n], domain)) {
      WallSpec image = config.walls[n];
      image.point += shift;
      particles.add(make_wall(image, particles.materials(), directory));
    }
  const bool placed =
      std::none_of(config.bodies.begin(), config.bodies.end(), [](const auto& b) { return b.on_belt; });
  if (placed) particles.require_apart();
  return particles;
}

}  // namespace ejecta
