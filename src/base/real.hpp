#pragma once

namespace ejecta {

/// Scalar of the fields. Bodies, time, sums and the ledger are always double.
#ifdef EJECTA_DOUBLE
using Real = double;
#else
using Real = float;
#endif

/// "float" or "double".
inline constexpr const char* kPrecision = sizeof(Real) == sizeof(double) ? "double" : "float";

}  // namespace ejecta
