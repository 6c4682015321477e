#pragma once
#include "base/error.hpp"

namespace ejecta {

/// Tells the user what is wrong with the input.
void print_input_error(const InputError& e);

}  // namespace ejecta
