#include "sorter/sorting.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "sorter/alone.hpp"
#include "sorter/company.hpp"

namespace ejecta {
namespace {

/// s, from a particle's passing: what a valve does earlier or later it does not feel.
constexpr double kLongest = 0.05;

/// Deviations of the arrival that the halo of a stretch holds: of a million particles one comes farther off.
constexpr double kDeviations = 5.0;

constexpr double kSlips =
    10e-3;  ///< m/s, on the belt: 2 mm from the camera of the paper's machine to its jets

/// m, of belt beside a stretch: who comes from farther does not push those on it.
constexpr double kBeside = 0.3;

double middle_of(const SeenObject& o) { return 0.5 * (o.x_low + o.x_high); }

/// Cells of belt beside a stretch whose commands may blow on what lies in it: as far as a command is ahead of
/// its object, lasts, and is felt, and as particles come late.
std::int64_t halo_cells(const Case& c, double cell_length) {
  const ControllerSpec& k = c.controller;
  const double by_rule = k.window == WindowRule::fixed ? k.duration : 2.0 * k.quantile * k.time_error;
  const double time = kLongest + std::abs(k.lead) + std::max(by_rule, k.shortest_on) + k.shortest_off +
                      kDeviations * (c.feed.arrival_scatter + c.manifold.delay_spread);
  return std::max<std::int64_t>(
      1, static_cast<std::int64_t>(std::ceil(time * c.launch.belt_speed / cell_length)));
}

}  // namespace

struct Sorter::Scene {
  std::vector<FeedParticle> particles;
  std::vector<SeenObject> objects;
  std::vector<int> object_of;  // of a particle; -1: none
  std::vector<ValveCommand> commands;
  ValvePulses pulses;
  ValvePulses pulses_with_dead;  // as if no valve were dead; empty: none is
};

Ejection fast_ejection(const Case& c, const JetSource& source) {
  const AirCoefficients coefficients;
  const auto field = std::make_shared<const JetField>(c, source);
  const auto flight = std::make_shared<const FastFlight>(c, *field, coefficients);
  const auto company = std::make_shared<const Company>(c, *flight);
  return {.fly = [field, flight, company](std::span<const Flyer> flyers) { return company->fly(flyers); },
          .reach = [flight](const FeedParticle& p) { return flight->reach(p); }};
}

Sorter::Sorter(const Case& c, Ejection ejection)
    : case_(c),
      feed_(c),
      camera_(c),
      controller_(c),
      manifold_(c),
      ejection_(std::move(ejection)),
      vessel_(c),
      air_use_(c),
      halo_(halo_cells(c, feed_.cell_length())) {}

double Sorter::comes_at(std::int64_t cell) const {
  return static_cast<double>(cell) * feed_.cell_length() / case_.launch.belt_speed - case_.controller.lead;
}

ValvePulses Sorter::pulses(std::int64_t first, std::int64_t last) const {
  return manifold_.pulses(look(first, last).commands);
}

Flyer Sorter::flyer(const FeedParticle& p, const ValvePulses& pulses, bool as_seen) const {
  Flyer f{.particle = &p,
          .at = p.x / case_.launch.belt_speed + (as_seen ? 0.0 : p.late),
          .y = p.y + (as_seen ? 0.0 : p.beside)};
  const double reach = ejection_.reach(p), pitch = valve_pitch(case_);
  const int count = case_.manifold.valves;
  const double middle = f.y / pitch + 0.5 * count - 0.5;
  const int first = std::max(0, static_cast<int>(std::ceil(middle - reach / pitch))),
            last = std::min(count - 1, static_cast<int>(std::floor(middle + reach / pitch)));
  for (int v = first; v <= last; ++v) {
    const double delay = manifold_.delay(v);
    for (const ValvePulse& pulse : pulses[static_cast<std::size_t>(v)]) {
      if (pulse.from + delay > f.at + kLongest || pulse.to + delay < f.at - kLongest) continue;
      Blow blow{valve_place(case_, v), pulse};
      blow.pulse.from += delay;
      blow.pulse.to += delay;
      f.blows.push_back(blow);
    }
  }
  return f;
}

FlightEnd Sorter::fly_alone(const FeedParticle& p, const ValvePulses& pulses, bool as_seen) const {
  const Flyer f = flyer(p, pulses, as_seen);
  return std::move(ejection_.fly(std::span(&f, 1)).front());
}

Fate Sorter::fate_of(const Scene& s, std::size_t n, const FlightEnd& flight) const {
  const FeedParticle& p = s.particles[n];
  const bool wanted = case_.classes[static_cast<std::size_t>(p.kind)].eject;
  const SeenObject* object =
      s.object_of[n] < 0 ? nullptr : &s.objects[static_cast<std::size_t>(s.object_of[n])];
  const bool single = object && object->members.size() == 1, shot_at = object && object->eject;
  const auto alone = [&] { return fly_alone(p, s.pulses).ejected(); };
  if (!wanted) {
    if (!flight.ejected()) return Fate::kept;
    if (shot_at) return single ? Fate::taken_misread : Fate::taken_agglomerated;
    return flight.met && !alone() ? Fate::taken_pushed : Fate::taken_in_window;
  }
  if (flight.ejected()) return Fate::ejected;
  if (!object) return Fate::missed_not_seen;
  if (!shot_at) return single ? Fate::missed_misread : Fate::missed_agglomerated;
  if (!s.pulses_with_dead.empty() && fly_alone(p, s.pulses_with_dead).ejected())
    return Fate::missed_dead_valve;
  if ((p.late != 0.0 || p.beside != 0.0) && fly_alone(p, s.pulses, true).ejected()) return Fate::missed_late;
  if (flight.in_company && alone()) return Fate::missed_pushed;
  if (!single) return Fate::missed_agglomerated;
  if (flight.clearance > -0.5 * p.scale * p.prototype->height) return Fate::missed_struck_plate;
  return Fate::missed_too_weak;
}

Sorter::Scene Sorter::look(std::int64_t first, std::int64_t last) const {
  Scene s;
  s.particles = feed_.cells(first - halo_, last + halo_);
  s.objects = camera_.look(s.particles);
  s.object_of.assign(s.particles.size(), -1);
  for (std::size_t o = 0; o < s.objects.size(); ++o)
    for (const int member : s.objects[o].members)
      s.object_of[static_cast<std::size_t>(member)] = static_cast<int>(o);
  s.commands = controller_.commands(s.objects);
  return s;
}

Shot Sorter::shot(const Scene& s, std::span<const ValveCommand> commands, std::size_t which) const {
  const ValveCommand& c = commands[which];
  const double middle = 0.5 * (valve_place(case_, c.first) + valve_place(case_, c.last)),
               v = case_.launch.belt_speed;
  Shot shot;
  shot.lasts = c.to - c.from;
  std::vector<Blow> blows;
  for (int valve = c.first; valve <= c.last; ++valve) {
    if (manifold_.is_dead(valve)) continue;
    shot.valves.push_back(valve_place(case_, valve) - middle);
    blows.push_back({valve_place(case_, valve), {.from = c.from, .to = c.to}});
  }
  // How far from the middle of a command a particle is, in its own half width and in half its time.
  const auto distance = [&](const ValveCommand& command, double at, double y) {
    const double y_low = valve_place(case_, command.first), y_high = valve_place(case_, command.last);
    return std::abs(at - case_.controller.lead - 0.5 * (command.from + command.to) +
                    0.5 * case_.controller.duration) *
               v +
           std::max({0.0, y_low - y, y - y_high});
  };
  std::vector<Flyer> flyers;
  std::vector<std::size_t> which_of;
  for (std::size_t n = 0; n < s.particles.size(); ++n) {
    const FeedParticle& p = s.particles[n];
    const Flyer f{.particle = &p, .at = p.x / v + p.late, .y = p.y + p.beside, .blows = blows};
    const double near = ejection_.reach(p) + kBeside;
    if (f.y < valve_place(case_, c.first) - near || f.y > valve_place(case_, c.last) + near) continue;
    if (std::abs(f.at - c.from) > kLongest + kBeside / v) continue;
    flyers.push_back(f);
    which_of.push_back(n);
  }
  const std::vector<FlightEnd> ends = ejection_.fly(flyers);
  for (std::size_t f = 0; f < flyers.size(); ++f) {
    const std::size_t n = which_of[f];
    const FeedParticle& p = s.particles[n];
    const double at = flyers[f].at, y = flyers[f].y;
    const FlightEnd& end = ends[f];
    const bool member = s.object_of[n] == c.object;
    if (!end.touched && !member) continue;
    ShotBody body{.particle = p,
                  .at = at - c.from,
                  .y = y - middle,
                  .counts = member,
                  .ejected = end.ejected(),
                  .gain = end.gain};
    const bool other_target =
        !member && s.object_of[n] >= 0 && s.objects[static_cast<std::size_t>(s.object_of[n])].eject;
    if (!member && !other_target) {
      const double mine = distance(c, at, y);
      body.counts = std::none_of(commands.begin(), commands.end(), [&](const ValveCommand& other) {
        const double theirs = distance(other, at, y);
        return theirs < mine || (theirs == mine && &other < &c);
      });
    }
    shot.bodies.push_back(body);
  }
  return shot;
}

std::vector<Shot> Sorter::shots(std::int64_t cell) const {
  const Scene s = look(cell, cell + 1);
  std::vector<Shot> list;
  for (std::size_t n = 0; n < s.commands.size(); ++n)
    if (feed_.cell_of(middle_of(s.objects[static_cast<std::size_t>(s.commands[n].object)])) == cell)
      list.push_back(shot(s, s.commands, n));
  return list;
}

/// An opening counts where it begins, its air over the time that it is open.
void Sorter::add_use(const ValvePulse& p, std::int64_t first, std::span<Tally> cells) const {
  const double air = p.use * air_use_.mass(p.to - p.from) / (p.to - p.from);
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const auto cell = first + static_cast<std::int64_t>(n);
    const double from = comes_at(cell), to = comes_at(cell + 1);
    if (p.from >= from && p.from < to) cells[n].openings += 1.0;
    cells[n].air += air * std::max(0.0, std::min(p.to, to) - std::max(p.from, from));
  }
}

