#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/stopwatch.hpp"
#include "base/text.hpp"

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
void bind_tools(py::module_& m);

/// What Python may do while something goes: look on, and end it by ^C, by True from the callback or by an
/// exception there, which is raised again once all is put away.
class Onlooker {
 public:
  explicit Onlooker(std::optional<py::object> callback = {}) : callback_(std::move(callback)) {}

  /// Calls the callback, if there is one; with the interpreter held.
  template <class... Seen>
  void show(Seen&&... seen) {
    if (!callback_ || stop_) return;
    try {
      const py::object answer = (*callback_)(std::forward<Seen>(seen)...);
      stop_ = answer.ptr() == Py_True;
    } catch (py::error_already_set& e) {
      keep(e);
    }
  }
  bool looks_on() const { return callback_.has_value(); }
  /// Whether it is to end; asks the interpreter for ^C now and then.
  bool stop();
  void rethrow() {
    if (error_) throw py::error_already_set(std::move(*error_));
  }

 private:
  void keep(py::error_already_set& e) {
    error_.emplace(std::move(e));
    stop_ = true;
  }

  std::optional<py::object> callback_;
  std::optional<py::error_already_set> error_;
  bool stop_ = false;
  double looked_ = wall_seconds();
};

/// Tells a callable of Python a line.
Note told_to(const py::object& callable);

}  // namespace ejecta::python
