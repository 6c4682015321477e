#include "base/error.hpp"
#include "bindings.hpp"
#include "case/problem.hpp"
#include "simulation/forecast.hpp"

namespace ejecta::python {
namespace {

/// Raises the exception of that name of ejecta.errors.
template <class... More>
void raise(const char* name, const std::exception& e, More&&... more) {
  const py::object type = py::module_::import("ejecta.errors").attr(name);
  const py::object error = type(e.what(), std::forward<More>(more)...);
  PyErr_SetObject(type.ptr(), error.ptr());
}

py::list problems_of(const CaseError& e) {
  py::list list;
  for (const Problem& p : e.problems) list.append(as_object(problem_json(p)));
  return list;
}

}  // namespace

void bind_errors(py::module_&) {
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const CaseError& e) {
      raise("CaseError", e, problems_of(e));
    } catch (const InputError& e) {
      raise("InputError", e);
    } catch (const DivergedError& e) {
      raise("DivergedError", e);
    } catch (const Error& e) {
      raise("Error", e);
    }
  });
}

}  // namespace ejecta::python
