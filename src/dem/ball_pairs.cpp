#include <algorithm>
#include <limits>
#include <tuple>

#include "dem/ball_contacts.hpp"
#include "dem/lanes.hpp"

/// BallContacts: which pairs there are, and what is remembered of them.
namespace ejecta {
namespace {

std::size_t padded(std::size_t pairs) { return (pairs + kLanes - 1) / kLanes * kLanes; }

/// count times value. assign() takes just the memory it needs: a list whose length wavers would ask for more
/// at every new high, so there is room for half as many again.
template <class T>
void refill(std::vector<T>& v, std::size_t count, const T& value) {
  if (count > v.capacity()) {
    v.clear();
    v.reserve(count + count / 2);
  }
  v.assign(count, value);
}

/// A plane as the lanes read it: the normal for the centre, the offset for the radius.
BallRow plane_row(const WallPlane& plane, const Wall& wall) {
  BallRow row;
  row.x = plane.normal.x(), row.y = plane.normal.y(), row.z = plane.normal.z();
  row.radius = plane.offset;
  row.vx = wall.velocity.x(), row.vy = wall.velocity.y(), row.vz = wall.velocity.z();
  row.material = wall.material;
  return row;
}

}  // namespace

void BallContacts::index_pairs(int balls) {
  first_.assign(at(balls) + 2, 0);
  for (int n = 0; n < pair_count(); ++n) {
    ++first_[at(a_[at(n)]) + 1];
    if (n < planes_from_) ++first_[at(b_[at(n)]) + 1];
  }
  for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
  entries_.resize(at(first_.back()));
  cursor_.assign(first_.begin(), first_.end());
  for (int n = 0; n < pair_count(); ++n) {
    entries_[at(cursor_[at(a_[at(n)])]++)] = 2 * n;
    if (n < planes_from_) entries_[at(cursor_[at(b_[at(n)])]++)] = 2 * n + 1;
  }
  refill(rows_, a_.size(), PairRow{});
  for (auto& m : moments_) refill(m, a_.size(), 0.0);
}

BallRow BallContacts::untouched() {
  BallRow row;
  row.radius = -1e300;
  return row;
}

void BallContacts::add(const WallPlane& plane, const Wall& wall) {
  planes_.back() = plane_row(plane, wall);
  planes_.push_back(untouched());
}

void BallContacts::set_pairs(Pairs balls, Pairs planes, const Parts& parts) {
  arrange(balls, planes, parts.ball_count());
  group_pairs(parts);
}

BallContacts::Nearing BallContacts::nearing(int n, const Parts& parts, const Domain& domain) const {
  const BallRow& a = parts.row(a_[at(n)]);
  if (n >= planes_from_) {
    const BallRow& plane = planes_[at(b_[at(n)])];
    const Vec3 normal = plane.centre();
    return {normal, a.radius + plane.radius - normal.dot(a.centre()),
            normal.dot(plane.velocity() - a.velocity())};
  }
  const BallRow& b = parts.row(b_[at(n)]);
  const Vec3 apart = domain.nearest(a.centre() - b.centre()), normal = apart.normalized();
  return {normal, a.radius + b.radius - apart.norm(), normal.dot(b.velocity() - a.velocity())};
}

void BallContacts::note_births(std::span<const char> fresh, const Parts& parts, const Domain& domain,
                               double dt) {
  const auto is_fresh = [&](int ball) { return fresh[at(parts.body_of_ball(ball))] != 0; };
  for (int n = 0; n < pair_count(); ++n) {
    if (a_[at(n)] == parts.ball_count()) continue;
    if (!is_fresh(a_[at(n)]) && (n >= planes_from_ || !is_fresh(b_[at(n)]))) continue;
    const Nearing near = nearing(n, parts, domain);
    history_[kBirth][at(n)] = std::max(0.0, near.overlap - dt * std::max(0.0, near.speed));
  }
  find_births();
}

void BallContacts::set_dent(int n, double part, const Parts& parts, const Domain& domain) {
  history_[kBirth][at(n)] = (1 - part) * std::max(0.0, nearing(n, parts, domain).overlap);
  find_births();
}

void BallContacts::find_births() {
  const auto& born = history_[kBirth];
  births_ = std::any_of(born.begin(), born.end(), [](double m) { return m > 0; });
}

/// Only bodies of several balls and balls near several planes have groups of more than one.
void BallContacts::group_pairs(const Parts& parts) {
  grouped_.clear();
  groups_.assign(1, 0);
  const auto near_another_plane = [&](int n) {  // planes of a ball stand side by side
    return (n > planes_from_ && a_[at(n - 1)] == a_[at(n)]) ||
           (n + 1 < pair_count() && a_[at(n + 1)] == a_[at(n)]);
  };
  bool corners = false;
  for (int n = planes_from_; n < pair_count() && !corners; ++n)
    corners = a_[at(n)] < parts.ball_count() && near_another_plane(n);
  if (!corners && !parts.any_of_several_balls()) return;
  const auto bodies = [&](int n) {
    const int a = parts.body_of_ball(a_[at(n)]);
    if (n >= planes_from_) return std::pair(a, -1);
    return std::pair(a, parts.body_of_ball(b_[at(n)]));
  };
  const auto alone = [&](int n) {
    const auto [a, b] = bodies(n);
    return parts.ball_count(a) == 1 && (b < 0 ? !near_another_plane(n) : parts.ball_count(b) == 1);
  };
  for (int n = 0; n < pair_count(); ++n)
    if (a_[at(n)] < parts.ball_count() && !alone(n)) grouped_.push_back(n);
  std::sort(grouped_.begin(), grouped_.end(),
            [&](int n, int m) { return std::pair(bodies(n), n) < std::pair(bodies(m), m); });
  for (std::size_t n = 1; n <= grouped_.size(); ++n)
    if (n == grouped_.size() || bodies(grouped_[n]) != bodies(grouped_[n - 1]))
      groups_.push_back(static_cast<int>(n));
}

int BallContacts::touching(int ball, int plane) const {
  if (at(ball) + 1 >= first_.size()) return -1;
  for (int k = first_[at(ball)]; k < first_[at(ball) + 1]; ++k) {
    const int n = entries_[at(k)] >> 1;
    if (n >= planes_from_ && b_[at(n)] == plane && rows_[at(n)].half_overlap > 0) return n;
  }
  return -1;
}

int BallContacts::find_plane(int ball, int from, int to) const {
  for (int k = first_[at(ball)]; k < first_[at(ball) + 1]; ++k) {
    const int n = entries_[at(k)] >> 1;
    if (n >= planes_from_ && b_[at(n)] >= from && b_[at(n)] < to) return n;
  }
  return -1;
}

std::array<double, 6> BallContacts::friction(int n) const {
  std::array<double, 6> h;
  for (std::size_t k = 0; k < 6; ++k) h[k] = history_[k][at(n)];
  return h;
}

void BallContacts::set_friction(int n, const std::array<double, 6>& h) {
  for (std::size_t k = 0; k < 6; ++k) history_[k][at(n)] = h[k];
}

void BallContacts::arrange(Pairs balls, Pairs planes, int ball_count) {
  last_a_.swap(a_);
  last_b_.swap(b_);
  for (std::size_t k = 0; k < kRemembered; ++k) last_history_[k].swap(history_[k]);
  const std::size_t last_planes_from = at(planes_from_);
  planes_from_ = static_cast<int>(padded(balls.size()));
  const std::size_t total = at(planes_from_) + padded(planes.size());
  refill(a_, total, ball_count);
  refill(b_, total, static_cast<int>(planes_.size()) - 1);
  std::fill_n(b_.begin(), planes_from_, ball_count);
  for (auto& h : history_) refill(h, total, 0.0);
  refill(shares_, total, 1.0);
  const auto put = [&](Pairs pairs, std::size_t from, std::size_t old, std::size_t old_end) {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      std::tie(a_[from + n], b_[from + n]) = pairs[n];
      while (old < old_end && std::pair(last_a_[old], last_b_[old]) < pairs[n]) ++old;
      if (old < old_end && std::pair(last_a_[old], last_b_[old]) == pairs[n])
        for (std::size_t k = 0; k < kRemembered; ++k) history_[k][from + n] = last_history_[k][old];
    }
  };
  put(balls, 0, 0, last_planes_from);
  put(planes, at(planes_from_), last_planes_from, last_a_.size());
  grouped_.clear();
  groups_.assign(1, 0);
  find_births();
  index_pairs(ball_count);
}

