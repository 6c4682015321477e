#include "dem/solid_contacts.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "dem/blocks.hpp"

namespace ejecta {
namespace {

constexpr int kBlock = 32;  // pairs one thread takes at a time

Triple<double> triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vec(const Triple<double>& t) { return {t.x, t.y, t.z}; }

/// Material and motion of one side of a contact.
struct Side {
  int material = 0;
  double inverse_mass = 0.0;
  Vec3 velocity{0, 0, 0}, spin{0, 0, 0};  // m/s at the contact point, rad/s
};

void apply_law(SolidPair& pair, const Side& a, const Side& b, const Materials& materials, double dt) {
  const Touch& t = pair.touch;
  const PairConstants<double>& p = materials.pair(a.material, b.material);
  Contact<double> c{triple(t.normal), t.overlap, t.radius, 1.0 / (a.inverse_mass + b.inverse_mass),
                    triple(a.velocity - b.velocity)};
  const bool tension = materials.allow_tension();
  ContactHistory& h = pair.history;
  const ContactForce<double> f = materials.law() == ContactLaw::linear
                                     ? contact_force<LinearSpring>(c, p, tension, dt, h.slip)
                                     : contact_force<HertzMindlin>(c, p, tension, dt, h.slip);
  const Vec3 spin = a.spin - b.spin;
  pair.force = vec(f.force);
  pair.moment = vec(patch_moment(t.patch_radius, c.normal, p, f, triple(spin), dt, h.twist));
  if (p.rolling > 0) {
    c.radius = t.size;
    pair.moment += vec(rolling_moment(c, p, f, triple(spin), dt, h.roll));
  }
  const double twisting = 0.25 * f.tangential_stiffness * t.patch_radius * t.patch_radius * h.twist * h.twist;
  pair.elastic = (t.depth > 0 ? f.spring * t.depth : f.elastic_normal) + f.elastic_tangential + twisting;
  pair.wall_power = pair.body_b < 0 ? pair.force.dot(b.velocity) : 0.0;
}

}  // namespace

void SolidContacts::set_pairs(std::vector<SolidPair>& pairs) {
  std::size_t old = 0;
  const auto key = [](const SolidPair& p) { return std::pair(p.a, p.b); };
  for (SolidPair& p : pairs) {
    while (old < pairs_.size() && key(pairs_[old]) < key(p)) ++old;
    if (old < pairs_.size() && key(pairs_[old]) == key(p)) p.history = pairs_[old].history;
  }
  pairs_.swap(pairs);
}

void SolidContacts::compute(const Parts& parts, std::span<const Body> bodies, std::span<const Wall> walls,
                            const Materials& materials, std::span<const Vec3> velocity,
                            std::span<const Vec3> spin, double dt) {
  const auto side_of = [&](int body, const Vec3& point) {
    const std::size_t n = static_cast<std::size_t>(body);
    return Side{bodies[n].material, inverse_mass(bodies[n]),
                velocity[n] + spin[n].cross(point - bodies[n].position), spin[n]};
  };
  const auto side_of_ball = [&](int ball, const Vec3& point) {
    const BallRow& row = parts.row(ball);
    return Side{static_cast<int>(row.material), row.inverse_mass,
                row.velocity() + row.spin().cross(point - row.centre()), row.spin()};
  };
  const auto compute_pair = [&](SolidPair& pair) {
    pair.touch = find_touch(pair, parts, bodies, walls);
    pair.force.setZero();
    pair.moment.setZero();
    pair.elastic = pair.wall_power = 0.0;
    if (!(pair.touch.overlap > 0)) {
      pair.history = {};
      return;
    }
    const Side a = pair.a.kind == PartKind::ball ? side_of_ball(pair.a.index, pair.touch.point)
                                                 : side_of(pair.body_a, pair.touch.point);
    if (pair.body_b >= 0) {
      apply_law(pair, a, side_of(pair.body_b, pair.touch.point - pair.shift), materials, dt);
    } else {
      const Wall& wall = walls[static_cast<std::size_t>(pair.b.index)];
      apply_law(pair, a, Side{wall.material, 0.0, wall.velocity, Vec3(0, 0, 0)}, materials, dt);
    }
  };
  for_each_block(static_cast<int>(pairs_.size()), kBlock, [&](int, int begin, int end) {
    for (int n = begin; n < end; ++n) compute_pair(pairs_[static_cast<std::size_t>(n)]);
  });
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
  const std::size_t head = out.size();
  out.push_back(0);
  for (const SolidPair& p : pairs_) {
    if (p.history == ContactHistory{}) continue;
    out[head] += 1;
    for (const PartKey& k : {p.a, p.b})
      for (const int v : {static_cast<int>(k.kind), k.index, k.solid}) out.push_back(v);
    out.push_back(p.body_a);
    out.push_back(p.body_b);
    const ContactHistory& h = p.history;
    out.insert(out.end(), {h.slip.x, h.slip.y, h.slip.z, h.roll.x, h.roll.y, h.roll.z, h.twist});
  }
}

void SolidContacts::load(StateReader& in, int bodies) {
  constexpr int any = std::numeric_limits<int>::max();
  pairs_.assign(in.count(15), {});
  for (SolidPair& p : pairs_) {
    for (PartKey* k : {&p.a, &p.b}) {
      k->kind = static_cast<PartKind>(in.whole(0, static_cast<int>(PartKind::wall_solid)));
      k->index = in.whole(0, any);
      k->solid = in.whole(0, any);
    }
    p.body_a = in.whole(0, bodies - 1);
    p.body_b = in.whole(-1, bodies - 1);
    ContactHistory& h = p.history;
    for (double* v : {&h.slip.x, &h.slip.y, &h.slip.z, &h.roll.x, &h.roll.y, &h.roll.z, &h.twist})
      *v = in.number();
  }
}

}  // namespace ejecta
