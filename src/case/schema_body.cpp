#include "case/schema.hpp"

/// What flies and what it meets: materials, contacts, bodies, walls.
namespace ejecta {

using enum Dimension;

std::vector<Key> keys(MaterialSpec& s) {
  return {
      {.name = "name",
       .slot = &s.name,
       .help = "Name that bodies and walls refer to",
       .required = true,
       .example = "\"quartz\""},
      {"youngs_modulus", &s.youngs_modulus, pressure, positive, "Young's modulus", "paper, Table 2"},
      {"poisson_ratio", &s.poisson_ratio, none, {-1.0, 0.5, true}, "Poisson's ratio", "paper, Table 2"},
      decisive(Key{"density", &s.density, density, positive, "Density", "paper, Table 2"}),
      {"restitution", &s.restitution, none, {0.01, 1.0}, "Coefficient of restitution", "paper, Table 2"},
      {"friction", &s.friction, none, not_negative, "Coefficient of sliding friction", "paper, Table 2"},
      {"rolling_friction", &s.rolling_friction, none, not_negative, "Coefficient of rolling friction", ""},
      {"roughness", &s.roughness, length, not_negative,
       "Height of the sand grains that make a surface as rough as this one, for the air's friction on it in "
       "turbulent flow; 0 is smooth",
       "Colebrook 1939"}};
}

std::vector<Key> keys(MaterialPairSpec& s) {
  return {
      {.name = "a", .slot = &s.a, .help = "Name of one material", .required = true, .example = "\"quartz\""},
      {.name = "b", .slot = &s.b, .help = "Name of the other", .required = true, .example = "\"steel\""},
      {"restitution",
       &s.restitution,
       none,
       {0.01, 1.0},
       "Coefficient of restitution between the two",
       "",
       "combined"},
      {"friction", &s.friction, none, not_negative, "Coefficient of sliding friction between the two", "",
       "combined"},
      {"rolling_friction", &s.rolling_friction, none, not_negative,
       "Coefficient of rolling friction between the two", "", "combined"}};
}

std::vector<Key> keys(ContactSpec& s) {
  return {{"law", choice(s.law), none, anything, "Contact law", "paper 2.2.2"},
          {"time_step_fraction",
           &s.time_step_fraction,
           none,
           {0.0, 0.5, true},
           "Contact step over the smaller of Rayleigh and Hertz time",
           "usual 0.1 to 0.3"},
          {"time_step", &s.time_step, time, positive,
           "Fixed contact step; shorter only where bodies would step through each other", "",
           "from time_step_fraction", false, "\"1 us\""},
          {"allow_tension", &s.allow_tension, none, anything,
           "Let the damped Hertz force pull at the end of a contact; false: clamped at zero, damping "
           "adjusted to keep the restitution",
           "Antypov & Elliott 2011"},
          {"linear_stiffness", &s.linear_stiffness, stiffness, not_negative,
           "Normal stiffness, for the linear law", "", "needed for the linear law"}};
}

std::vector<Key> keys(BodySpec& s) {
  return {
      {.name = "name",
       .slot = &s.name,
       .help = "Name in results",
       .unset = "body-1, body-2, ...",
       .example = "\"cube\""},
      {"shape", choice(s.shape), none, anything, "Shape", ""},
      {"diameter", &s.diameter, length, not_negative, "Of a sphere", "", "needed for a sphere"},
      {"size", &s.size, length, not_negative, "Full edge lengths of a box, cluster or superquadric",
       "paper, Table 1", "needed for these shapes"},
      {.name = "spheres",
       .slot = &s.spheres,
       .dimension = length,
       .help = "Multisphere: [x, y, z, radius] of each, in body axes",
       .unset = "needed for a multisphere",
       .example = R"([["0 mm", "0 mm", "0 mm", "5 mm"], ["4 mm", "0 mm", "0 mm", "3 mm"]])"},
      {"cluster",
       &s.cluster,
       none,
       {1, 100},
       "Cluster: spheres along each edge of `size`",
       "paper 2.2.5: 27 or 9 spheres"},
      {"sphere_diameter", &s.sphere_diameter, length, not_negative, "Cluster: diameter of each sphere",
       "paper 2.2.5: 5 or 10 mm", "needed for a cluster", false, "\"5 mm\""},
      {.name = "vertices",
       .slot = &s.vertices,
       .dimension = length,
       .help = "Polyhedron: convex hull of these points, in body axes",
       .unset = "needed for a polyhedron",
       .example =
           R"([["0 mm", "0 mm", "0 mm"], ["9 mm", "0 mm", "0 mm"], ["0 mm", "9 mm", "0 mm"], ["0 mm", "0 mm", "9 mm"]])"},
      {.name = "file",
       .slot = &s.file,
       .help = "Mesh, or multisphere with fit_error: closed STL surface, beside the case file",
       .unset = "needed for a mesh",
       .example = "\"lump.stl\"",
       .file = true},
      {.name = "files",
       .slot = &s.files,
       .help = "Mesh of several STL surfaces that may touch but not share space, instead of `file`",
       .unset = "none",
       .example = R"(["head.stl", "tail.stl"])",
       .file = true},
      {"fit_error", &s.fit_error, length, not_negative,
       "Largest distance between the surface in `file` and that of the spheres fitted into it (multisphere) "
       "or "
       "of the convex parts it is divided into (mesh)",
       "", "exactly divided (mesh); needed to fit spheres", false, "\"0.5 mm\""},
      {"scale", &s.scale, none, positive, "Mesh: factor from the units of the file to metres (0.001 for mm)",
       ""},
      {"exponents", &s.exponents, none, positive,
       "Superquadric: exponents across and along; 2, 2 is an ellipsoid", ""},
      {.name = "material",
       .slot = &s.material,
       .help = "Name of a [[material]]",
       .unset = "the first [[material]], or one with the defaults",
       .example = "\"quartz\""},
      {"density", &s.density, density, positive, "Density", "", "the material's"},
      {"true_box_mass", &s.true_box_mass, none, anything,
       "Cluster: mass and inertia of the full box it stands for", "27 spheres fill 80 %, 9 fill 72 % of it"},
      {"mass", &s.mass, mass, positive, "Mass; inertia scales with it", "", "density times volume"},
      {"motion", choice(s.motion), none, anything, "How it moves", ""},
      {"position", &s.position, length, anything, "Centre of mass at the start", ""},
      {"velocity", VectorOrFormulas{&s.velocity, &s.velocity_formula}, velocity, anything,
       "Velocity at release; of a prescribed body also formulas in t (s) in SI units, each starting with "
       "\"=\"",
       ""},
      {"spin", VectorOrFormulas{&s.spin, &s.spin_formula}, angular_velocity, anything,
       "Angular velocity at release, world axes; of a prescribed body also formulas in t", ""},
      {.name = "path",
       .slot = &s.path,
       .help = "Prescribed: CSV file beside the case file, head `t [ms], x [mm], y [mm], z [mm], rotation "
               "[deg]` (columns that are not needed left out); added to `position` and `rotation_angle`; "
               "monotone cubic in between",
       .source = "Fritsch & Butland 1984",
       .unset = "none",
       .example = "\"path.csv\"",
       .file = true},
      {"rotation_axis", &s.rotation_axis, none, anything, "Axis of the initial orientation", ""},
      {"rotation_angle", &s.rotation_angle, angle, anything,
       "Angle of the initial orientation about rotation_axis", ""},
      {"release_at", &s.release_at, time, not_negative, "The body rests as placed until then", ""},
      {"enters_at", &s.enters_at, time, not_negative,
       "The body is not there before, and waits while another is in its place", "", "there from the start",
       false, "\"0.5 s\""},
      {"copies",
       &s.copies,
       none,
       {1, 1000000},
       "Copies of the body; more than one enter one after the other",
       ""},
      {"every", &s.every, time, not_negative, "Time between the copies", ""},
      {"spread", &s.spread, length, not_negative,
       "Edges of the box about `position` in which copies are placed at random", ""},
      {"random_rotation", &s.random_rotation, none, anything, "Copies are turned at random", ""},
      {"on_belt", &s.on_belt, none, anything,
       "Comes from the belt by [launch], which gives position and velocity", ""},
      {"along", &s.along, length, anything,
       "On the belt: how far it lies ahead of the place that [launch] gives; negative: behind", ""},
      {"across", &s.across, length, anything, "On the belt: how far it lies beside that place, along +y", ""},
      {.name = "behind",
       .slot = &s.behind,
       .help = "On the belt: name of the [[body]] that goes ahead of it, with `gap` between the two",
       .unset = "none",
       .example = "\"cube\""},
      {"gap", &s.gap, length, not_negative,
       "On the belt: free belt, along x, between its surface and that of the body it is `behind`", "", "",
       false, "\"12 mm\""},
      {.name = "wanted",
       .slot = &s.wanted,
       .help = "Whether it ought to be ejected: the verdict is then right, by-catch or missed",
       .unset = "not said: the verdict is ejected or not",
       .example = "true"}};
}

std::vector<Key> keys(DomainSpec& s) {
  const auto extent = [](const char* axis, std::vector<double>* slot) {
    return Key{.name = axis,
               .slot = slot,
               .dimension = length,
               .help = std::string("Lower and upper end in ") + axis,
               .unset = "without end",
               .example = R"(["0 mm", "200 mm"])"};
  };
  return {extent("x", &s.x),
          extent("y", &s.y),
          extent("z", &s.z),
          {.name = "periodic",
           .slot = &s.periodic,
           .help = "Directions in which a body that leaves comes back on the other side",
           .unset = "none",
           .example = R"(["y"])"}};
}

std::vector<Key> keys(WallSpec& s) {
  return {
      {.name = "name",
       .slot = &s.name,
       .help = "Name in results",
       .unset = "wall-1, wall-2, ...",
       .example = "\"floor\""},
      {"kind", choice(s.kind), none, anything, "Kind of wall", ""},
      {"point", &s.point, length, anything,
       "A point of the plane, or the centre; mesh: where the origin of its file lies", ""},
      {"normal", &s.normal, none, anything, "Direction towards the bodies", ""},
      {"size", &s.size, length, not_negative,
       "Plate and belt: extents along the two tangents and thickness; box: edges", "",
       "needed for plate and box; a belt is endless"},
      {"velocity", &s.velocity, velocity, anything, "Velocity of the surface", ""},
      {.name = "material",
       .slot = &s.material,
       .help = "Name of a [[material]]",
       .unset = "the first [[material]], or one with the defaults",
       .example = "\"steel\""},
      {.name = "file",
       .slot = &s.file,
       .help = "Mesh: STL surface, beside the case file",
       .unset = "needed for a mesh",
       .example = "\"chute.stl\"",
       .file = true},
      {"scale", &s.scale, none, positive, "Mesh: factor from the units of the file to metres (0.001 for mm)",
       ""},
      {"rotation_axis", &s.rotation_axis, none, anything, "Mesh and box: axis of a turn about `point`", ""},
      {"rotation_angle", &s.rotation_angle, angle, anything, "Mesh and box: angle of that turn", ""},
      {"two_sided", &s.two_sided, none, anything,
       "An open mesh touches on both sides, not only on that to which its normals look", ""}};
}

}  // namespace ejecta