void BallContacts::rename(std::span<const int> names, int balls) {
  std::vector<std::pair<int, int>> kept[2];
  const int nobody = static_cast<int>(names.size());
  for (int n = 0; n < pair_count(); ++n) {
    int &a = a_[at(n)], &b = b_[at(n)];
    const bool plane = n >= planes_from_;
    if (a == nobody) continue;
    a = names[at(a)];
    if (!plane) b = names[at(b)];
    if (a < 0 || b < 0) a = b = -1;  // sorts before what is looked for
    else kept[plane].emplace_back(a, b);
  }
  arrange(kept[0], kept[1], balls);
}

/// All pairs, as they were listed: whether a ball near a rim is before a plane or before triangles depends on
/// when.
void BallContacts::save(std::vector<double>& out) const {
  const int nobody = static_cast<int>(first_.size()) - 2;
  for (const bool plane : {false, true}) {
    const std::size_t head = out.size();
    out.push_back(0);
    for (std::size_t n = plane ? at(planes_from_) : 0; n < (plane ? a_.size() : at(planes_from_)); ++n) {
      if (a_[n] == nobody) continue;
      out[head] += 1;
      out.push_back(a_[n]);
      out.push_back(b_[n]);
      for (const auto& h : history_) out.push_back(h[n]);
      out.insert(out.end(), {rows_[n].half_overlap, rows_[n].elastic});
    }
  }
}

void BallContacts::load(StateReader& in, const Parts& parts) {
  const int balls = parts.ball_count();
  constexpr std::size_t kStored = kRemembered + 2;
  std::vector<std::pair<int, int>> pairs[2];
  std::vector<std::span<const double>> stored[2];
  for (int k = 0; k < 2; ++k) {
    pairs[k].resize(in.count(2 + kStored));
    for (auto& [a, b] : pairs[k]) {
      a = in.whole(0, balls - 1);
      b = in.whole(0, k == 0 ? balls - 1 : static_cast<int>(planes_.size()) - 2);
      stored[k].push_back(in.numbers(kStored));
    }
  }
  arrange(pairs[0], pairs[1], balls);
  for (int k = 0; k < 2; ++k)
    for (std::size_t n = 0; n < pairs[k].size(); ++n) {
      const std::size_t here = n + (k == 0 ? 0 : at(planes_from_));
      for (std::size_t h = 0; h < kRemembered; ++h) history_[h][here] = stored[k][n][h];
      rows_[here].half_overlap = stored[k][n][kRemembered];
      rows_[here].elastic = stored[k][n][kRemembered + 1];
    }
  find_births();
  group_pairs(parts);
}

}  // namespace ejecta
