#pragma once
#include <array>
#include <string>
#include <utility>

#include "grid/field.hpp"

namespace ejecta {

/// A scalar (one component) or vector (three) at cell centres, without copying it: what is written is
/// scale * value + offset.
struct CellField {
  std::string name;
  std::array<ConstFieldView, 3> component{};
  int components = 1;
  double scale = 1.0, offset = 0.0;
};
inline CellField scalar_field(std::string name, ConstFieldView values, double scale = 1.0,
                              double offset = 0.0) {
  return {std::move(name), {values, {}, {}}, 1, scale, offset};
}

inline CellField vector_field(std::string name, ConstFieldView x, ConstFieldView y, ConstFieldView z) {
  return {std::move(name), {x, y, z}, 3};
}

}  // namespace ejecta
