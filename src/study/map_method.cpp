#include "study/map_method.hpp"

#include "study/outline.hpp"
#include "study/outline_grid.hpp"

namespace ejecta {

std::unique_ptr<MapMethod> make_map_method(const MapSettings& settings) {
  if (settings.step_x > 0.0) return std::make_unique<OutlineGrid>(settings);
  return std::make_unique<OutlineFinder>(settings);
}

}  // namespace ejecta
