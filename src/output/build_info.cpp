#include "output/build_info.hpp"

#include "base/real.hpp"

namespace ejecta::output {

std::string_view version() { return EJECTA_VERSION; }
std::string_view git_revision() { return EJECTA_GIT_REVISION; }
std::string_view compiler() { return EJECTA_COMPILER; }
std::string_view compile_flags() { return EJECTA_COMPILE_FLAGS; }
std::string_view kernels() { return EJECTA_ARCH; }

}  // namespace ejecta::output
