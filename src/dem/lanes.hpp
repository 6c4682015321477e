#pragma once
#include <cmath>

/// Numbers in lanes: a contact law is written once for T = double and runs on eight contacts at once with
/// T = Lanes.
namespace ejecta {

constexpr int kLanes = 8;
/// A call with a dozen lanes of arguments would pass them through memory.
#define EJECTA_INLINE [[gnu::always_inline]] inline
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));

inline double root(double v) { return std::sqrt(v); }
inline Lanes root(const Lanes& v) {
  Lanes r;
  for (int n = 0; n < kLanes; ++n) r[n] = std::sqrt(v[n]);
  return r;
}
inline double larger(double a, double b) { return a > b ? a : b; }
inline Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }

/// Three components, each a number or lanes of numbers.
template <class T>
struct Triple {
  T x{}, y{}, z{};

  bool operator==(const Triple&) const = default;
  Triple& operator+=(const Triple& o) {
    x += o.x;
    y += o.y;
    z += o.z;
    return *this;
  }
};
template <class T>
Triple<T> operator+(const Triple<T>& a, const Triple<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
Triple<T> operator-(const Triple<T>& a, const Triple<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
Triple<T> operator*(const T& s, const Triple<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
T dot(const Triple<T>& a, const Triple<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace ejecta
