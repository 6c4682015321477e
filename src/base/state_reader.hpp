#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "base/error.hpp"
#include "base/vec.hpp"

namespace ejecta {

/// Takes the numbers of a saved state one after another, in the order in which they were put there. What
/// cannot be (too few, too many, a count or an index out of range) throws Error: the state is of another case
/// or of another version of the program.
class StateReader {
 public:
  /// `name`: what the state is of, for the message.
  StateReader(std::span<const double> numbers, std::string name);

  double number() { return numbers(1)[0]; }
  std::span<const double> numbers(std::size_t count);
  Vec3 vec3() { return Vec3(numbers(3).data()); }
  /// A whole number between `least` and `most`.
  int whole(int least, int most);
  /// How many things of `numbers_each` numbers follow; there is room for so many.
  std::size_t count(std::size_t numbers_each);
  /// Nothing is left.
  void end() const;

 private:
  Error unfit(const std::string& what) const;

  std::span<const double> all_;
  std::size_t at_ = 0;
  std::string name_;
};

}  // namespace ejecta
