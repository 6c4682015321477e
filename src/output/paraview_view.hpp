#pragma once
#include <filesystem>
#include <string>

namespace ejecta::output {

/// A Python state of ParaView that opens the fields of a run ready to look at: air coloured by its speed in
/// the recorded slices, or in the middle of the box, bodies in it, camera from the side, at the moment of the
/// fastest air. Throws InputError where the run has written no fields.
std::string paraview_view(const std::filesystem::path& run);

}  // namespace ejecta::output
