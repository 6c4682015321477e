#include "shape/shape.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/text.hpp"
#include "base/thread_budget.hpp"
#include "bindings.hpp"
#include "case/load.hpp"
#include "case_tree.hpp"
#include "dem/body.hpp"

namespace ejecta::python {
namespace {

Shape shape_of(const CaseTree& tree, const std::string& body) {
  const py::gil_scoped_release others_may_run;
  const ThreadBudget as_before(0);
  const Case c = tree.checked();
  std::vector<std::string> names;
  for (const BodySpec& b : c.bodies) {
    if (body.empty() || b.name == body) return make_shape(b, folder_of(c));
    names.push_back(b.name);
  }
  if (names.empty()) throw InputError("the case has no body\n  expected: a [[body]]");
  throw InputError(fmt::format("the case has no body \"{}\"; it has {}", body, joined(names)));
}

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;

py::array_t<double> signed_distance(const Shape& shape, const Points& points) {
  if (points.ndim() < 1 || points.shape(points.ndim() - 1) != 3)
    throw py::value_error("points need three coordinates each: an array of shape (..., 3), in m");
  const std::vector<py::ssize_t> outer(points.shape(), points.shape() + points.ndim() - 1);
  const py::ssize_t count = points.size() / 3;
  const double* x = points.data();
  std::vector<double> distance(static_cast<std::size_t>(count));
  {
    const py::gil_scoped_release others_may_run;
    for (std::size_t n = 0; n < distance.size(); ++n)
      distance[n] = shape.signed_distance(Vec3(x[3 * n], x[3 * n + 1], x[3 * n + 2]));
  }
  return as_array(std::move(distance), outer);
}

py::array_t<double> array_of(const Vec3& v) { return as_array(std::vector<double>{v.x(), v.y(), v.z()}); }

py::tuple surface(const Shape& shape, double tolerance) {
  const TriangleMesh mesh = shape.surface(tolerance);
  std::vector<double> vertices;
  for (const Vec3& v : mesh.vertices) vertices.insert(vertices.end(), {v.x(), v.y(), v.z()});
  std::vector<int> triangles;
  for (const auto& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  return py::make_tuple(as_array(std::move(vertices), {py::ssize_t(mesh.vertices.size()), 3}),
                        as_array(std::move(triangles), {py::ssize_t(mesh.triangles.size()), 3}));
}

}  // namespace

void bind_shape(py::module_& m) {
  py::class_<Shape>(
      m, "Shape",
      "A solid, in its own axes: origin in the centre of mass, along the principal axes. Lengths in m.")
      .def("signed_distance", &signed_distance, py::arg("points"),
           "Distance (m) of points (..., 3) to the surface, negative inside.")
      .def(
          "mass_properties",
          [](const Shape& shape, double density) {
            const MassProperties& unit = shape.mass_properties();
            py::dict of;
            of["volume"] = unit.volume;
            of["mass"] = density * unit.volume;
            of["inertia"] = array_of(density * unit.inertia.diagonal());
            return of;
          },
          py::arg("density"),
          "Volume (m3), mass (kg) and principal moments of inertia (kg m2) at a density (kg/m3).")
      .def("surface", &surface, py::arg("tolerance") = 0.0,
           "Vertices (n, 3) in m and triangles (m, 3) of the surface; chords stay within `tolerance` (m) of "
           "curved "
           "parts, 0: a hundredth of the bounding radius.")
      .def(
          "projected_area",
          [](const Shape& shape, std::array<double, 3> d) {
            return shape.projected_area(Vec3(d[0], d[1], d[2]));
          },
          py::arg("direction"), "Area (m2) of the shadow along a direction.")
      .def_property_readonly("bounding_radius", &Shape::bounding_radius,
                             "Radius (m) of the smallest sphere about the centre of mass that holds it.")
      .def_property_readonly("smallest_feature", &Shape::smallest_feature, "What a grid must resolve (m).")
      .def_property_readonly(
          "centre", [](const Shape& shape) { return array_of(shape.frame().centre); },
          "Centre of mass in the axes in which the shape was written (m).");
  m.def("shape_of", &shape_of, py::arg("case"), py::arg("body"));
}

}  // namespace ejecta::python
