#pragma once
#include <string>

#include "case/case.hpp"

namespace ejecta {

/// Whether what happens at -y mirrors what happens at y, seen from the jet's axis.
struct Symmetry {
  bool sure = false;      ///< the case alone tells that it does
  std::string refused{};  ///< why it cannot be; "" where it may
};

/// Of a case in which the body of number `body` is moved across the belt and all else stays.
Symmetry symmetry_across(const Case& c, std::size_t body);

/// Of the case of a map: used where the case has it, unless it says otherwise.
bool map_is_symmetric(const Case& c);

/// The body that [map] moves; nothing of that name, or none on the belt: the number of bodies.
std::size_t mapped_body(const Case& c);

}  // namespace ejecta
