#include "sorter/controller.hpp"

#include <algorithm>
#include <cmath>

namespace ejecta {

double valve_place(const Case& c, int valve) {
  return (valve + 0.5 - 0.5 * c.manifold.valves) * valve_pitch(c);
}

Controller::Controller(const Case& c)
    : spec_(c.controller),
      valves_(c.manifold.valves),
      speed_(c.launch.belt_speed),
      width_(valve_pitch(c) * c.manifold.valves),
      pitch_(valve_pitch(c)) {}

std::vector<ValveCommand> Controller::commands(std::span<const SeenObject> objects) const {
  std::vector<ValveCommand> list;
  for (std::size_t n = 0; n < objects.size(); ++n) {
    const SeenObject& o = objects[n];
    if (!o.eject) continue;
    ValveCommand command{.object = static_cast<int>(n)};
    const double length = o.x_high - o.x_low, slack = spec_.quantile * spec_.time_error;
    double lasts = spec_.duration;
    if (spec_.window == WindowRule::fixed) {
      command.from = 0.5 * (o.x_low + o.x_high) / speed_ - spec_.lead;
    } else {
      command.from = o.x_low / speed_ - slack - spec_.lead;
      lasts = length / speed_ + 2.0 * slack;
    }
    if (spec_.step > 0.0) command.from = spec_.step * std::floor(command.from / spec_.step + 0.5);
    command.to = command.from + std::max(lasts, spec_.shortest_on);
    const double width = o.y_high - o.y_low + 2.0 * spec_.quantile * spec_.place_error,
                 middle = 0.5 * (o.y_low + o.y_high) + 0.5 * width_;
    const int count = spec_.valves > 0 ? spec_.valves : static_cast<int>(std::ceil(width / pitch_));
    command.first = static_cast<int>(std::floor(middle / pitch_ - 0.5 * count + 0.5));
    command.last = std::min(valves_ - 1, command.first + count - 1);
    command.first = std::max(0, command.first);
    if (command.first <= command.last) list.push_back(command);
  }
  return list;
}

}  // namespace ejecta
