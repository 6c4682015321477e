#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/vec.hpp"
#include "case/node.hpp"

/// What the user wrote, as plain structs in SI units. No behaviour. The schema (case/schema.cpp) is the only
/// place that knows the keys of the TOML file; everybody else reads these structs.
/// A member `foo_bar` of struct `Grid` under `Case::grid` is the key `grid.foo_bar`.
namespace ejecta {

enum class FlowSolver { none, incompressible, compressible, compressible_piso };
enum class TurbulenceModel { laminar, k_epsilon, k_omega_sst };
enum class Geometry { cartesian, axisymmetric };
enum class BoundaryType {
  velocity,
  total_pressure,
  pressure_outlet,
  wave_transmissive,
  free_stream,
  wall,
  moving_wall,
  slip,
  symmetry,
  periodic,
  jet
};
enum class JetKind { self_similar, velocity_inlet, computed };
enum class ValveShape { linear, smooth, exponential, trace };
enum class ShapeKind { sphere, box, multisphere, cluster, polyhedron, mesh, superquadric };
enum class Motion { free, fixed, prescribed };
enum class ContactLaw { hertz_mindlin, linear };
enum class WallKind { plane, plate, box, belt, mesh };
enum class RunUntil { time, verdict, rest };
enum class Presentation { independent, monolayer, feeder, file };
enum class ParticleForm { box, rock, sphere, cluster, mesh };
enum class SizeLaw { one, uniform, lognormal, rosin_rammler, sieves };
enum class WindowRule { fixed, by_size };
enum class GrainPacking { random, lattice };
enum class GrainDragLaw { none, stokes, schiller_naumann, di_felice, rong, koch_hill, gidaspow };
enum class GrainExchange { two_way, one_way };
enum class StudyDesign { grid, list, latin_hypercube, sobol };
enum class MapLying { given, turned, any };
enum class CampaignKind { run, jet, jet_sweep, map, study, sort };

/// [run]
struct RunSpec {
  std::string title;
  RunUntil until = RunUntil::time;  ///< "verdict": end_time is only the limit
  double end_time = 0.0;            ///< s
  double courant = 1.0;             ///< sum over directions of |u| dt / h (paper, Eq. 6)
  std::optional<double> time_step;  ///< s, fixed flow step; otherwise adaptive
  double time_step_max = 1e30;      ///< s
};

/// [environment]
struct EnvironmentSpec {
  Vec3 gravity{0, 0, -9.81};    ///< m/s2
  double pressure = 101325.0;   ///< Pa, absolute
  double temperature = 298.15;  ///< K
};

/// [fluid]: "air" takes density from the environment by the ideal gas law; otherwise a Newtonian liquid or
/// gas
struct FluidSpec {
  bool ideal_gas = true;
  double density = 0.0;        ///< kg/m3; for a gas filled in from the environment
  double viscosity = 1.85e-5;  ///< Pa s, dynamic
  double gamma = 1.4;
  double gas_constant = 287.05;  ///< J/kg/K
  double prandtl = 0.71;
  double prandtl_turbulent = 0.9;
};

/// [flow]
struct FlowSpec {
  FlowSolver solver = FlowSolver::incompressible;
  TurbulenceModel turbulence = TurbulenceModel::laminar;
  bool round_jet_correction = true;        ///< Pope 1978, k-epsilon only
  bool compressibility_correction = true;  ///< Sarkar 1991; compressible solvers only
  int corrections = 2;                     ///< pressure corrections a step, >= 2
  /// Uniform acceleration of the fluid besides gravity (drives a channel), m/s2
  Vec3 body_force{0, 0, 0};
};

/// [grid.x], [grid.y], [grid.z]: blocks between `points`, each with `cells` and `grading` (last/first cell)
struct AxisSpec {
  std::vector<double> points;  ///< m
  std::vector<int> cells;
  std::vector<double> grading;  ///< empty: 1 everywhere
};

/// [grid]; in axisymmetric geometry x is the radius, z the axis, y has one cell
struct GridSpec {
  Geometry geometry = Geometry::cartesian;
  double refinement = 1.0;  ///< applied to `cells` when the case is loaded, then 1 again
  double refined = 1.0;     ///< what it was
  std::array<AxisSpec, 3> axis;
};

/// State on a boundary or in a region. Strings are expressions in x, y, z, t (metres, seconds -> SI).
struct StateSpec {
  std::optional<std::array<std::string, 3>> velocity;  ///< m/s
  std::optional<std::string> pressure;                 ///< Pa: gauge for incompressible, absolute otherwise
  std::optional<std::string> density;                  ///< kg/m3, compressible
  std::optional<std::string> temperature;              ///< K, compressible
  std::optional<std::string> k;                        ///< m2/s2
  std::optional<std::string> epsilon;                  ///< m2/s3
};

/// [[boundary.z_min.patch]]: a disc on that face with a type of its own
struct PatchSpec {
  BoundaryType type = BoundaryType::velocity;
  Vec3 centre{0, 0, 0};
  double radius = 0.0;
  StateSpec state;
  double total_pressure = 0.0;  ///< Pa absolute
  double total_temperature = 0.0;
};

/// [boundary.x_min] ... [boundary.z_max], in the order x_min, x_max, y_min, y_max, z_min, z_max
struct BoundarySpec {
  BoundaryType type = BoundaryType::wall;
  StateSpec state;
  double total_pressure = 0.0;     ///< Pa absolute, 0: ambient
  double total_temperature = 0.0;  ///< K, 0: ambient
  std::vector<PatchSpec> patches;
};

/// [[initial]]: applied in order; a box, a disc/sphere or everywhere
struct InitialSpec {
  std::optional<std::array<Vec3, 2>> box;
  StateSpec state;
};

/// [valve]
struct ValveSpec {
  double supply_pressure = 801325.0;  ///< Pa absolute (the file says gauge or absolute)
  double supply_temperature = 0.0;    ///< K, 0: ambient
  double orifice_diameter = 1.8e-3;   ///< m (assumption: design.md section 6)
  double discharge_coefficient = 1.0;
  double opens_at = 0.0;    ///< s, the command
  double duration = 8e-3;   ///< s, length of the command
  double delay = 0.0;       ///< s, command to first movement
  double rise_time = 6e-3;  ///< s, 0 -> fully open
  double fall_time = 1e-3;  ///< s
  ValveShape shape = ValveShape::smooth;
  std::string trace;                ///< CSV file: time, opening 0..1
  std::vector<double> more_pulses;  ///< further opening times, s
};

/// [jet]: what enters the box through a boundary of type "jet"
struct JetSpec {
  JetKind kind = JetKind::self_similar;
  Vec3 nozzle{0, 0, 0};            ///< m, centre of the orifice
  Vec3 direction{0, 0, 1};         ///< along which the jet blows, of any length
  std::vector<Vec3> more_nozzles;  ///< m, further orifices of the same valve
  double velocity_decay = 0.0;     ///< B in U_c/U_0 = B d/(z - z0); 0: what keeps the momentum of the valve
  double spreading = 0.094;        ///< S = r_half/(z - z0)
  double virtual_origin = 0.0;     ///< z0/d
  double inlet_velocity = 0.0;     ///< m/s for "velocity-inlet"; 0: the momentum-equivalent velocity
  double turbulence_intensity = 0.05;
  std::string source_case;  ///< for "computed": the jet case
  /// `ejecta jet` also computes the incompressible jet of the momentum-equivalent velocity
  bool compare_incompressible = false;
  double far_field_from = 0.0;           ///< m from the orifice: B and S are fitted beyond; 0: 25 diameters
  std::vector<double> sweep_pressures;   ///< Pa absolute, supplies of `ejecta jet --sweep`, compressible
  std::vector<double> sweep_velocities;  ///< m/s, inlets of `ejecta jet --sweep`, incompressible
};

/// [[material]]
struct MaterialSpec {
  std::string name;
  double youngs_modulus = 5e6;  ///< Pa (paper, Table 2)
  double poisson_ratio = 0.45;
  double density = 2700.0;  ///< kg/m3
  double restitution = 0.3;
  double friction = 0.5;
  double rolling_friction = 0.0;
  double roughness = 0.0;  ///< m, sand-grain height
};

/// [[material_pair]]: overrides the combination of two materials
struct MaterialPairSpec {
  std::string a, b;
  std::optional<double> restitution, friction, rolling_friction;
};

/// [contact]
struct ContactSpec {
  ContactLaw law = ContactLaw::hertz_mindlin;
  double time_step_fraction = 0.1;  ///< of the smaller of Rayleigh and Hertz time
  std::optional<double> time_step;  ///< s
  bool allow_tension = false;       ///< at the end of contact; false: clamped, damping adjusted (F2)
  double linear_stiffness = 0.0;    ///< N/m, linear law
};

/// [[body]]
struct BodySpec {
  std::string name;
  ShapeKind shape = ShapeKind::sphere;
  double diameter = 0.0;                       ///< sphere
  Vec3 size{0, 0, 0};                          ///< box, superquadric, cluster: full edge lengths, m
  std::vector<std::array<double, 4>> spheres;  ///< multisphere: x, y, z, radius in body axes
  std::array<int, 3> cluster{3, 3, 3};    ///< spheres along each edge of the paper's cluster, inside `size`
  double sphere_diameter = 0.0;           ///< cluster
  std::vector<Vec3> vertices;             ///< polyhedron: convex hull of these
  std::string file;                       ///< mesh: STL; multisphere: STL to fit spheres to
  std::vector<std::string> files;         ///< mesh: STL of each convex part
  double fit_error = 0.0;                 ///< m, largest distance of what touches to the surface in `file`
  double scale = 1.0;                     ///< of the mesh
  std::array<double, 2> exponents{2, 2};  ///< superquadric
  std::string material;
  std::optional<double> density;  ///< kg/m3, else the material's
  bool true_box_mass = false;     ///< cluster: mass and inertia of the box it stands for
  std::optional<double> mass;     ///< kg, overrides
  Motion motion = Motion::free;
  Vec3 position{0, 0, 0};  ///< m, of the centre of mass at release
  Vec3 velocity{0, 0, 0};  ///< m/s; of a formula its value at t = 0
  Vec3 spin{0, 0, 0};      ///< rad/s, world axes; likewise
  /// Formulas in t of a prescribed body, where its velocity or spin is no constant
  std::optional<std::array<std::string, 3>> velocity_formula, spin_formula;
  std::string path;  ///< prescribed: CSV file of its way, added to position and rotation_angle
  Vec3 rotation_axis{0, 0, 1};
  double rotation_angle = 0.0;  ///< rad
  double release_at = 0.0;      ///< s, body rests as placed until then
  bool on_belt = false;         ///< placed by [launch] instead of position/velocity
  double along = 0.0;           ///< m, on the belt, ahead of where [launch] has it (+x)
  double across = 0.0;          ///< m, on the belt, beside it (+y)
  std::string behind;           ///< on the belt: name of the body that goes ahead of it
  double gap = 0.0;             ///< m, to that body, between the two surfaces along x
  std::optional<bool> wanted;   ///< whether it ought to be ejected
  /// s, not there before, and not while another body is in its place; unset: there from the start
  std::optional<double> enters_at;
  int copies = 1;        ///< copies; more than one enter one after the other
  double every = 0.0;    ///< s, between the copies
  Vec3 spread{0, 0, 0};  ///< m, edges of the box about `position` in which copies are placed at random
  bool random_rotation = false;  ///< copies are turned at random
};

/// [[grains]]: many spheres, each far smaller than a cell, that the fluid drags along
struct GrainsSpec {
  std::string name;
  std::string material;
  std::optional<double> density;  ///< kg/m3, else the material's
  SizeLaw sizes = SizeLaw::one;   ///< by number
  double size = 0.0;              ///< m, diameter
  double size_to = 0.0;           ///< m, upper end of "uniform"
  double spread = 0.0;            ///< lognormal: of ln(size); Rosin-Rammler: its exponent
  std::string sieves;             ///< CSV of sieves
  // How many there are, by one of these:
  int count = 0;
  std::optional<double> mass;                 ///< kg
  std::optional<double> solids_fraction;      ///< of the region's volume
  std::optional<std::array<Vec3, 2>> region;  ///< m, lower and upper corner; where there is no box: needed
  GrainPacking packing = GrainPacking::random;
  Vec3 velocity{0, 0, 0};  ///< m/s, at the start
  bool held = false;       ///< they stay where they are
  double from = 0.0;       ///< s, not there before
  double over = 0.0;       ///< s, from then on they come one after the other, evenly
  std::int64_t seed = 1;   ///< of places and sizes
};

/// [coupling]: how grains and fluid act on each other
struct CouplingSpec {
  GrainDragLaw drag = GrainDragLaw::di_felice;
  GrainExchange exchange = GrainExchange::two_way;
  double kernel_width = 3.0;  ///< over which a grain is mapped, in grain diameters
  bool dispersion = false;    ///< of grains by turbulence
};

/// [launch]: the free flight from the belt to the jet (paper 2.2.5). The body crosses the jet's axis
/// (x = offset) at `arrives_at` if no air acts.
struct LaunchSpec {
  bool enabled = false;
  double belt_speed = 3.0;     ///< m/s, +x
  double drop_distance = 0.1;  ///< m, horizontal distance flown from the end of the belt to the jet
  double stand_off = 75e-3;    ///< m, height of the body's centre above the nozzle as it crosses the axis
  double arrives_at = 4e-3;    ///< s
  double offset_along = 0.0;   ///< m, added to x (paper's primary axis)
  double offset_across = 0.0;  ///< m, added to y
};

/// [[wall]]
struct WallSpec {
  std::string name;
  WallKind kind = WallKind::plane;
  Vec3 point{0, 0, 0};     ///< m; mesh: where the origin of its file lies
  Vec3 normal{0, 0, 1};    ///< towards the bodies
  Vec3 size{0, 0, 0};      ///< plate: extents along its two tangents and thickness; box: edges
  Vec3 velocity{0, 0, 0};  ///< surface velocity (belt)
  std::string material;
  std::string file;             ///< mesh
  double scale = 1.0;           ///< of the mesh
  Vec3 rotation_axis{0, 0, 1};  ///< mesh and box, about `point`
  double rotation_angle = 0.0;  ///< rad
  bool two_sided = false;       ///< mesh that is open: bodies meet its back too
};

/// [splitter]: the dividing plate. A body is ejected when its centre passes above the edge.
struct SplitterSpec {
  bool enabled = false;
  /// m, x and z of the edge from jet.nozzle: a plate that is bolted to the machine. Else:
  std::optional<std::array<double, 2>> edge;
  double distance = 0.25;   ///< m, +x from the jet's axis to the edge
  double height = 0.018;    ///< m, edge above the path of the undisturbed body there
  double thickness = 2e-3;  ///< m
  double length = 0.1;      ///< m, downstream extent
  bool solid = true;        ///< a wall that bodies hit, not only a line that decides
  std::string material;     ///< empty: that of the first body
};

/// [[probe]], [[line]], [[slice]]
struct ProbeSpec {
  std::string name;
  Vec3 position{0, 0, 0};
  double diameter = 0.0;       ///< m, averaged over (transducer 2 mm)
  double response_time = 0.0;  ///< s, first-order lag (transducer 1 ms)
};
struct LineSpec {
  std::string name;
  Vec3 from{0, 0, 0}, to{0, 0, 0};
  int points = 100;
};
struct SliceSpec {
  std::string name;
  int axis = 1;  ///< normal
  double position = 0.0;
};

/// [[measured]]: a measurement that `ejecta jet` draws into its figures and compares with
struct MeasuredSpec {
  std::string of;    ///< "centreline", or the name of a line or a probe
  std::string file;  ///< CSV: position along it in m (a probe: time in s), total gauge pressure in Pa
};

/// [output]
struct OutputSpec {
  double fields_interval = 0.0;   ///< s, 0: none
  double history_interval = 0.0;  ///< s, 0: every step
  double slices_interval = 0.0;   ///< s
  bool report = true;
  std::vector<std::string> fields;  ///< empty: all
};

/// [checkpoint]
struct CheckpointSpec {
  std::int64_t every_steps = 0;
  double every_time = 0.0;       ///< s, simulated
  double every_wall_time = 0.0;  ///< s
};

/// [exact]: expressions in x, y, z, t; result.json then holds error norms
struct ExactSpec {
  std::optional<std::array<std::string, 3>> velocity;
  std::optional<std::string> pressure, density, k;
  std::array<std::string, 3> source{"0", "0", "0"};  ///< manufactured momentum source, m/s2
};

/// [[expect]]: what `ejecta validate` compares with result.json
struct ExpectSpec {
  std::string quantity;  ///< JSON pointer into result.json, e.g. "/bodies/0/drag_coefficient"
  double reference = 0.0;
  std::optional<double> tolerance;  ///< absolute
  std::optional<double> relative_tolerance;
  std::optional<double> at_least, at_most;
  bool converging = false;  ///< with [convergence]: from grid to grid the value must change less
  std::string text;         ///< expected string instead of a number
  std::string source;
};

/// [convergence]: `ejecta validate` repeats the case with cells times each factor; result gets observed
/// orders
struct ConvergenceSpec {
  std::vector<double> factors;
  bool scale_time_step = true;
};

/// [stream]: free stream for drag coefficients
struct StreamSpec {
  bool enabled = false;
  Vec3 velocity{0, 0, 0};       ///< m/s
  double reference_area = 0.0;  ///< m2, 0: projected area of the body
  double average_from = 0.0;    ///< s, means are taken from here on
};

/// [domain]: where bodies live
struct DomainSpec {
  std::vector<double> x, y, z;        ///< m, lower and upper; empty: without end
  std::vector<std::string> periodic;  ///< "x", "y", "z"
};

/// [[study.vary]]: a key that a study varies. Values as they were written: they are read as those of the key.
struct VarySpec {
  std::string key;               ///< e.g. "valve.supply_pressure", "body.0.size"
  std::vector<Node> values;      ///< or
  std::optional<Node> from, to;  ///< a range
  int steps = 0;                 ///< of a range in a grid or a list: values with both ends
};

/// [study]: many runs of a case that differ in some keys
struct StudySpec {
  bool enabled = false;
  StudyDesign design = StudyDesign::grid;
  int samples = 0;                      ///< of a Latin hypercube or a Sobol sequence
  std::int64_t seed = 1;                ///< of these
  std::vector<std::string> quantities;  ///< JSON pointers into result.json
  bool keep_runs = true;                ///< each run directory with its report; else only the numbers
  std::vector<VarySpec> vary;
};

/// [map]: the places around the jet from which a body is ejected
struct MapSpec {
  bool enabled = false;
  std::string body;                    ///< empty: the first on the belt
  std::array<double, 2> along{0, 0};   ///< m, window: where the body is at launch.arrives_at, +x
  std::array<double, 2> across{0, 0};  ///< m, the same across the belt, +y
  std::optional<bool> symmetric;       ///< about y of the jet; unset: where the case is
  std::array<double, 2> grid{0, 0};    ///< m, along and across: runs at every place of it; 0: chosen
  double coarse_refinement = 0.5;      ///< grid.refinement of the coarse runs over that of the fine; 1: none
  int max_runs = 35;                   ///< of both
  int max_fine_runs = 15;              ///< where there are coarse runs
  int runs_at_once = 4;                ///< asked for together
  double area_error = 0.02;            ///< of the area: the map is finished
  std::array<double, 2> plate_error{0, 0};  ///< m, along x and z: the edge lies within this
  MapLying lying = MapLying::given;         ///< of the bodies of the class that is mapped
  std::array<double, 2> size_factor{1, 1};  ///< their sizes over the body's, evenly distributed between these
  std::array<double, 2> arrival_error{0, 0};  ///< m, along and across: standard deviation of where they come
  std::int64_t seed = 1;                      ///< of the draws behind the errors
  std::string measured;                       ///< CSV of a measured outline

