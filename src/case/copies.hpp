#pragma once
#include "case/case.hpp"

namespace ejecta {

/// The case with every [[body]] of `copies` > 1 written out: each copy has its own name, time of entry, place
/// in the box `spread` and, if asked for, orientation. The same case gives the same copies.
Case with_copies(const Case& c);

}  // namespace ejecta
