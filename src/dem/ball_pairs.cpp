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
BallRow plane_row(const Wall& wall) {
  BallRow row;
  row.x = wall.normal.x(), row.y = wall.normal.y(), row.z = wall.normal.z();
  row.radius = wall.offset;
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

void BallContacts::set_pairs(Pairs balls, Pairs planes, std::span<const Wall> walls, int ball_count) {
  planes_.clear();
  for (const Wall& wall : walls) planes_.push_back(plane_row(wall));
  planes_.emplace_back().radius = -1e300;
  arrange(balls, planes, ball_count);
}

void BallContacts::arrange(Pairs balls, Pairs planes, int ball_count) {
  last_a_.swap(a_);
  last_b_.swap(b_);
  for (int k = 0; k < 6; ++k) last_history_[k].swap(history_[k]);
  const std::size_t last_planes_from = at(planes_from_);
  planes_from_ = static_cast<int>(padded(balls.size()));
  const std::size_t total = at(planes_from_) + padded(planes.size());
  refill(a_, total, ball_count);
  refill(b_, total, static_cast<int>(planes_.size()) - 1);
  std::fill_n(b_.begin(), planes_from_, ball_count);
  for (auto& h : history_) refill(h, total, 0.0);
  const auto put = [&](Pairs pairs, std::size_t from, std::size_t old, std::size_t old_end) {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      std::tie(a_[from + n], b_[from + n]) = pairs[n];
      while (old < old_end && std::pair(last_a_[old], last_b_[old]) < pairs[n]) ++old;
      if (old < old_end && std::pair(last_a_[old], last_b_[old]) == pairs[n])
        for (int k = 0; k < 6; ++k) history_[k][from + n] = last_history_[k][old];
    }
  };
  put(balls, 0, 0, last_planes_from);
  put(planes, at(planes_from_), last_planes_from, last_a_.size());
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

void BallContacts::save(std::vector<double>& out) const {
  for (const bool plane : {false, true}) {
    const std::size_t head = out.size();
    out.push_back(0);
    for (std::size_t n = plane ? at(planes_from_) : 0; n < (plane ? a_.size() : at(planes_from_)); ++n) {
      if (std::all_of(history_, history_ + 6, [&](const auto& h) { return h[n] == 0.0; })) continue;
      out[head] += 1;
      out.push_back(a_[n]);
      out.push_back(b_[n]);
      for (const auto& h : history_) out.push_back(h[n]);
    }
  }
}

void BallContacts::load(StateReader& in, int balls) {
  constexpr std::size_t remembered = std::size(decltype(history_){});
  std::vector<std::pair<int, int>> pairs[2];
  std::vector<std::span<const double>> histories[2];
  for (int k = 0; k < 2; ++k) {
    pairs[k].resize(in.count(2 + remembered));
    for (auto& [a, b] : pairs[k]) {
      a = in.whole(0, balls - 1);
      b = in.whole(0, k == 0 ? balls - 1 : std::numeric_limits<int>::max());
      histories[k].push_back(in.numbers(remembered));
    }
  }
  arrange(pairs[0], pairs[1], balls);
  for (int k = 0; k < 2; ++k)
    for (std::size_t n = 0; n < pairs[k].size(); ++n)
      for (std::size_t h = 0; h < 6; ++h)
        history_[h][n + (k == 0 ? 0 : at(planes_from_))] = histories[k][n][h];
}

}  // namespace ejecta
