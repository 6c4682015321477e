#pragma once
#include <tuple>

#include "base/vec.hpp"

namespace ejecta {

/// By x, then y, then z: any order that does not depend on how points came will do.
inline bool before(const Vec3& a, const Vec3& b) {
  return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
}

}  // namespace ejecta
