#include "sorter/feeder_stream.hpp"

#include <cmath>

#include "base/parallel.hpp"

namespace ejecta {
namespace {

constexpr std::size_t kKept = 32;  ///< portions: memory does not grow with what has passed

std::int64_t portion_of(std::int64_t batch) {
  return (batch - (batch % FeederStream::kBatches + FeederStream::kBatches) % FeederStream::kBatches) /
         FeederStream::kBatches;
}

}  // namespace

FeederStream::FeederStream(const Case& c, const std::vector<ParticleClass>& classes, double cell_length,
                           Tray tray, std::int64_t run_in)
    : feeder_(c, classes),
      cell_length_(cell_length),
      speed_(c.launch.belt_speed),
      run_in_(run_in),
      tray_(std::move(tray)) {}

/// A batch comes to lie in its own cell, in one before it if it is early, in one behind it if it is late.
std::int64_t FeederStream::first_batch(std::int64_t cell) const {
  return cell - 1 - static_cast<std::int64_t>(std::ceil(Feeder::kLate * speed_ / cell_length_));
}
std::int64_t FeederStream::last_batch(std::int64_t cell) const {
  return cell + 1 + static_cast<std::int64_t>(std::ceil(feeder_.early() * speed_ / cell_length_));
}

std::shared_ptr<const FeederStream::Portion> FeederStream::compute(std::int64_t number) const {
  const std::int64_t first = number * kBatches, last = first + kBatches;
  std::vector<FeedParticle> particles;
  std::vector<std::size_t> ends;
  for (std::int64_t batch = first; batch < last; ++batch) {
    const std::vector<FeedParticle> more = tray_(batch);
    particles.insert(particles.end(), more.begin(), more.end());
    ends.push_back(particles.size());
  }
  const std::size_t wanted = particles.size();
  for (std::int64_t n = 1; n <= run_in_; ++n)
    for (const std::int64_t batch : {first - n, last - 1 + n}) {
      const std::vector<FeedParticle> more = tray_(batch);
      particles.insert(particles.end(), more.begin(), more.end());
    }
  const std::vector<FeedParticle> came = feeder_.run(particles, wanted);
  auto portion = std::make_shared<Portion>();
  std::size_t from = 0;
  for (const std::size_t end : ends) {
    portion->emplace_back(came.begin() + static_cast<std::ptrdiff_t>(from),
                          came.begin() + static_cast<std::ptrdiff_t>(end));
    from = end;
  }
  return portion;
}

std::shared_ptr<const FeederStream::Portion> FeederStream::portion(std::int64_t number) const {
  {
    const std::lock_guard lock(guard_);
    if (const auto found = kept_.find(number); found != kept_.end()) return found->second;
  }
  auto made = compute(number);
  const std::lock_guard lock(guard_);
  kept_[number] = made;
  while (kept_.size() > kKept)
    kept_.erase(kept_.begin()->first == number ? std::prev(kept_.end()) : kept_.begin());
  return made;
}

std::vector<FeedParticle> FeederStream::batch(std::int64_t number) const {
  const std::int64_t from = portion_of(number);
  return (*portion(from))[static_cast<std::size_t>(number - from * kBatches)];
}

void FeederStream::prepare(std::int64_t first, std::int64_t last) const {
  const std::int64_t from = portion_of(first_batch(first)), to = portion_of(last_batch(last - 1));
  for_each_index_dynamic(static_cast<int>(to - from + 1), [&](int n) { portion(from + n); });
}

std::vector<FeedParticle> FeederStream::cells(std::int64_t first, std::int64_t last) const {
  std::vector<std::vector<FeedParticle>> by_cell(static_cast<std::size_t>(last - first));
  const std::int64_t from = first_batch(first), to = last_batch(last - 1);
  for (std::int64_t number = from; number <= to; ++number)
    for (const FeedParticle& p : batch(number)) {
      const auto cell = static_cast<std::int64_t>(std::floor(p.x / cell_length_));
      if (cell >= first && cell < last) by_cell[static_cast<std::size_t>(cell - first)].push_back(p);
    }
  std::vector<FeedParticle> all;
  for (const auto& cell : by_cell) all.insert(all.end(), cell.begin(), cell.end());
  return all;
}

}  // namespace ejecta
