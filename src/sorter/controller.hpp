#pragma once
#include <span>
#include <vector>

#include "case/case.hpp"
#include "case/extent.hpp"
#include "sorter/feed_particle.hpp"

namespace ejecta {

/// Turns objects that are to be ejected into commands for valves.
class Controller {
 public:
  explicit Controller(const Case& c);
  std::vector<ValveCommand> commands(std::span<const SeenObject> objects) const;

 private:
  ControllerSpec spec_;
  int valves_;
  double speed_, width_, pitch_;
};

/// m, across the belt from its middle.
double valve_place(const Case& c, int valve);

}  // namespace ejecta
