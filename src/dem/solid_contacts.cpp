#include "dem/solid_contacts.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "dem/blocks.hpp"
#include "dem/time_step.hpp"

namespace ejecta {
namespace {

constexpr int kPairBlock = 32;         // pairs, or groups of them, one thread takes at a time
constexpr double kSameHollow = 0.906;  // cosine of 25 degrees: normals of one hollow
constexpr double kLeastDepth = 0.5;    // energy of a flat contact over force x mean thickness: a face; to
constexpr double kLeastFactor = 1e-9;  // nothing, but for ratios of forces and energies
constexpr double kMostDepth = 0.75;    // that of a corner
constexpr double kSeveral = 2.0;       // a body turns as it is pushed, and others push it too

Triple<double> triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vec(const Triple<double>& t) { return {t.x, t.y, t.z}; }

/// Material and motion of one side of a contact.
struct Side {
  int material = 0;
  double inverse_mass = 0.0;
  Vec3 velocity{0, 0, 0}, spin{0, 0, 0};  // m/s at the contact point, rad/s
};

/// Of a contact: what the law needs.
struct Meeting {
  Side a, b;
  Contact<double> contact;
  NormalSpring<double> spring;
  double least = 0.0, most = 0.0;  // J, that the spring may hold at this dent
};

/// Walls that lie beside each other are one surface to a ball, as a belt and the chute after it.
bool same_surface(const SolidPair& p, const SolidPair& q) {
  return p.a == q.a && p.b.kind == q.b.kind && p.body_b == q.body_b;
}

/// Which part of a flat contact's tilting moves its pressure: all of it where a face rocks on its patch,
/// nothing where a round body rolls and the patch goes with it. A face that tilts by an angle leans by a^2/4
/// times that.
double share_of_rocking(const Touch& t, const ContactHistory& h, const Vec3& spin, double dt) {
  const Vec3 tilting = spin.cross(t.normal);
  const double whole = 0.25 * t.patch_radius * t.patch_radius * tilting.squaredNorm() * dt;
  if (!h.touched() || !(whole > 0)) return 1.0;
  return std::clamp((t.lean - vec(h.lean)).dot(tilting) / whole, 0.0, 1.0);
}

void apply_law(SolidPair& pair, Meeting& m, const PairConstants<double>& p, bool tension, double dt) {
  const Touch& t = pair.touch;
  ContactHistory& h = pair.history;
  Contact<double>& c = m.contact;
  // Of springs side by side those that a growing face comes to lie on are not stretched yet. What they resist
  // twisting with goes with the square of the area.
  const double twisting_now = 0.5 * m.spring.tangential * t.patch_radius * t.patch_radius;
  if (h.twist.stiffness < twisting_now) h.slip = std::sqrt(h.twist.stiffness / twisting_now) * h.slip;
  const ContactForce<double> f = contact_force(m.spring, c, p, tension, dt, h.slip);
  const Vec3 spin = m.a.spin - m.b.spin;
  pair.force = vec(f.force);
  const double rocking = share_of_rocking(t, h, spin, dt);
  pair.moment = vec(patch_moment(t.patch_radius, c.normal, p, f, triple(spin), rocking, dt, h.twist));
  if (p.rolling > 0) {
    c.radius = t.size;
    pair.moment += vec(rolling_moment(c, p, f, triple(spin), dt, h.roll));
  }
  const double twisting = 0.5 * h.twist.stiffness * h.twist.angle * h.twist.angle;
  pair.elastic = pair.stored + f.elastic_tangential + twisting;
  pair.wall_power = pair.body_b < 0 ? pair.force.dot(m.b.velocity) : 0.0;
  h.normal = c.normal;
  h.lean = triple(t.lean);
  h.side = t.side;
  h.face = t.face;
}

}  // namespace

int image_of(const Eigen::Vector3i& periods) {
  int image = 0;
  for (int c = 2; c >= 0; --c) image = 3 * image + (periods[c] + 3) % 3;
  return image;
}

int image_after(int image, const Eigen::Vector3i& crossed) {
  Eigen::Vector3i periods = crossed;
  for (int c = 0; c < 3; ++c, image /= 3) periods[c] += image % 3;
  return image_of(periods.unaryExpr([](int n) { return n % 3; }));
}

struct SolidContacts::World {
  const Parts& parts;
  std::span<const Body> bodies;
  std::span<const Wall> walls;
  const Materials& materials;
  std::span<const Vec3> velocity, spin;

