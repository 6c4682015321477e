#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace ejecta::python {

namespace py = pybind11;

/// The vector itself as an array of that shape: nothing is copied.
template <class T>
py::array_t<T> as_array(std::vector<T>&& values, const std::vector<py::ssize_t>& shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(shape, kept->data(), owner);
}
template <class T>
py::array_t<T> as_array(std::vector<T>&& values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return as_array(std::move(values), {size});
}

inline py::object as_object(const nlohmann::ordered_json& json) {
  return py::module_::import("json").attr("loads")(json.dump());
}

void bind_errors(py::module_& m);
void bind_case(py::module_& m);
void bind_run(py::module_& m);
void bind_shape(py::module_& m);

}  // namespace ejecta::python
