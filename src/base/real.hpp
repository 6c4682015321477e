#pragma once

namespace ejecta {

/// Scalar of the fields. Bodies, time, sums and the ledger are always double.
#ifdef EJECTA_DOUBLE
using Real = double;
#else
using Real = float;
#endif

}  // namespace ejecta
