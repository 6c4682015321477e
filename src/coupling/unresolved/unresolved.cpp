#include "coupling/unresolved/unresolved.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.hpp"
#include "base/state_reader.hpp"
#include "flow/turbulence/closures.hpp"

namespace ejecta {

UnresolvedCoupling::UnresolvedCoupling(const Grid& grid, const UnresolvedSetup& setup)
    : grid_(grid), setup_(setup), map_(grid, setup.beyond, setup.kernel_width), eddies_(setup.seed) {}

void UnresolvedCoupling::note_grains(std::span<const Body> grains) {
  for (std::size_t n = diameters_.size(); n < grains.size(); ++n) {
    diameters_.push_back(2 * grains[n].shape.bounding_radius());
    volumes_.push_back(grains[n].shape.mass_properties().volume);
    masses_.push_back(grains[n].mass);
  }
  pushed_.resize(grains.size(), Vec3(0, 0, 0));
  if (setup_.disperses) eddies_.grow(grains.size());
}

void UnresolvedCoupling::map(std::span<const Body> grains, const std::vector<char>& here,
                             const FluidSeen& fluid, const CutCells& cut, double dt, FluidFraction& f) {
  note_grains(grains);
  map_.place(grains, here, diameters_, cut);
  std::swap(f.solids_before, f.solids);
  map_.scatter<1>({f.solids.view()}, [&](std::size_t at) { return std::array{volumes_[map_.grain(at)]}; });
  if (!mapped_) f.solids_before = f.solids;  // they are there from the beginning
  mapped_ = true;
  dt_ = dt;
  find_drags(grains, fluid, f.solids.view(), dt);
  const double inverse = 1 / setup_.fluid_density;
  map_.scatter<4>({f.drag.view(), f.dragging[0].view(), f.dragging[1].view(), f.dragging[2].view()},
                  [&](std::size_t at) {
                    const double c = inverse * drags_[at].coefficient;
                    const Vec3& v = drags_[at].carried;
                    return std::array{c, c * v.x(), c * v.y(), c * v.z()};
                  });
}

void UnresolvedCoupling::find_drags(std::span<const Body> grains, const FluidSeen& fluid,
                                    ConstFieldView solids, double dt) {
  constexpr std::size_t kSize = drag::Batch::kSize;
  static_assert(kGrainBlock % kSize == 0);
  const bool wakes = setup_.acts && grid_.active(0) && grid_.active(1) && grid_.active(2);
  const drag::Step step{dt, wakes ? 1.0 : 0.0};
  drags_.resize(map_.size());
  std::vector<GrainExtremes> met(block_count_of(map_.size()));
  for_each_grain_block(map_.size(), [&](std::size_t b, std::size_t begin, std::size_t end) {
    for (; begin < end; begin += kSize) {
      drag::Batch batch;
      std::array<Vec3, kSize> eddy;
      for (std::size_t n = 0; n < std::min(kSize, end - begin); ++n)
        eddy[n] = look_around(grains, begin + n, fluid, solids, dt, batch, n);
      batch.fill_up(std::min(kSize, end - begin));
      if (setup_.drag) setup_.drag(step, batch);
      for (std::size_t n = 0; n < std::min(kSize, end - begin); ++n) {
        const GrainMap::Place& p = map_[begin + n];
        drags_[begin + n] = {};
        if (!(p.inside > 0)) continue;
        met[b].fraction = std::min(met[b].fraction, batch.fraction[n]);
        if (!setup_.drag) continue;
        met[b].reynolds = std::max(met[b].reynolds, batch.reynolds[n]);
        drags_[begin + n] = {batch.coefficient[n],
                             grains[map_.grain(begin + n)].velocity +
                                 Vec3(batch.gain[0][n], batch.gain[1][n], batch.gain[2][n]) - eddy[n]};
      }
    }
  });
  extremes_ = {};
  for (const GrainExtremes& m : met)
    extremes_ = {std::max(extremes_.reynolds, m.reynolds), std::min(extremes_.fraction, m.fraction)};
}

Vec3 UnresolvedCoupling::look_around(std::span<const Body> grains, std::size_t at, const FluidSeen& fluid,
                                     ConstFieldView solids, double dt, drag::Batch& batch, std::size_t n) {
  constexpr double kLeastFraction = 0.05;
  const GrainMap::Place& p = map_[at];
  const std::size_t g = map_.grain(at);
  const Body &grain = grains[g], &later = grains[map_.grain_ahead(at, map_.size() - 1)];
  __builtin_prefetch(&later.velocity);
  __builtin_prefetch(&later.motion);
  const auto seen = map_.gather<4>(at, {fluid.velocity[0], fluid.velocity[1], fluid.velocity[2], solids});
  const double inverse = p.inside > 0 ? 1 / p.inside : 0.0;
  batch.fluid_density[n] = fluid.density.origin && p.inside > 0
                               ? inverse * map_.gather<1>(at, {fluid.density})[0]
                               : setup_.fluid_density;
  batch.viscosity[n] = setup_.viscosity * (setup_.fluid_density / batch.fluid_density[n]);
  const Vec3 slip = inverse * Vec3(seen[0], seen[1], seen[2]) - grain.velocity;
  const Vec3 eddy =
      setup_.disperses && p.inside > 0
          ? eddy_around(at, fluid,
                        {diameters_[g], slip.norm(), 1.0, batch.fluid_density[n], batch.viscosity[n]}, dt)
          : Vec3(0, 0, 0);
  batch.diameter[n] = diameters_[g];
  batch.volume[n] = volumes_[g];
  batch.mass[n] = masses_[g];
  batch.is_free[n] = grain.motion == Motion::free;
  batch.fraction[n] = std::max(1 - inverse * seen[3], kLeastFraction);
  batch.density[n] = p.density;
  batch.spread[n] = p.spread;
  for (int c = 0; c < 3; ++c) {
    const std::size_t d = static_cast<std::size_t>(c);
    batch.slip[d][n] = slip[c] + eddy[c];
    batch.acceleration[d][n] = setup_.gravity[c] + pushed_[g][c];
  }
  return eddy;
}

/// Of a grain that looks at the turbulence of its cells.
Vec3 UnresolvedCoupling::eddy_around(std::size_t at, const FluidSeen& fluid, const drag::Surroundings& alone,
                                     double dt) {
  const double inverse = 1 / map_[at].inside;
  const std::size_t g = map_.grain(at);
  const auto turbulence = map_.gather<2>(at, {fluid.k, fluid.dissipation});
  EddyAround around{.k = inverse * turbulence[0], .epsilon = inverse * turbulence[1], .slip = alone.slip};
  if (fluid.specific) around.epsilon *= k_epsilon::kCmu * around.k;
  around.relaxation = masses_[g] / drag::schiller_naumann(alone);
  return eddies_.velocity(g, around, dt);
}

void UnresolvedCoupling::collect(std::span<const Body> grains, const std::vector<char>& here,
                                 FluidFraction& f, std::span<Load> loads) {
  drag_force_.resize(grains.size());
  for_each_grain_block(grains.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      if (here[n]) continue;
      loads[n] = Load{};
      drag_force_[n].setZero();
      pushed_[n].setZero();
    }
  });
  const std::array<ConstFieldView, 6> fields{f.seen[0].view(), f.seen[1].view(), f.seen[2].view(),
                                             f.push[0].view(), f.push[1].view(), f.push[2].view()};
  const Vec3 driven = setup_.body_force - setup_.gravity;
  for_each_grain_block(map_.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; ++at) {
      const std::size_t n = map_.grain(at), later = map_.grain_ahead(at, end - 1);
      __builtin_prefetch(&loads[later], 1);
      __builtin_prefetch(&drag_force_[later], 1);
      __builtin_prefetch(&pushed_[later], 1);
      const auto sums = map_.gather<6>(at, fields);
      const Vec3 u(sums[0], sums[1], sums[2]), gradients(sums[3], sums[4], sums[5]);
      const double inside = map_[at].inside;
      drag_force_[n] = drags_[at].coefficient * (u - inside * drags_[at].carried);
      const Vec3 by_volume = setup_.fluid_density * volumes_[n] * (gradients + inside * driven);
      loads[n] = Load{};
      loads[n].force = drag_force_[n] + by_volume;
      pushed_[n] = by_volume / masses_[n];
    }
  });
  if (setup_.works) find_work(grains, f);
}