  bool is_away(const SolidPair& p) const {
    return p.gap > 0 && (parts.row(p.a.index).centre() - p.listed_at).squaredNorm() < p.gap * p.gap;
  }
  const Surface& surface(const SolidPair& p) const {
    return *walls[static_cast<std::size_t>(p.b.index)].surface;
  }
  Side side_of_body(int body, const Vec3& point) const {
    const std::size_t n = static_cast<std::size_t>(body);
    return {bodies[n].material, inverse_mass(bodies[n]),
            velocity[n] + spin[n].cross(point - bodies[n].position), spin[n]};
  }
  Side side_of_ball(int ball, const Vec3& point) const {
    const BallRow& row = parts.row(ball);
    return {static_cast<int>(row.material), row.inverse_mass,
            row.velocity() + row.spin().cross(point - row.centre()), row.spin()};
  }
  Meeting meet(const SolidPair& pair) const {
    const Touch& t = pair.touch;
    Meeting m;
    m.a = pair.a.kind == PartKind::ball ? side_of_ball(pair.a.index, t.point)
                                        : side_of_body(pair.body_a, t.point);
    if (pair.body_b >= 0) {
      m.b = side_of_body(pair.body_b, t.point - pair.shift);
    } else {
      const Wall& wall = walls[static_cast<std::size_t>(pair.b.index)];
      m.b = {wall.material, 0.0, wall.velocity, Vec3(0, 0, 0)};
    }
    m.contact = {triple(t.normal), t.overlap, t.radius, 1.0 / (m.a.inverse_mass + m.b.inverse_mass),
                 triple(m.a.velocity - m.b.velocity)};
    const PairConstants<double>& p = constants(m);
    m.spring = with_law(materials.law(), [&](auto law) { return law.spring(m.contact, p); });
    return m;
  }
  const PairConstants<double>& constants(const Meeting& m) const {
    return materials.pair(m.a.material, m.b.material);
  }
};

void SolidContacts::set_pairs(std::vector<SolidPair>& pairs, std::span<const char> fresh) {
  std::size_t old = 0;
  const auto key = [](const SolidPair& p) { return std::pair(p.a, p.b); };
  const auto is_fresh = [&](int body) { return body >= 0 && fresh[static_cast<std::size_t>(body)]; };
  for (SolidPair& p : pairs) {
    if (is_fresh(p.body_a) || is_fresh(p.body_b)) continue;
    while (old < pairs_.size() && key(pairs_[old]) < key(p)) ++old;
    if (old < pairs_.size() && key(pairs_[old]) == key(p)) p.history = pairs_[old].history;
  }
  pairs_.swap(pairs);
  arrange();
}

void SolidContacts::hand_over(int ball, int wall, const Vec3& normal, const std::array<double, 6>& friction,
                              double energy) {
  const PartKey a{PartKind::ball, ball}, b{PartKind::wall_triangle, wall};
  const auto found =
      std::lower_bound(pairs_.begin(), pairs_.end(), std::pair(a, b),
                       [](const SolidPair& p, const auto& key) { return std::pair(p.a, p.b) < key; });
  if (found == pairs_.end() || found->a != a || found->b.kind != b.kind || found->b.index != wall) return;
  ContactHistory& h = found->history;
  if (h.touched()) return;
  h.normal = triple(normal);
  h.slip = {friction[0], friction[1], friction[2]};
  h.roll = {friction[3], friction[4], friction[5]};
  double stored = 0.0;  // with walls, by this body
  for (const SolidPair& p : pairs_)
    if (p.body_a == found->body_a && p.body_b < 0) stored = std::max(stored, p.history.energy);
  h.energy = stored + energy;
}

void SolidContacts::sort() {
  std::sort(pairs_.begin(), pairs_.end(), is_before);
  arrange();
}

void SolidContacts::arrange() {
  const int count = static_cast<int>(pairs_.size());
  const auto pair = [&](int n) -> const SolidPair& { return pairs_[static_cast<std::size_t>(n)]; };
  runs_.clear();
  for (int n = 0, end = 0; n < count; n = end) {
    end = n + 1;
    if (pair(n).a.kind != PartKind::ball) continue;
    while (end < count && same_surface(pair(n), pair(end))) ++end;
    if (end > n + 1) runs_.insert(runs_.end(), {n, end});
  }
  order_.resize(pairs_.size());
  std::iota(order_.begin(), order_.end(), 0);
  const auto bodies = [&](int n) { return std::pair(pair(n).body_a, pair(n).body_b); };
  std::sort(order_.begin(), order_.end(),
            [&](int n, int m) { return std::pair(bodies(n), n) < std::pair(bodies(m), m); });
  first_.clear();
  for (int n = 0; n < count; ++n)
    if (n == 0 ||
        bodies(order_[static_cast<std::size_t>(n)]) != bodies(order_[static_cast<std::size_t>(n - 1)]))
      first_.push_back(n);
  first_.push_back(count);
}

/// Which contacts of a ball with one surface count, however it is divided (all walls are one): those where
/// its distance is least in all directions along the surface. A rim is none where another part that has it is
/// nearer; and in a hollow flatter than that the ball's dents would stay apart, the deepest is the contact.
/// What the others remember of friction goes to the contact that takes their place.
void SolidContacts::choose(const World& world, int begin, int end) {
  const auto pair = [&](int n) -> SolidPair& { return pairs_[static_cast<std::size_t>(n)]; };
  const double radius = world.parts.row(pair(begin).a.index).radius;
  thread_local std::vector<int> deepest;
  deepest.clear();
  for (int n = begin; n < end; ++n)
    if (pair(n).touch.overlap > 0) deepest.push_back(n);
  if (deepest.empty()) return;
  std::sort(deepest.begin(), deepest.end(), [&](int n, int m) {
    return std::pair(-pair(n).touch.overlap, n) < std::pair(-pair(m).touch.overlap, m);
  });
  const auto on_rim_of = [&](const SolidPair& p, const SolidPair& q) {
    if (p.touch.on_face || !(q.touch.overlap > p.touch.overlap + 1e-9 * radius)) return false;
    const double slack = q.b.kind == PartKind::wall_triangle ? 2 * world.surface(q).tolerance() : 0.0;
    const Vec3 foot = p.touch.point + 0.5 * p.touch.overlap * p.touch.normal;
    return distance_to(q, foot, world.parts, world.bodies, world.walls) <= 1e-6 * radius + slack;
  };
  thread_local std::vector<int> chosen;
  chosen.clear();
  for (std::size_t n = 0; n < deepest.size(); ++n) {
    SolidPair& p = pair(deepest[n]);
    for (std::size_t m = 0; m < n && !p.hidden; ++m) {
      const Touch& q = pair(deepest[m]).touch;
      p.hidden = on_rim_of(p, pair(deepest[m]));
      if (p.hidden) p.touch.side = q.side;  // the surface goes on there, with the same sides
    }
    for (std::size_t m = 0; m < chosen.size() && !p.hidden; ++m)
      p.hidden = pair(chosen[m]).touch.normal.dot(p.touch.normal) > kSameHollow;
    if (!p.hidden) chosen.push_back(deepest[n]);
  }
  for (const int n : chosen) {
    SolidPair& p = pair(n);
    if (p.history.touched() || p.touch.ghost) continue;
    for (int m = begin; m < end; ++m) {
      ContactHistory& h = pair(m).history;
      if (!h.touched() || (pair(m).touch.overlap > 0 && !pair(m).hidden)) continue;
      if (!(vec(h.normal).dot(p.touch.normal) > kSameHollow)) continue;
      p.history.slip = h.slip;
      p.history.roll = h.roll;
      p.history.energy = h.energy;
      p.history.power = h.power;
      h = {};
      break;
    }
  }
}

/// The contacts of two bodies (all walls are one) give back no more than they took. What their springs have
/// stored is the work that was done on them, by the rule of trapezoids, whose error is (angular frequency x
/// dt)^2/3; velocities extrapolated to the whole step add half as much again. Where the springs are gradients
/// of an energy it is what the powers at both ends of the step allow. A spring of force F and thickness t
/// holds an energy of F t/2 (a face) to 3/4 F t (a corner), or just that of which it is the gradient. Where
/// the work does not suffice for that, all forces are less by one factor. So a contact that came about
/// without work, as that of a body that was born in another or slid over an edge, begins without force, and
/// then is as stiff as any. What is stored beyond the most is lost.
double SolidContacts::apply_laws(const World& world, int begin, int end, double dt) {
  const auto pair = [&](int n) -> SolidPair& {
    return pairs_[static_cast<std::size_t>(order_[static_cast<std::size_t>(n)])];
  };
  thread_local std::vector<Meeting> meetings;
  thread_local std::vector<SolidPair*> touching;
  meetings.clear();
  touching.clear();
  double stored = 0.0, power = 0.0;               // before
  double least = 0.0, most = 0.0, parting = 0.0;  // J, J, W
  double error = 0.0;                             // of the rule
  double stiffness = 0.0, damping = 0.0;          // of all together, over mass: 1/s2, 1/s
  bool whole = true;
  for (int n = begin; n < end; ++n) {
    SolidPair& p = pair(n);
    if (p.away) continue;
    if (p.history.energy > stored) {
      stored = p.history.energy;
      power = p.history.power;
    }
    p.force.setZero();
    p.moment.setZero();
    p.stored = p.elastic = p.wall_power = 0.0;
    if (p.hidden || p.touch.ghost) p.touch.overlap = 0.0;
    if (!(p.touch.overlap > 0)) {
      p.history = {};
      p.history.side = p.touch.side;
      continue;
    }
    touching.push_back(&p);
    Meeting& m = meetings.emplace_back(world.meet(p));
    const Touch& t = p.touch;
    const double force = m.spring.secant * t.overlap;
    m.least = m.most = t.thickness > 0 ? force * t.depth : m.spring.energy;
    if (t.thickness > 0) {
      m.spring.stiffening = 0.0;
      // As wide as it is, in the ratio of the law: springs side by side, along the face as across it.
      const double drag = world.constants(m).drag;
      m.spring.tangential = drag * drag * force / t.thickness;
      if (!(t.depth > 0)) {
        m.least = kLeastDepth * force * t.thickness;
        m.most = kMostDepth * force * t.thickness;
      }
    }
    least += m.least;
    most += m.most;
    parting += force * dot(m.contact.velocity, m.contact.normal);
    const double square = (t.thickness > 0 ? force / t.thickness : 1.5 * m.spring.secant) / m.contact.mass;
    const bool gradient = !(t.thickness > 0) || p.b.kind == PartKind::wall_plane;
    whole = whole && gradient && p.history.touched() && p.history.dent == 1.0;
    error = std::max(error, square * dt * dt);
    stiffness += square;
  }
  if (!(least > 0)) return 0.0;
  // With the factor f: f^2 least = stored now = had - f half.
  const double slack = dt * (error * std::abs(power) + (whole ? 0.5 * std::abs(power + parting) : 0.0));
  const double had = std::max(0.0, stored + 0.5 * dt * power + slack), half = 0.5 * dt * parting;
  const double factor =
      std::clamp((std::sqrt(half * half + 4 * least * had) - half) / (2 * least), kLeastFactor, 1.0);
  const double now = std::clamp(had - factor * half, 0.0, most), over_least = now / least;
  for (std::size_t n = 0; n < touching.size(); ++n) {
    SolidPair& p = *touching[n];
    Meeting& m = meetings[n];
    p.history.dent = factor < 1 ? std::pow(factor, 1.0 / m.spring.sharpness) : 1.0;
    m.spring.secant *= factor;
    m.spring.energy =
        factor < 1 ? factor * factor * m.least : std::clamp(over_least * m.least, m.least, m.most);
    if (m.spring.energy > 0)  // of a dent of atoms it may be below the smallest number
      m.spring.sharpness = 0.5 * m.spring.secant * p.touch.overlap * p.touch.overlap / m.spring.energy;
    p.stored = m.spring.energy;
    p.history.energy = now;
    p.history.power = -factor * parting;
  }
  for (std::size_t n = 0; n < touching.size(); ++n) {
    SolidPair& p = *touching[n];
    double all = 0.0;
    for (const SolidPair* q : touching) all += q->stored * std::max(0.0, q->touch.normal.dot(p.touch.normal));
    Meeting& m = meetings[n];
    m.contact.share = all > 0 ? p.stored / all : 1.0;
    damping += dashpot_of(m.spring, m.contact, world.constants(m)) / m.contact.mass;
    apply_law(p, m, world.constants(m), world.materials.allow_tension(), dt);
  }
  return asked_rate_squared(kSeveral * stiffness, kSeveral * damping);
}

void SolidContacts::compute(const Parts& parts, std::span<const Body> bodies, std::span<const Wall> walls,
                            const Materials& materials, const Domain& domain, std::span<const Vec3> velocity,
                            std::span<const Vec3> spin, double dt) {
  const World world{parts, bodies, walls, materials, velocity, spin};
  for_each_block(static_cast<int>(pairs_.size()), kPairBlock, [&](int, int begin, int end) {
    for (int n = begin; n < end; ++n) {
      SolidPair& p = pairs_[static_cast<std::size_t>(n)];
      const bool away = world.is_away(p);
      if (away && p.away) continue;
      p.away = away && p.history == ContactHistory{};
      p.touch = away ? Touch{} : find_touch(p, parts, bodies, walls, domain);
      p.hidden = false;
    }
  });
  for_each_block(static_cast<int>(runs_.size()) / 2, kPairBlock, [&](int, int begin, int end) {
    for (int n = begin; n < end; ++n)
      choose(world, runs_[2 * static_cast<std::size_t>(n)], runs_[2 * static_cast<std::size_t>(n) + 1]);
  });
  asked_.assign(first_.size() - 1, 0.0);
  for_each_block(static_cast<int>(first_.size()) - 1, kPairBlock, [&](int, int begin, int end) {
    for (int n = begin; n < end; ++n)
      asked_[static_cast<std::size_t>(n)] =
          apply_laws(world, first_[static_cast<std::size_t>(n)], first_[static_cast<std::size_t>(n) + 1], dt);
  });
  asked_rate_ = 0.0;
  for (const double asked : asked_) asked_rate_ = std::max(asked_rate_, asked);
  asked_rate_ = std::sqrt(asked_rate_);
}

double SolidContacts::elastic() const {
  return std::accumulate(pairs_.begin(), pairs_.end(), 0.0,
                         [](double s, const SolidPair& p) { return s + p.elastic; });
}

double SolidContacts::wall_power() const {
  return std::accumulate(pairs_.begin(), pairs_.end(), 0.0,
                         [](double s, const SolidPair& p) { return s + p.wall_power; });
}

void SolidContacts::save(std::vector<double>& out) const {
  out.push_back(static_cast<double>(pairs_.size()));
  for (const SolidPair& p : pairs_) {
    for (const PartKey& k : {p.a, p.b})
      for (const int v : {static_cast<int>(k.kind), k.index, k.solid, k.image}) out.push_back(v);
    const ContactHistory& h = p.history;
    for (const int v : {p.body_a, p.body_b, h.side, h.face}) out.push_back(v);
    for (const Triple<double>& v : {h.slip, h.roll, h.normal, h.lean}) out.insert(out.end(), {v.x, v.y, v.z});
    out.insert(out.end(), {h.twist.angle, h.twist.stiffness, h.energy, h.power, h.dent});
    for (const Vec3& v : {p.shift, p.listed_at}) out.insert(out.end(), {v.x(), v.y(), v.z()});
    out.insert(out.end(), {p.gap, p.away ? 1.0 : 0.0});
  }
}

void SolidContacts::load(StateReader& in, int bodies) {
  constexpr int any = std::numeric_limits<int>::max();
  pairs_.assign(in.count(37), {});
  for (SolidPair& p : pairs_) {
    for (PartKey* k : {&p.a, &p.b}) {
      k->kind = static_cast<PartKind>(in.whole(0, static_cast<int>(PartKind::wall_triangle)));
      for (int* v : {&k->index, &k->solid, &k->image}) *v = in.whole(0, any);
    }
    p.body_a = in.whole(0, bodies - 1);
    p.body_b = in.whole(-1, bodies - 1);
    ContactHistory& h = p.history;
    h.side = in.whole(-1, 1);
    h.face = in.whole(-1, any);
    for (Triple<double>* v : {&h.slip, &h.roll, &h.normal, &h.lean})
      for (double* c : {&v->x, &v->y, &v->z}) *c = in.number();
    for (double* v : {&h.twist.angle, &h.twist.stiffness, &h.energy, &h.power, &h.dent}) *v = in.number();
    for (Vec3* v : {&p.shift, &p.listed_at}) *v = in.vec3();
    p.gap = in.number();
    p.away = in.whole(0, 1) == 1;
  }
  arrange();
}

}  // namespace ejecta