SortedStretch Sorter::sort(std::int64_t first, std::int64_t last, int show,
                           std::optional<double> pressure) const {
  Scene s = look(first, last);
  const std::vector<ValveCommand>& commands = s.commands;
  s.pulses = manifold_.pulses(commands);
  if (manifold_.dead_count() > 0) s.pulses_with_dead = manifold_.pulses(commands, true);
  if (vessel_.is_there())
    for (ValvePulses* pulses : {&s.pulses, &s.pulses_with_dead})
      vessel_.draw(*pulses, comes_at(first - halo_), pressure.value_or(vessel_.full()));
  const std::vector<bool> single = standing_alone(s.particles, case_.camera.gap);

  SortedStretch out;
  out.cells.resize(static_cast<std::size_t>(last - first));
  for (Tally& t : out.cells) {
    t.kinds.resize(case_.classes.size());
    t.length = feed_.cell_length();
  }
  const auto tally_at = [&](double x) -> Tally* {
    const std::int64_t cell = feed_.cell_of(x);
    return cell >= first && cell < last ? &out.cells[static_cast<std::size_t>(cell - first)] : nullptr;
  };
  const double from_x = static_cast<double>(first) * feed_.cell_length() - kBeside,
               to_x = static_cast<double>(last) * feed_.cell_length() + kBeside;
  std::vector<Flyer> flyers;
  std::vector<std::size_t> flies(s.particles.size());
  for (std::size_t n = 0; n < s.particles.size(); ++n) {
    flies[n] = flyers.size();
    if (const FeedParticle& p = s.particles[n]; p.x >= from_x && p.x < to_x)
      flyers.push_back(flyer(p, s.pulses));
  }
  const std::vector<FlightEnd> flown = ejection_.fly(flyers);
  for (std::size_t n = 0; n < s.particles.size(); ++n) {
    const FeedParticle& p = s.particles[n];
    Tally* tally = tally_at(p.x);
    if (!tally) continue;
    const FlightEnd& end = flown[flies[n]];
    const Fate fate = fate_of(s, n, end);
    Tally::Kind& kind = tally->kinds[static_cast<std::size_t>(p.kind)];
    kind.number[static_cast<std::size_t>(fate)] += 1.0;
    kind.mass[static_cast<std::size_t>(fate)] += p.mass;
    kind.area += plan_area(p);
    kind.slipping += std::abs(p.slip) > kSlips;
    kind.late_squares += p.late * p.late;
    kind.alone += single[n];
    const int o = s.object_of[n];
    kind.alone_seen += o >= 0 && s.objects[static_cast<std::size_t>(o)].members.size() == 1;
    kind.met += end.met;
    kind.in_another += end.in_another;
    if (static_cast<int>(out.shown.size()) < show) out.shown.push_back({p, fate, end.track});
  }
  const double begins = static_cast<double>(first - halo_) * feed_.cell_length(),
               ends = static_cast<double>(last + halo_) * feed_.cell_length();
  for (const SeenObject& o : s.objects)
    if (Tally* tally = tally_at(middle_of(o))) {
      tally->objects += 1.0;
      tally->cut += o.x_high > ends - camera_.pixel() || o.x_low < begins + camera_.pixel();
    }
  for (const ValveCommand& c : commands)
    if (Tally* tally = tally_at(middle_of(s.objects[static_cast<std::size_t>(c.object)])))
      tally->shots += 1.0;
  for (const auto& pulses : s.pulses)
    for (const ValvePulse& p : pulses) add_use(p, first, out.cells);
  if (show > 0) {
    out.objects = s.objects;
    out.pulses = s.pulses;
  }
  return out;
}

}  // namespace ejecta
