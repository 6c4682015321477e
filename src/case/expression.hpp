#pragma once
#include <string>
#include <vector>

namespace ejecta {

/// A formula in x, y, z (m) and t (s), e.g. "exp(-t) * sin(2 * pi * x)". Compiled once into a stack program;
/// evaluation is const, allocates nothing and may run in several threads at once.
///
/// Operators, loosest first: cond ? a : b; ||; &&; < <= > >= (1 or 0); + -; * /; sign; ^ (to the right).
/// Constants: pi, e. Functions: sin cos tan asin acos atan atan2 sinh cosh tanh exp log (= ln) log10 sqrt abs
/// floor min max pow, and step(x) = 1 where x >= 0, else 0.
class Expression {
 public:
  Expression() = default;  ///< the constant 0
  /// Throws InputError with the column where it stops making sense.
  explicit Expression(const std::string& text);

  double operator()(double x, double y, double z, double t) const;

  bool is_constant() const { return !uses_space_ && !uses_time_; }
  bool uses_time() const { return uses_time_; }
  bool uses_space() const { return uses_space_; }

 private:
  friend class ExpressionCompiler;
  using Function1 = double (*)(double);
  using Function2 = double (*)(double, double);
  enum class Kind : unsigned char { constant, x, y, z, t, one, two, choose };
  struct Instruction {
    Kind kind;
    double value = 0.0;
    Function1 one = nullptr;
    Function2 two = nullptr;
  };
  std::vector<Instruction> program_;
  bool uses_space_ = false, uses_time_ = false;
};

}  // namespace ejecta