  bool is_on_grid() const { return grid[0] > 0.0 && grid[1] > 0.0; }
  /// Runs differ in more than their place: a verdict is a matter of chance.
  bool is_of_class() const { return lying != MapLying::given || size_factor[0] != size_factor[1]; }
  /// The map is a chance of ejection.
  bool is_of_chance() const { return is_of_class() || arrival_error[0] > 0.0 || arrival_error[1] > 0.0; }
};

/// [[campaign.part]]: one command of a campaign
struct CampaignPartSpec {
  CampaignKind kind = CampaignKind::run;
  std::string file;              ///< the case
  std::string title;             ///< empty: that of the case
  std::string figures;           ///< what it remakes, e.g. "Figure 10"
  std::vector<std::string> set;  ///< "section.key=value", as --set
};

/// [campaign]: a programme of runs, jets, maps and studies with one report
struct CampaignSpec {
  bool enabled = false;
  std::string title;
  std::vector<CampaignPartSpec> parts;
};

/// [sorter]: a whole machine, feed to products. Belt speed, flight and plate are those of [launch] and
/// [splitter], the jet of one valve that of [valve] and [jet].
struct SorterSpec {
  bool enabled = false;
  double throughput = 0.0;   ///< kg/s
  int particles = 10000;     ///< that pass, about
  double belt_width = 0.55;  ///< m
  std::int64_t seed = 1;     ///< of all that chance decides
  int shown = 300;           ///< particles in the report's view
  bool encounters = true;    ///< particles push and shelter each other in the air
};

/// [sorter.feed]: how particles lie on the belt
struct FeedSpec {
  Presentation presentation = Presentation::monolayer;
  double arrival_scatter = 0.0;  ///< s, standard deviation of when a particle comes to the jet
  double place_scatter = 0.0;    ///< m, and of where across the belt
  std::string file;              ///< CSV of places, for "file"
  double lip_speed = 1.0;        ///< m/s, "feeder": of the particles on its tray, along the belt
  double lip_height = 0.1;       ///< m, of the tray above the belt
  double lip_distance = 2.0;     ///< m, along the belt from the lip to the camera's line
};

/// [[sorter.class]]: particles of one kind
struct ParticleClassSpec {
  std::string name;
  double share = 0.0;  ///< of the mass of the feed
  bool eject = false;  ///< belongs in the ejected product
  double density = 2700.0;
  ParticleForm form = ParticleForm::box;
  SizeLaw sizes = SizeLaw::one;
  double size = 0.0;                    ///< m: the middle one of its three dimensions, what a sieve tells
  double size_to = 0.0;                 ///< m, upper end of "uniform"
  double spread = 0.0;                  ///< lognormal: of ln(size); Rosin-Rammler: its exponent
  std::string sieves;                   ///< CSV of sieves
  double elongation = 1.0;              ///< middle over longest dimension
  double flatness = 1.0;                ///< shortest over middle dimension
  std::string file;                     ///< mesh: STL
  double signal = 0.0;                  ///< what the sensor reads of it, any scale
  double signal_spread = 0.0;           ///< standard deviation from particle to particle
  std::optional<double> read_as_eject;  ///< share that is read as to be ejected, instead of signals
};

/// [sorter.camera]
struct CameraSpec {
  int pixels = 2048;                ///< across the belt
  double gap = 0.5e-3;              ///< m, nearer particles are seen as one
  int least_pixels = 4;             ///< smaller objects are not seen
  double noise = 0.0;               ///< of the signal of a pixel, standard deviation
  std::optional<double> threshold;  ///< between keep and eject
  double distance = 0.5;            ///< m, from its line to the jets along the path
  double computing_time = 50e-3;    ///< s, from the last line of an object to its commands
};

/// [sorter.controller]
struct ControllerSpec {
  WindowRule window = WindowRule::fixed;
  double duration = 8e-3;     ///< s, of a command by the fixed rule
  double step = 1e-3;         ///< s, commands begin at whole steps; 0: whenever
  double lead = 6e-3;         ///< s, the command comes before the object's centre (by_size: its front)
  double quantile = 2.0;      ///< of the errors of time and place that the window covers
  double time_error = 0.0;    ///< s, standard deviation that it reckons with
  double place_error = 0.0;   ///< m
  int valves = 0;             ///< a shot; 0: by the object's width
  double shortest_on = 0.0;   ///< s
  double shortest_off = 0.0;  ///< s: shorter breaks are not taken
};

/// [sorter.manifold]
struct ManifoldSpec {
  int valves = 128;
  double pitch = 0.0;            ///< m; 0: belt width over valves
  double dead = 0.0;             ///< share of valves that do not open
  std::vector<int> dead_valves;  ///< and these, from 0
  double delay_spread = 0.0;     ///< s, standard deviation from valve to valve
  double vessel = 0.0;           ///< m3, that all valves draw from; 0: the supply never falls
  double line_diameter = 0.0;    ///< m, of the line that feeds it
};

struct Case {
  std::string path;                ///< of the file it came from; relative names inside are relative to it
  std::vector<std::string> bases;  ///< paths of the files that it extends
  std::set<std::string> given;     ///< keys that the user wrote, e.g. "valve.rise_time", "body.0.size"
  RunSpec run;
  EnvironmentSpec environment;
  FluidSpec fluid;
  FlowSpec flow;
  GridSpec grid;
  std::array<BoundarySpec, 6> boundary;
  std::vector<InitialSpec> initial;
  ValveSpec valve;
  JetSpec jet;
  std::vector<MaterialSpec> materials;
  std::vector<MaterialPairSpec> material_pairs;
  ContactSpec contact;
  std::vector<BodySpec> bodies;
  std::vector<GrainsSpec> grains;
  CouplingSpec coupling;
  DomainSpec domain;
  LaunchSpec launch;
  std::vector<WallSpec> walls;
  SplitterSpec splitter;
  StreamSpec stream;
  std::vector<ProbeSpec> probes;
  std::vector<LineSpec> lines;
  std::vector<SliceSpec> slices;
  std::vector<MeasuredSpec> measured;
  OutputSpec output;
  CheckpointSpec checkpoint;
  ExactSpec exact;
  std::vector<ExpectSpec> expects;
  ConvergenceSpec convergence;
  StudySpec study;
  MapSpec map;
  CampaignSpec campaign;  ///< such a file has nothing else
  SorterSpec sorter;
  FeedSpec feed;
  std::vector<ParticleClassSpec> classes;
  CameraSpec camera;
  ControllerSpec controller;
  ManifoldSpec manifold;
};

inline bool is_incompressible(const Case& c) { return c.flow.solver == FlowSolver::incompressible; }

}  // namespace ejecta