/// Drag times the mean of the velocities with which a grain begins and ends the step if it meets nothing.
void UnresolvedCoupling::find_work(std::span<const Body> grains, FluidFraction& f) const {
  map_.scatter<1>({f.work.view()}, [&](std::size_t at) {
    const std::size_t n = map_.grain(at);
    const Vec3& drag = drag_force_[n];
    const Vec3 gain = grains[n].motion == Motion::free
                          ? Vec3(dt_ * (drag / masses_[n] + pushed_[n] + setup_.gravity))
                          : Vec3(0, 0, 0);
    const double inside = map_[at].inside;
    return std::array{inside > 0 ? dt_ / inside * drag.dot(grains[n].velocity + 0.5 * gain) : 0.0};
  });
}

std::vector<double> UnresolvedCoupling::state() const {
  std::vector<double> out{mapped_ ? 1.0 : 0.0};
  for (const Vec3& v : pushed_) out.insert(out.end(), v.data(), v.data() + 3);
  eddies_.add_state(out);
  return out;
}

void UnresolvedCoupling::restore(std::span<const double> state, std::size_t grains) {
  StateReader in(state, "grains");
  mapped_ = in.whole(0, 1) == 1;
  pushed_.assign(mapped_ ? grains : 0, Vec3(0, 0, 0));
  for (Vec3& v : pushed_) v = in.vec3();
  if (setup_.disperses) eddies_.restore(in, pushed_.size());
  in.end();
}

}  // namespace ejecta
