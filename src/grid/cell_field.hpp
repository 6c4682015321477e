#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>
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

/// The field of that name, which is one of them.
inline const CellField& field_named(std::span<const CellField> fields, std::string_view name) {
  return *std::ranges::find(fields, name, &CellField::name);
}

inline CellField vector_field(std::string name, ConstFieldView x, ConstFieldView y, ConstFieldView z) {
  return {std::move(name), {x, y, z}, 3};
}

}  // namespace ejecta
