#include "dem/ball_contacts.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "dem/blocks.hpp"
#include "dem/lanes.hpp"

namespace ejecta {
namespace {

constexpr int kAhead = 8;         // groups of pairs whose geometry is known before their forces are computed
constexpr int kGroupBlock = 128;  // groups of eight pairs one thread takes at a time; sums are kept by block

/// Lanes at any address.
using LooseLanes = double __attribute__((vector_size(kLanes * sizeof(double)), aligned(8), may_alias));
using Index = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

/// Eight rows of eight numbers to eight columns.
EJECTA_INLINE void transpose_lanes(Lanes r[8]) {
  constexpr Index low1{0, 8, 2, 10, 4, 12, 6, 14}, high1{1, 9, 3, 11, 5, 13, 7, 15};
  constexpr Index low2{0, 1, 8, 9, 4, 5, 12, 13}, high2{2, 3, 10, 11, 6, 7, 14, 15};
  constexpr Index low4{0, 1, 2, 3, 8, 9, 10, 11}, high4{4, 5, 6, 7, 12, 13, 14, 15};
  Lanes s[8], t[8];
  for (int n = 0; n < 8; n += 2) {
    s[n] = __builtin_shuffle(r[n], r[n + 1], low1);
    s[n + 1] = __builtin_shuffle(r[n], r[n + 1], high1);
  }
  for (int n = 0; n < 8; n += 4)
    for (int k = 0; k < 2; ++k) {
      t[n + k] = __builtin_shuffle(s[n + k], s[n + k + 2], low2);
      t[n + k + 2] = __builtin_shuffle(s[n + k], s[n + k + 2], high2);
    }
  for (int n = 0; n < 4; ++n) {
    r[n] = __builtin_shuffle(t[n], t[n + 4], low4);
    r[n + 4] = __builtin_shuffle(t[n], t[n + 4], high4);
  }
}

struct BallLanes {
  Triple<Lanes> centre, velocity, spin;
  Lanes radius, inverse_mass;
};

/// Four numbers of each of eight rows, as four columns.
EJECTA_INLINE void load_columns(const BallRow* rows, const int* index, int from, Lanes out[4]) {
  constexpr Index low1{0, 8, 2, 10, 4, 12, 6, 14}, high1{1, 9, 3, 11, 5, 13, 7, 15};
  constexpr Index low2{0, 1, 8, 9, 4, 5, 12, 13}, high2{2, 3, 10, 11, 6, 7, 14, 15};
  Lanes r[4];
  for (int n = 0; n < 4; ++n) {
    const Vec4 lower = *reinterpret_cast<const LooseVec4*>(&rows[index[n]].x + from);
    const Vec4 upper = *reinterpret_cast<const LooseVec4*>(&rows[index[n + 4]].x + from);
    r[n] = __builtin_shufflevector(lower, upper, 0, 1, 2, 3, 4, 5, 6, 7);
  }
  const Lanes s0 = __builtin_shuffle(r[0], r[1], low1), s1 = __builtin_shuffle(r[0], r[1], high1);
  const Lanes s2 = __builtin_shuffle(r[2], r[3], low1), s3 = __builtin_shuffle(r[2], r[3], high1);
  out[0] = __builtin_shuffle(s0, s2, low2);
  out[1] = __builtin_shuffle(s1, s3, low2);
  out[2] = __builtin_shuffle(s0, s2, high2);
  out[3] = __builtin_shuffle(s1, s3, high2);
}

EJECTA_INLINE BallLanes load_balls(const BallRow* rows, const int* index) {
  Lanes place[4], velocity[4], spin[4];
  load_columns(rows, index, 0, place);
  load_columns(rows, index, 4, velocity);
  load_columns(rows, index, 8, spin);
  return {{place[0], place[1], place[2]},
          {velocity[0], velocity[1], velocity[2]},
          {spin[0], spin[1], spin[2]},
          place[3],
          velocity[3]};
}

PairConstants<Lanes> load_constants(const Materials& materials, const BallRow* balls, const BallRow* others,
                                    const int* a, const int* b) {
  PairConstants<Lanes> p;
  for (int n = 0; n < kLanes; ++n) {
    const PairConstants<double>& c =
        materials.pair(static_cast<int>(balls[a[n]].material), static_cast<int>(others[b[n]].material));
    p.youngs[n] = c.youngs;
    p.shear[n] = c.shear;
    p.stiffness[n] = c.stiffness;
    p.damping[n] = c.damping;
    p.drag[n] = c.drag;
    p.friction[n] = c.friction;
    p.rolling[n] = c.rolling;
  }
  return p;
}

EJECTA_INLINE Triple<Lanes> select(const Index& mask, const Triple<Lanes>& v) {
  const Lanes zero{};
  return {mask ? v.x : zero, mask ? v.y : zero, mask ? v.z : zero};
}

LooseLanes& lanes_at(std::vector<double>& v, std::size_t n) {
  return *reinterpret_cast<LooseLanes*>(v.data() + n);
}

EJECTA_INLINE Triple<Lanes> load3(std::vector<double>* v, std::size_t n) {
  return {lanes_at(v[0], n), lanes_at(v[1], n), lanes_at(v[2], n)};
}

EJECTA_INLINE void store3(std::vector<double>* v, std::size_t n, const Triple<Lanes>& t) {
  lanes_at(v[0], n) = t.x;
  lanes_at(v[1], n) = t.y;
  lanes_at(v[2], n) = t.z;
}

EJECTA_INLINE bool none(Index mask) {
  mask |= __builtin_shuffle(mask, Index{4, 5, 6, 7, 0, 1, 2, 3});
  mask |= __builtin_shuffle(mask, Index{2, 3, 0, 1, 6, 7, 4, 5});
  return (mask[0] | mask[1]) == 0;
}

/// A distance to the nearest image; a period of 0 leaves it as it is.
EJECTA_INLINE Lanes nearest(const Lanes& d, double period) {
  if (!(period > 0)) return d;
  constexpr double to_whole = 6755399441055744.0;  // 1.5 x 2^52: adding it rounds
  const Lanes whole = (d / period + to_whole) - to_whole;
  return d - period * whole;
}

}  // namespace

template <class Law, bool Rolling, bool Planes>
void BallContacts::compute_groups(const Parts& parts, const Materials& materials, const Domain& domain,
                                  double dt) {
  const BallRow *balls = parts.rows().data(), *others = Planes ? planes_.data() : balls;
  const std::size_t from = Planes ? at(planes_from_) : 0, to = Planes ? a_.size() : at(planes_from_);
  const int groups = static_cast<int>((to - from) / kLanes);
  const bool one_material = materials.count() == 1, allow_tension = materials.allow_tension();
  const bool periodic = domain.periodic(), births = births_;
  constexpr int same[kLanes] = {};
  const BallRow any;
  PairConstants<Lanes> constants;
  if (one_material) constants = load_constants(materials, &any, &any, same, same);

  // Where and how fast they touch, for a few groups, then the law: roots and divisions take long, and short
  // loops let the processor work on several groups at once.
  const auto meet = [&](std::size_t n) __attribute__((always_inline)) {
    const BallLanes a = load_balls(balls, a_.data() + n), b = load_balls(others, b_.data() + n);
    const auto dent = [&](const Lanes& overlap) __attribute__((always_inline)) {
      if (!births) return overlap;
      LooseLanes& born = lanes_at(history_[kBirth], n);
      born = larger(Lanes(born < overlap ? born : overlap), Lanes{});
      return Lanes(overlap - born);
    };
    Contact<Lanes> c;
    Triple<Lanes> arms;
    if constexpr (Planes) {
      c.normal = b.centre;
      c.overlap = dent(a.radius + b.radius - dot(b.centre, a.centre));
      c.radius = a.radius;
      c.mass = (Lanes{} + 1.0) / a.inverse_mass;
      arms = (a.radius - 0.5 * c.overlap) * a.spin;
    } else {
      Triple<Lanes> apart = a.centre - b.centre;
      if (periodic) {
        apart.x = nearest(apart.x, domain.period.x());
        apart.y = nearest(apart.y, domain.period.y());
        apart.z = nearest(apart.z, domain.period.z());
      }
      const Lanes distance = root(dot(apart, apart));
      const Lanes radii = a.radius + b.radius, masses = a.inverse_mass + b.inverse_mass;
      // Divisions take longest: one for three.
      const Lanes part = (Lanes{} + 1.0) / (radii * masses * distance), both = part * distance;
      c.normal = (part * radii * masses) * apart;
      c.overlap = dent(radii - distance);
      c.radius = a.radius * b.radius * masses * both;
      c.mass = radii * both;
      arms = (a.radius - 0.5 * c.overlap) * a.spin + (b.radius - 0.5 * c.overlap) * b.spin;
    }
    c.share = lanes_at(shares_, n);
    // Velocity at the contact point: arms are -arm_a n from a and +arm_b n from b.
    c.velocity = a.velocity - b.velocity - cross(arms, c.normal);
    return c;
  };
  const auto push = [&](std::size_t n, const Contact<Lanes>& c) __attribute__((always_inline)) {
    const Index touching = c.overlap > Lanes{};
    Lanes out[8] = {};
    if (none(touching)) {
      store3(history_, n, {});
      if constexpr (Rolling) store3(history_ + 3, n, {});
      if constexpr (Rolling) store3(moments_, n, {});
    } else {
      const PairConstants<Lanes> p =
          one_material ? constants : load_constants(materials, balls, others, a_.data() + n, b_.data() + n);
      Triple<Lanes> slip = load3(history_, n);
      const ContactForce<Lanes> f = contact_force<Law>(c, p, allow_tension, dt, slip);
      store3(history_, n, select(touching, slip));
      const Triple<Lanes> force = select(touching, f.force), turning = cross(c.normal, force);
      if constexpr (Rolling) {
        const BallLanes a = load_balls(balls, a_.data() + n), b = load_balls(others, b_.data() + n);
        Triple<Lanes> roll = load3(history_ + 3, n);
        const Triple<Lanes> moment = select(touching, rolling_moment(c, p, f, a.spin - b.spin, dt, roll));
        store3(history_ + 3, n, select(touching, roll));
        store3(moments_, n, moment);
      }
      const Lanes zero{};
      out[0] = force.x;
      out[1] = force.y;
      out[2] = force.z;
      out[3] = touching ? 0.5 * c.overlap : zero;
      out[4] = touching ? turning.x : zero;
      out[5] = touching ? turning.y : zero;
      out[6] = touching ? turning.z : zero;
      out[7] = touching ? f.elastic_normal + f.elastic_tangential : zero;
      transpose_lanes(out);
    }
    for (int k = 0; k < kLanes; ++k) *reinterpret_cast<LooseLanes*>(&rows_[n + at(k)].fx) = out[k];
  };
  for_each_block(groups, kGroupBlock, [&](int, int begin, int end) {
    Contact<Lanes> c[kAhead];
    for (int first = begin; first < end; first += kAhead) {
      const int count = std::min(kAhead, end - first);
      for (int g = 0; g < count; ++g) c[g] = meet(from + at(first + g) * kLanes);
      for (int g = 0; g < count; ++g) push(from + at(first + g) * kLanes, c[g]);
    }
  });
}

template <class Law, bool Rolling>
void BallContacts::compute_all(const Parts& parts, const Materials& materials, const Domain& domain,
                               double dt) {
  compute_groups<Law, Rolling, false>(parts, materials, domain, dt);
  compute_groups<Law, Rolling, true>(parts, materials, domain, dt);
}

void BallContacts::compute(const Parts& parts, const Materials& materials, const Domain& domain, double dt) {
  rolling_ = materials.any_rolling();
  share_energy(parts, materials, domain);
  with_law(materials.law(), [&](auto law) {
    using Law = decltype(law);
    if (rolling_) compute_all<Law, true>(parts, materials, domain, dt);
    else compute_all<Law, false>(parts, materials, domain, dt);
  });
}

/// What a group stores against the motion along the normal of each of its contacts, and how much of it is not
/// in this one.
void BallContacts::share_energy(const Parts& parts, const Materials& materials, const Domain& domain) {
  struct Spring {
    int pair;
    Vec3 normal;
    double energy;
  };
  const auto spring_of = [&](int n) -> Spring {
    const Nearing near = nearing(n, parts, domain);
    const BallRow& a = parts.row(a_[at(n)]);
    Contact<double> c;
    c.overlap = near.overlap - std::min(near.overlap, history_[kBirth][at(n)]);
    if (!(c.overlap > 0)) return {n, near.normal, 0.0};
    const bool plane = n >= planes_from_;
    const BallRow& b = plane ? planes_[at(b_[at(n)])] : parts.row(b_[at(n)]);
    c.radius = plane ? a.radius : a.radius * b.radius / (a.radius + b.radius);
    const PairConstants<double>& p =
        materials.pair(static_cast<int>(a.material), static_cast<int>(b.material));
    return {n, near.normal, with_law(materials.law(), [&](auto law) { return law.spring(c, p).energy; })};
  };
  for_each_block(static_cast<int>(groups_.size()) - 1, kGroupBlock, [&](int, int begin, int end) {
    thread_local std::vector<Spring> touching;  // of one group: few of those that are near
    for (int g = begin; g < end; ++g) {
      touching.clear();
      for (int i = groups_[at(g)]; i < groups_[at(g + 1)]; ++i) {
        const int n = grouped_[at(i)];
        shares_[at(n)] = 1.0;
        if (const Spring s = spring_of(n); s.energy > 0) touching.push_back(s);
      }
      for (const Spring& own : touching) {
        double all = 0.0;
        for (const Spring& s : touching) all += s.energy * std::max(0.0, s.normal.dot(own.normal));
        shares_[at(own.pair)] = own.energy / all;
      }
    }
  });
}

double BallContacts::wall_power() const {
  double power = 0.0;
  for (std::size_t n = at(planes_from_); n < a_.size(); ++n) {
    const BallRow& wall = planes_[at(b_[n])];
    power += rows_[n].fx * wall.vx + rows_[n].fy * wall.vy + rows_[n].fz * wall.vz;
  }
  return power;
}

double BallContacts::elastic() const {
  return std::accumulate(rows_.begin(), rows_.end(), 0.0,
                         [](double sum, const PairRow& r) { return sum + r.elastic; });
}

}  // namespace ejecta
