#include "case/template_texts.hpp"

namespace ejecta {

const std::vector<TemplateText>& template_texts() {
  static const std::vector<TemplateText> texts{
      {"ejection", "One particle from the belt over one air jet: is it ejected?", R"toml(
[run]
title = "10 mm cube over one jet"
until = "verdict"
end_time = "150 ms"
courant = 1.0
[flow]
solver = "incompressible"
turbulence = "k-epsilon"
[grid.x]
points = ["-40 mm", "-15 mm", "15 mm", "40 mm"]
cells = [15, 30, 15]
grading = [0.4, 1, 2.5]
[grid.y]
points = ["-40 mm", "-15 mm", "15 mm", "40 mm"]
cells = [15, 30, 15]
grading = [0.4, 1, 2.5]
[grid.z]
points = ["40 mm", "120 mm"]
cells = [80]
[boundary.x_min]
type = "free-stream"
[boundary.x_max]
type = "free-stream"
[boundary.y_min]
type = "free-stream"
[boundary.y_max]
type = "free-stream"
[boundary.z_min]
type = "jet"
[boundary.z_max]
type = "free-stream"
[valve]
supply_pressure = "700 kPa gauge"
orifice_diameter = "1.8 mm"
duration = "8 ms"
[jet]
kind = "self-similar"
[[material]]
name = "ore"
density = "2700 kg/m3"
[[body]]
name = "cube"
shape = "box"
size = ["10 mm", "10 mm", "10 mm"]
material = "ore"
on_belt = true
[launch]
belt_speed = "3 m/s"
stand_off = "75 mm"
arrives_at = "4 ms"
[splitter]
distance = "250 mm"
height = "45 mm"
[output]
slices_interval = "1 ms"
[[slice]]
name = "side"
axis = "y"
position = "0 mm"
)toml"},
      {"jet", "A jet without bodies, recorded along its axis", R"toml(
[run]
title = "pulsed jet"
end_time = "12 ms"
courant = 1.0
[flow]
solver = "incompressible"
turbulence = "k-epsilon"
[grid.x]
points = ["-40 mm", "40 mm"]
cells = [60]
[grid.y]
points = ["-40 mm", "40 mm"]
cells = [60]
[grid.z]
points = ["40 mm", "120 mm"]
cells = [60]
[boundary.x_min]
type = "free-stream"
[boundary.x_max]
type = "free-stream"
[boundary.y_min]
type = "free-stream"
[boundary.y_max]
type = "free-stream"
[boundary.z_min]
type = "jet"
[boundary.z_max]
type = "free-stream"
[valve]
supply_pressure = "700 kPa gauge"
duration = "8 ms"
[[probe]]
name = "at-75mm"
position = ["0 mm", "0 mm", "75 mm"]
diameter = "2 mm"
response_time = "1 ms"
[[line]]
name = "axis"
from = ["0 mm", "0 mm", "40 mm"]
to = ["0 mm", "0 mm", "120 mm"]
[output]
history_interval = "0.1 ms"
)toml"},
      {"stream", "A fixed body in a uniform stream: its drag coefficient", R"toml(
[run]
title = "sphere at Reynolds number 100"
end_time = "20 s"
[fluid]
ideal_gas = false
density = "1000 kg/m3"
viscosity = "1 mPa s"
[flow]
solver = "incompressible"
[grid.x]
points = ["-50 mm", "-10 mm", "20 mm", "100 mm"]
cells = [20, 36, 30]
grading = [0.25, 1, 4]
[grid.y]
points = ["-50 mm", "-10 mm", "10 mm", "50 mm"]
cells = [20, 24, 20]
grading = [0.25, 1, 4]
[grid.z]
points = ["-50 mm", "-10 mm", "10 mm", "50 mm"]
cells = [20, 24, 20]
grading = [0.25, 1, 4]
[boundary.x_min]
type = "velocity"
velocity = ["10 mm/s", "0 m/s", "0 m/s"]
[boundary.x_max]
type = "pressure-outlet"
[boundary.y_min]
type = "slip"
[boundary.y_max]
type = "slip"
[boundary.z_min]
type = "slip"
[boundary.z_max]
type = "slip"
[[initial]]
velocity = ["10 mm/s", "0 m/s", "0 m/s"]
[[body]]
name = "sphere"
shape = "sphere"
diameter = "10 mm"
motion = "fixed"
[stream]
velocity = ["10 mm/s", "0 m/s", "0 m/s"]
average_from = "15 s"
[[expect]]
quantity = "/bodies/0/drag_coefficient"
reference = 1.087
relative_tolerance = 0.1
source = "Clift, Grace & Weber 1978, standard drag curve"
)toml"},
      {"settling", "A sphere settling in a tank of liquid", R"toml(
[run]
title = "sphere settling in a tank"
end_time = "1 s"
[fluid]
ideal_gas = false
density = "960 kg/m3"
viscosity = "58 mPa s"
[flow]
solver = "incompressible"
[grid.x]
points = ["0 mm", "100 mm"]
cells = [60]
[grid.y]
points = ["0 mm", "100 mm"]
cells = [60]
[grid.z]
points = ["0 mm", "160 mm"]
cells = [96]
[boundary.z_max]
type = "slip"
[[material]]
name = "nylon"
density = "1120 kg/m3"
[[body]]
name = "sphere"
shape = "sphere"
diameter = "15 mm"
material = "nylon"
position = ["50 mm", "50 mm", "127.5 mm"]
[[wall]]
name = "floor"
kind = "plane"
point = ["0 mm", "0 mm", "0 mm"]
normal = [0, 0, 1]
)toml"},
      {"cavity", "A flow without bodies: the lid-driven cavity", R"toml(
[run]
title = "lid-driven cavity at Reynolds number 100"
end_time = "20 s"
courant = 0.8
[environment]
gravity = ["0 m/s2", "0 m/s2", "0 m/s2"]
[fluid]
ideal_gas = false
density = "1 kg/m3"
viscosity = "0.01 Pa s"
[flow]
solver = "incompressible"
[grid.x]
points = ["0 m", "1 m"]
cells = [64]
[grid.y]
points = ["0 m", "0.1 m"]
cells = [1]
[grid.z]
points = ["0 m", "1 m"]
cells = [64]
[boundary.y_min]
type = "symmetry"
[boundary.y_max]
type = "symmetry"
[boundary.z_max]
type = "moving-wall"
velocity = ["1 m/s", "0 m/s", "0 m/s"]
[[line]]
name = "centre"
from = ["0.5 m", "0.05 m", "0 m"]
to = ["0.5 m", "0.05 m", "1 m"]
points = 65
)toml"},
      {"shock-tube", "A compressible flow from two states: Sod's shock tube", R"toml(
[run]
title = "Sod's shock tube"
end_time = "0.2 s"
courant = 0.5
[environment]
gravity = ["0 m/s2", "0 m/s2", "0 m/s2"]
[fluid]
viscosity = "0 Pa s"
[flow]
solver = "compressible"
[grid.x]
points = ["0 m", "1 m"]
cells = [200]
[grid.y]
points = ["0 m", "0.1 m"]
cells = [1]
[grid.z]
points = ["0 m", "0.1 m"]
cells = [1]
[boundary.x_min]
type = "wave-transmissive"
[boundary.x_max]
type = "wave-transmissive"
[boundary.y_min]
type = "symmetry"
[boundary.y_max]
type = "symmetry"
[boundary.z_min]
type = "symmetry"
[boundary.z_max]
type = "symmetry"
[[initial]]
pressure = "1 Pa absolute"
density = "1 kg/m3"
[[initial]]
box = [["0.5 m", "0 m", "0 m"], ["1 m", "0.1 m", "0.1 m"]]
pressure = "0.1 Pa absolute"
density = "0.125 kg/m3"
[[line]]
name = "tube"
from = ["0.0025 m", "0.05 m", "0.05 m"]
to = ["0.9975 m", "0.05 m", "0.05 m"]
points = 200
)toml"},
      {"collision", "Bodies without flow: a ball bounces on a floor", R"toml(
[run]
title = "a ball bounces on a floor"
end_time = "0.5 s"
[flow]
solver = "none"
[[material]]
name = "glass"
youngs_modulus = "50 MPa"
poisson_ratio = 0.2
density = "2500 kg/m3"
restitution = 0.8
friction = 0.3
[contact]
law = "hertz-mindlin"
[[body]]
name = "ball"
shape = "sphere"
diameter = "10 mm"
material = "glass"
position = ["0 mm", "0 mm", "100 mm"]
velocity = ["0.2 m/s", "0 m/s", "0 m/s"]
[[wall]]
name = "floor"
kind = "plane"
point = ["0 mm", "0 mm", "0 mm"]
normal = [0, 0, 1]
material = "glass"
)toml"},
  };
  return texts;
}

}  // namespace ejecta
