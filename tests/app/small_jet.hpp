#pragma once
#include <string>

namespace ejecta::test {

/// A jet small enough for a second: 8 cells across the orifice, 12 mm long.
inline std::string small_jet(const std::string& more = "") {
  return R"(
[run]
end_time = "0.2 ms"
courant = 0.9
[flow]
solver = "compressible"
turbulence = "k-epsilon"
[valve]
supply_pressure = "700 kPa gauge"
orifice_diameter = "1.8 mm"
rise_time = "0.02 ms"
fall_time = "0 ms"
duration = "0.1 ms"
[launch]
stand_off = "10 mm"
[grid]
geometry = "axisymmetric"
[grid.x]
points = ["0 mm", "0.9 mm", "10 mm"]
cells = [4, 16]
grading = [1, 6]
[grid.y]
points = ["0 mm", "1 mm"]
cells = [1]
[grid.z]
points = ["0 mm", "12 mm"]
cells = [40]
[boundary.x_max]
type = "free-stream"
[boundary.y_min]
type = "symmetry"
[boundary.y_max]
type = "symmetry"
[boundary.z_min]
type = "wall"
[[boundary.z_min.patch]]
type = "jet"
centre = ["0 mm", "0 mm", "0 mm"]
radius = "0.9 mm"
[boundary.z_max]
type = "wave-transmissive"
)" + more;
}

}  // namespace ejecta::test
