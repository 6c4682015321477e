#pragma once
#include <string>

#include "base/error.hpp"

namespace ejecta {

/// What is wrong and what helps, as every way to the user tells it.
inline std::string told(const InputError& e) {
  std::string text = e.what();
  if (!e.advice.expected.empty()) text += "\n  expected: " + e.advice.expected;
  if (!e.advice.example.empty()) text += "\n  example:  " + e.advice.example;
  return text;
}

}  // namespace ejecta
