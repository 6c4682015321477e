#pragma once
#include <string>
#include <vector>

namespace ejecta {

/// A formula in x, y, z (m) and t (s), e.g. "exp(-t) * sin(2 * pi * x)". Compiled once into a stack program;
/// evaluation is const, allocates nothing and may run in several threads at once.
/// Operators: + - * / ^ (to the right), comparisons and && || (1 or 0), cond ? a : b, parentheses. Constants:
/// pi, e. Functions: sin cos tan asin acos atan atan2 sinh cosh tanh exp log log10 sqrt abs floor min max
/// step(x) = x >= 0.
class Expression {
 public:
  Expression() = default;  ///< the constant 0
  /// Throws InputError with the column where it stops making sense.
  explicit Expression(const std::string& text);

  double operator()(double x, double y, double z, double t) const;

  bool is_constant() const { return !uses_space_ && !uses_time_; }
  bool uses_time() const { return uses_time_; }

 private:
  friend class ExpressionCompiler;
  enum class Op : unsigned char;
  struct Instruction {
    Op op;
    double value = 0.0;
  };
  std::vector<Instruction> program_;
  bool uses_space_ = false, uses_time_ = false;
};

}  // namespace ejecta
