#include <dlfcn.h>

#include "bindings.hpp"
#include "output/build_info.hpp"
#include "validation/validation.hpp"

namespace {

/// The file of the library that is in use.
std::filesystem::path library() {
  Dl_info here{};
  ::dladdr(reinterpret_cast<const void*>(&ejecta::shipped_cases), &here);
  return std::filesystem::canonical(here.dli_fname);
}

}  // namespace

/// The compiled part of the module `ejecta`: what only C++ can do, in plain values. What users see is
/// python/ejecta.
PYBIND11_MODULE(_core, m) {
  using namespace ejecta;
  m.attr("version") = output::version();
  m.attr("revision") = output::git_revision();
  m.attr("kernels") = output::kernels();
  m.attr("library") = library().string();
  python::bind_errors(m);
  python::bind_case(m);
  python::bind_run(m);
  python::bind_shape(m);
  python::bind_tools(m);
}
