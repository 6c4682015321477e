#include <algorithm>
#include <cmath>

#include "dem/blocks.hpp"
#include "dem/particles.hpp"

/// Particles: bodies that enter, leave, and come back on the other side of a periodic direction.
namespace ejecta {
namespace {

/// Bodies that are due but find no place keep those after them waiting only so long: looks in one call.
constexpr int kLooks = 16;
constexpr int kPresenceBlock = 1024;  // bodies

}  // namespace

Domain make_domain(const DomainSpec& spec) {
  Domain d;
  const std::vector<double>* extents[] = {&spec.x, &spec.y, &spec.z};
  for (int c = 0; c < 3; ++c) {
    if (extents[c]->size() != 2) continue;
    d.low[c] = extents[c]->front();
    d.high[c] = extents[c]->back();
    if (std::find(spec.periodic.begin(), spec.periodic.end(), std::string(1, "xyz"[c])) !=
        spec.periodic.end())
      d.period[c] = d.high[c] - d.low[c];
  }
  return d;
}

double Particles::mechanical_energy(std::size_t n) const {
  const Body& b = bodies_[n];
  return b.kinetic_energy() - (b.motion == Motion::free ? b.mass * gravity_.dot(b.position) : 0.0);
}

bool Particles::place_is_free(std::size_t n) const {
  const Body& b = bodies_[n];
  const double radius = b.shape.bounding_radius();
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (presence_[k] != Presence::here) continue;
    const double apart = radius + bodies_[k].shape.bounding_radius();
    if (domain_.nearest(bodies_[k].position - b.position).squaredNorm() < apart * apart) return false;
  }
  return !(deepest_in_walls(n).overlap > 0);
}

void Particles::show(std::size_t n, Presence presence) {
  presence_[n] = presence;
  parts_.set_here(static_cast<int>(n), presence == Presence::here);
  fresh_[n] = true;
  force_[n].setZero();
  torque_[n].setZero();
  relist_ = true;
}

bool Particles::inside(const Body& b) const {
  return (b.position.array() >= domain_.low.array()).all() &&
         (b.position.array() < domain_.high.array()).all();
}

/// Most bodies stay where they are: those who may come or go are looked for by all threads.
void Particles::enter_and_leave() {
  const int count = static_cast<int>(bodies_.size());
  changes_.assign(static_cast<std::size_t>(block_count(count, kPresenceBlock)), false);
  for_each_block(count, kPresenceBlock, [&](int block, int begin, int end) {
    for (std::size_t n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
      if (presence_[n] == Presence::waiting || (presence_[n] == Presence::here && !inside(bodies_[n])))
        changes_[static_cast<std::size_t>(block)] = true;
  });
  int looks = 0;
  crossed_.clear();
  for (int block = 0; block < static_cast<int>(changes_.size()); ++block)
    if (changes_[static_cast<std::size_t>(block)])
      enter_and_leave(block * kPresenceBlock, std::min((block + 1) * kPresenceBlock, count), looks);
  if (crossed_.empty()) return;
  solids_.follow([&](int body) {
    const auto found = crossed_.find(body);
    return found == crossed_.end() ? Eigen::Vector3i(0, 0, 0) : found->second;
  });
}

/// What a body brings or takes away in energy is work from outside, so that the ledger stays closed.
void Particles::enter_and_leave(int begin, int end, int& looks) {
  for (std::size_t n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
    Body& b = bodies_[n];
    if (presence_[n] == Presence::waiting) {
      if (time_ < *b.enters_at * (1 - 1e-12) || looks == kLooks) continue;
      if (!place_is_free(n)) {
        ++looks;
        continue;
      }
      show(n, Presence::here);
      if (moves(n)) release(n);
      parts_.update(static_cast<int>(n), b, b.velocity, b.angular_velocity);
      outer_work_ += mechanical_energy(n);
      continue;
    }
    if (presence_[n] == Presence::gone) continue;
    if (inside(b)) continue;
    const double before = mechanical_energy(n);
    bool out = false;
    Eigen::Vector3i crossed(0, 0, 0);
    for (int c = 0; c < 3; ++c) {
      if (b.position[c] >= domain_.low[c] && b.position[c] < domain_.high[c]) continue;
      if (domain_.period[c] > 0) {
        const double periods = std::floor((b.position[c] - domain_.low[c]) / domain_.period[c]);
        b.position[c] -= domain_.period[c] * periods;
        crossed[c] = periods > 0 ? 1 : -1;
      } else {
        out = true;
      }
    }
    if (out) {
      show(n, Presence::gone);
      outer_work_ -= before;
    } else if (!crossed.isZero()) {
      parts_.update(static_cast<int>(n), b, b.velocity, b.angular_velocity);
      outer_work_ += mechanical_energy(n) - before;
      crossed_[static_cast<int>(n)] = crossed;
      relist_ = true;
    }
  }
}

}  // namespace ejecta
