#pragma once
#include "case/case.hpp"

namespace ejecta {

/// The case with every [[body]] of `copies` > 1 written out: each copy has its own name, time of entry, place
/// in the box `spread` and, if asked for, orientation. The same case gives the same copies.
Case with_copies(const Case& c);

/// The same with the first of the copies alone: what one looks at before a run, however many there will be.
Case with_first_copies(const Case& c);

}  // namespace ejecta
