#include "dem/ball_contacts.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "dem/blocks.hpp"
#include "dem/lanes.hpp"

namespace ejecta {
namespace {

constexpr int kBlock = 128;  // groups of eight pairs one thread takes at a time; sums are kept by block

/// Lanes at any address.
using LooseLanes = double __attribute__((vector_size(kLanes * sizeof(double)), aligned(8), may_alias));
using Index = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

/// Eight rows of eight numbers to eight columns.
EJECTA_INLINE void transpose(Lanes r[8]) {
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
  Lanes radius, inverse_mass, material;
};

EJECTA_INLINE BallLanes load_balls(const BallRow* rows, const int* index) {
  Lanes first[8], second[8];
  for (int n = 0; n < 8; ++n) {
    const double* row = &rows[index[n]].x;
    first[n] = *reinterpret_cast<const LooseLanes*>(row);
    second[n] = *reinterpret_cast<const LooseLanes*>(row + 8);
  }
  transpose(first);
  transpose(second);
  return {{first[0], first[1], first[2]},
          {first[4], first[5], first[6]},
          {second[0], second[1], second[2]},
          first[3],
          first[7],
          second[4]};
}

PairConstants<Lanes> load_constants(const Materials& materials, const BallLanes& a, const BallLanes& b) {
  PairConstants<Lanes> p;
  for (int n = 0; n < kLanes; ++n) {
    const PairConstants<double>& c =
        materials.pair(static_cast<int>(a.material[n]), static_cast<int>(b.material[n]));
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

EJECTA_INLINE bool none(const Index& mask) {
  std::int64_t any = 0;
  for (int n = 0; n < kLanes; ++n) any |= mask[n];
  return any == 0;
}

}  // namespace

template <class Law, bool Rolling>
void BallContacts::compute_all(const Parts& parts, const Materials& materials, double dt) {
  const BallRow* balls = parts.rows().data();
  const int groups = static_cast<int>(a_.size()) / kLanes;
  const bool one_material = materials.count() == 1, allow_tension = materials.allow_tension();
  PairConstants<Lanes> constants;
  if (one_material) constants = load_constants(materials, BallLanes{}, BallLanes{});

  for_each_block(groups, kBlock, [&](int, int begin, int end) {
    for (int group = begin; group < end; ++group) {
      const std::size_t n = at(group) * kLanes;
      const BallLanes a = load_balls(balls, a_.data() + n), b = load_balls(balls, b_.data() + n);
      const Triple<Lanes> apart = a.centre - b.centre;
      const Lanes distance = root(dot(apart, apart));
      const Lanes overlap = a.radius + b.radius - distance;
      const Index touching = overlap > Lanes{};
      Lanes out[8] = {};
      if (none(touching)) {
        store3(history_, n, {});
        if constexpr (Rolling) store3(history_ + 3, n, {});
        if constexpr (Rolling) store3(moments_, n, {});
      } else {
        Contact<Lanes> c;
        c.normal = (Lanes{} + 1.0) / distance * apart;
        c.overlap = overlap;
        // Divisions take longest: one for both.
        const Lanes radii = a.radius + b.radius, masses = a.inverse_mass + b.inverse_mass;
        const Lanes both = (Lanes{} + 1.0) / (radii * masses);
        c.radius = a.radius * b.radius * masses * both;
        c.mass = radii * both;
        const Lanes arm_a = a.radius - 0.5 * overlap, arm_b = b.radius - 0.5 * overlap;
        // Velocity at the contact point: arms are -arm_a n from a and +arm_b n from b.
        c.velocity = a.velocity - b.velocity - cross(arm_a * a.spin + arm_b * b.spin, c.normal);
        const PairConstants<Lanes> p = one_material ? constants : load_constants(materials, a, b);
        Triple<Lanes> slip = load3(history_, n);
        const ContactForce<Lanes> f = contact_force<Law>(c, p, allow_tension, dt, slip);
        store3(history_, n, select(touching, slip));
        const Triple<Lanes> force = select(touching, f.force), turning = cross(c.normal, force);
        if constexpr (Rolling) {
          Triple<Lanes> roll = load3(history_ + 3, n);
          const Triple<Lanes> spin = a.spin - b.spin;
          const Triple<Lanes> moment = select(touching, rolling_moment(c, p, f, spin, dt, roll));
          store3(history_ + 3, n, select(touching, roll));
          store3(moments_, n, moment);
        }
        const Lanes zero{};
        out[0] = force.x;
        out[1] = force.y;
        out[2] = force.z;
        out[3] = touching ? 0.5 * overlap : zero;
        out[4] = touching ? turning.x : zero;
        out[5] = touching ? turning.y : zero;
        out[6] = touching ? turning.z : zero;
        out[7] = touching ? f.elastic_normal + f.elastic_tangential : zero;
        transpose(out);
      }
      for (int k = 0; k < kLanes; ++k) *reinterpret_cast<LooseLanes*>(&rows_[n + at(k)].fx) = out[k];
    }
  });
}

void BallContacts::compute(const Parts& parts, const Materials& materials, double dt) {
  rolling_ = materials.any_rolling();
  if (materials.law() == ContactLaw::linear)
    rolling_ ? compute_all<LinearSpring, true>(parts, materials, dt)
             : compute_all<LinearSpring, false>(parts, materials, dt);
  else
    rolling_ ? compute_all<HertzMindlin, true>(parts, materials, dt)
             : compute_all<HertzMindlin, false>(parts, materials, dt);
}

void BallContacts::index_pairs(int balls) {
  count_ = static_cast<int>(a_.size());
  const std::size_t padded = (a_.size() + kLanes - 1) / kLanes * kLanes;
  first_.assign(at(balls) + 2, 0);
  for (std::size_t n = 0; n < a_.size(); ++n)
    for (const int ball : {a_[n], b_[n]}) ++first_[at(ball) + 1];
  for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
  entries_.resize(2 * a_.size());
  cursor_.assign(first_.begin(), first_.end());
  for (std::size_t n = 0; n < a_.size(); ++n) {
    entries_[at(cursor_[at(a_[n])]++)] = static_cast<int>(2 * n);
    entries_[at(cursor_[at(b_[n])]++)] = static_cast<int>(2 * n + 1);
  }
  a_.resize(padded, balls);
  b_.resize(padded, balls);
  rows_.assign(padded, PairRow{});
  for (auto& m : moments_) m.assign(padded, 0.0);
}

void BallContacts::set_pairs(const std::vector<std::pair<int, int>>& pairs, int balls) {
  std::vector<int> a(pairs.size()), b(pairs.size());
  std::vector<double> history[6];
  const std::size_t padded = (pairs.size() + kLanes - 1) / kLanes * kLanes;
  for (auto& h : history) h.assign(padded, 0.0);
  std::size_t old = 0;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    a[n] = pairs[n].first;
    b[n] = pairs[n].second;
    while (old < at(count_) && std::pair(a_[old], b_[old]) < pairs[n]) ++old;
    if (old < at(count_) && std::pair(a_[old], b_[old]) == pairs[n])
      for (int k = 0; k < 6; ++k) history[k][n] = history_[k][old];
  }
  a_ = std::move(a);
  b_ = std::move(b);
  for (int k = 0; k < 6; ++k) history_[k] = std::move(history[k]);
  index_pairs(balls);
}

double BallContacts::elastic() const {
  return std::accumulate(rows_.begin(), rows_.end(), 0.0,
                         [](double sum, const PairRow& r) { return sum + r.elastic; });
}

void BallContacts::rename(std::span<const int> names, int balls) {
  std::size_t kept = 0;
  for (std::size_t n = 0; n < at(count_); ++n) {
    const int a = names[at(a_[n])], b = names[at(b_[n])];
    if (a < 0 || b < 0) continue;
    a_[kept] = a;
    b_[kept] = b;
    for (auto& h : history_) h[kept] = h[n];
    ++kept;
  }
  a_.resize(kept);
  b_.resize(kept);
  for (auto& h : history_) {
    h.resize(kept);
    h.resize((kept + kLanes - 1) / kLanes * kLanes, 0.0);
  }
  index_pairs(balls);
}

void BallContacts::save(std::vector<double>& out) const {
  const std::size_t head = out.size();
  out.push_back(0);
  for (std::size_t n = 0; n < at(count_); ++n) {
    if (std::all_of(history_, history_ + 6, [&](const auto& h) { return h[n] == 0.0; })) continue;
    out[head] += 1;
    out.push_back(a_[n]);
    out.push_back(b_[n]);
    for (const auto& h : history_) out.push_back(h[n]);
  }
}

const double* BallContacts::load(const double* in, int balls) {
  const int count = static_cast<int>(*in++);
  a_.clear();
  b_.clear();
  for (auto& h : history_) h.assign((at(count) + kLanes - 1) / kLanes * kLanes, 0.0);
  for (int n = 0; n < count; ++n) {
    a_.push_back(static_cast<int>(*in++));
    b_.push_back(static_cast<int>(*in++));
    for (auto& h : history_) h[at(n)] = *in++;
  }
  index_pairs(balls);
  return in;
}

}  // namespace ejecta
