#pragma once

namespace ejecta {

/// Sum of kernel(i) over [i0, i1) in double, in SIMD lanes of fixed width: what reduce_sum() does with a row.
template <class Kernel>
inline double row_sum(int i0, int i1, const Kernel& kernel) {
  double sum = 0.0;
#pragma omp simd reduction(+ : sum)
  for (int i = i0; i < i1; ++i) sum += static_cast<double>(kernel(i));
  return sum;
}

}  // namespace ejecta
