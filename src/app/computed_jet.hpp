#pragma once
#include <memory>

#include "app/jet_source.hpp"

namespace ejecta {

/// The jet that jet.source_case computes with the valve of the box, at the height at which the box begins:
/// from the cache, else computed now and kept.
std::unique_ptr<JetSource> make_computed_jet(const Case& box);

}  // namespace ejecta
