#pragma once
#include <memory>

#include "jet/source.hpp"

namespace ejecta {

/// The case that computes the jet of a box: its jet.source_case with the valve of the box. A trace of the
/// valve is the source's own. Throws InputError for a trace in the box.
Case computed_jet_case(const Case& box);

/// The jet that jet.source_case computes with the valve of the box, at the height at which the box begins:
/// stored, else computed now and kept.
std::unique_ptr<JetSource> make_computed_jet(const Case& box, const Note& note);

}  // namespace ejecta
