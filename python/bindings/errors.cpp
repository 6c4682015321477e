#include "base/error.hpp"
#include "base/told.hpp"
#include "bindings.hpp"
#include "case/problem.hpp"
#include "simulation/forecast.hpp"

namespace ejecta::python {
namespace {

/// Raises the exception of that name of ejecta.errors.
template <class... More>
void raise(const char* name, const std::string& words, More&&... more) {
  const py::object type = py::module_::import("ejecta.errors").attr(name);
  const py::object error = type(words, std::forward<More>(more)...);
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
      raise("CaseError", e.what(), problems_of(e));
    } catch (const InputError& e) {
      raise("InputError", told(e));
    } catch (const DivergedError& e) {
      raise("DivergedError", e.what());
    } catch (const Error& e) {
      raise("Error", e.what());
    }
  });
}

}  // namespace ejecta::python
