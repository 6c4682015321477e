#include "case/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include "base/error.hpp"

namespace ejecta {
namespace {
constexpr int max_stack = 32;  // depth of the evaluation stack; deeper formulas are refused at compile time
}

enum class Expression::Op : unsigned char {
  constant,
  x,
  y,
  z,
  t,
  negate,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  exp,
  log,
  log10,
  sqrt,
  abs,
  floor,
  step,
  add,
  subtract,
  multiply,
  divide,
  power,
  atan2,
  min,
  max,
  less,
  greater,
  less_equal,
  greater_equal,
  both,
  either,
  choose
};

/// Recursive descent from text to a stack program.
class ExpressionCompiler {
 public:
  using Op = Expression::Op;
  ExpressionCompiler(std::string_view text, Expression& out) : text_(text), out_(out) {}

  void compile() {
    choice();
    skip_blanks();
    if (at_ < text_.size()) fail(fmt::format("unexpected \"{}\"", text_[at_]));
  }

 private:
  static constexpr int max_nesting = 200;

  static const std::map<std::string_view, Op>& unary() {
    static const std::map<std::string_view, Op> names{
        {"sin", Op::sin},     {"cos", Op::cos},   {"tan", Op::tan},   {"asin", Op::asin},
        {"acos", Op::acos},   {"atan", Op::atan}, {"sinh", Op::sinh}, {"cosh", Op::cosh},
        {"tanh", Op::tanh},   {"exp", Op::exp},   {"log", Op::log},   {"ln", Op::log},
        {"log10", Op::log10}, {"sqrt", Op::sqrt}, {"abs", Op::abs},   {"floor", Op::floor},
        {"step", Op::step}};
    return names;
  }
  static const std::map<std::string_view, Op>& binary() {
    static const std::map<std::string_view, Op> names{
        {"atan2", Op::atan2}, {"min", Op::min}, {"max", Op::max}, {"pow", Op::power}};
    return names;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{} at column {} of the formula \"{}\"", what, at_ + 1, text_));
  }

  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
  }

  bool take(std::string_view token) {
    skip_blanks();
    if (!text_.substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }

  void expect(std::string_view token) {
    if (!take(token)) fail(fmt::format("\"{}\" expected", token));
  }

  void emit(Op op, double value = 0.0) {
    depth_ += op <= Op::t ? 1 : op <= Op::step ? 0 : op < Op::choose ? -1 : -2;
    if (depth_ > max_stack) fail("formula too deeply nested");
    out_.program_.push_back({op, value});
  }

  void choice() {
    if (++nesting_ > max_nesting) fail("formula too deeply nested");
    comparison();
    if (take("?")) {
      choice();
      expect(":");
      choice();
      emit(Op::choose);
    }
    --nesting_;
  }

  void comparison() {
    relation();
    while (true) {
      if (take("&&")) relation(), emit(Op::both);
      else if (take("||")) relation(), emit(Op::either);
      else return;
    }
  }

  void relation() {
    sum();
    if (take("<=")) sum(), emit(Op::less_equal);
    else if (take(">=")) sum(), emit(Op::greater_equal);
    else if (take("<")) sum(), emit(Op::less);
    else if (take(">")) sum(), emit(Op::greater);
  }

  void sum() {
    product();
    while (true) {
      if (take("+")) product(), emit(Op::add);
      else if (take("-")) product(), emit(Op::subtract);
      else return;
    }
  }

  void product() {
    signed_factor();
    while (true) {
      if (take("*")) signed_factor(), emit(Op::multiply);
      else if (take("/")) signed_factor(), emit(Op::divide);
      else return;
    }
  }

  void signed_factor() {
    if (++nesting_ > max_nesting) fail("formula too deeply nested");
    if (take("-")) {
      signed_factor();
      emit(Op::negate);
    } else if (take("+")) {
      signed_factor();
    } else {
      power();
    }
    --nesting_;
  }

  void power() {
    atom();
    if (take("^")) {
      signed_factor();
      emit(Op::power);
    }
  }

  void atom() {
    skip_blanks();
    if (at_ >= text_.size()) fail("a number, name or parenthesis expected");
    const char c = text_[at_];
    if (take("(")) {
      choice();
      expect(")");
    } else if ((c >= '0' && c <= '9') || c == '.') {
      number();
    } else {
      name();
    }
  }

  void number() {
    double value = 0.0;
    const char* first = text_.data() + at_;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (error != std::errc()) fail("not a number");
    at_ += static_cast<std::size_t>(end - first);
    emit(Op::constant, value);
  }

  void name() {
    const std::size_t start = at_;
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    while (at_ < text_.size() && (letter(text_[at_]) || (at_ > start && digit(text_[at_])))) ++at_;
    const std::string_view word = text_.substr(start, at_ - start);
    if (word == "x" || word == "y" || word == "z") {
      out_.uses_space_ = true;
      emit(word == "x" ? Op::x : word == "y" ? Op::y : Op::z);
    } else if (word == "t") {
      out_.uses_time_ = true;
      emit(Op::t);
    } else if (word == "pi") {
      emit(Op::constant, std::numbers::pi);
    } else if (word == "e") {
      emit(Op::constant, std::numbers::e);
    } else if (const auto one = unary().find(word); one != unary().end()) {
      expect("(");
      choice();
      expect(")");
      emit(one->second);
    } else if (const auto two = binary().find(word); two != binary().end()) {
      expect("(");
      choice();
      expect(",");
      choice();
      expect(")");
      emit(two->second);
    } else {
      at_ = start;
      fail(word.empty() ? fmt::format("unexpected \"{}\"", text_[at_])
                        : fmt::format("unknown name \"{}\" (known: x, y, z, t, pi, e and functions)", word));
    }
  }

  std::string_view text_;
  Expression& out_;
  std::size_t at_ = 0;
  int depth_ = 0, nesting_ = 0;
};

Expression::Expression(const std::string& text) { ExpressionCompiler(text, *this).compile(); }

double Expression::operator()(double x, double y, double z, double t) const {
  std::array<double, max_stack + 1> stack{};  // an empty program returns 0
  int top = -1;
  for (const Instruction& i : program_) {
    if (i.op <= Op::t) {
      const double leaf[] = {i.value, x, y, z, t};
      stack[++top] = leaf[static_cast<int>(i.op)];
      continue;
    }
    if (i.op == Op::choose) {
      top -= 2;
      stack[top] = stack[top] != 0.0 ? stack[top + 1] : stack[top + 2];
      continue;
    }
    if (i.op > Op::step) --top;
    double& a = stack[top];
    const double b = stack[top + 1];
    switch (i.op) {
      case Op::negate:
        a = -a;
        break;
      case Op::sin:
        a = std::sin(a);
        break;
      case Op::cos:
        a = std::cos(a);
        break;
      case Op::tan:
        a = std::tan(a);
        break;
      case Op::asin:
        a = std::asin(a);
        break;
      case Op::acos:
        a = std::acos(a);
        break;
      case Op::atan:
        a = std::atan(a);
        break;
      case Op::sinh:
        a = std::sinh(a);
        break;
      case Op::cosh:
        a = std::cosh(a);
        break;
      case Op::tanh:
        a = std::tanh(a);
        break;
      case Op::exp:
        a = std::exp(a);
        break;
      case Op::log:
        a = std::log(a);
        break;
      case Op::log10:
        a = std::log10(a);
        break;
      case Op::sqrt:
        a = std::sqrt(a);
        break;
      case Op::abs:
        a = std::abs(a);
        break;
      case Op::floor:
        a = std::floor(a);
        break;
      case Op::step:
        a = a >= 0.0 ? 1.0 : 0.0;
        break;
      case Op::add:
        a += b;
        break;
      case Op::subtract:
        a -= b;
        break;
      case Op::multiply:
        a *= b;
        break;
      case Op::divide:
        a /= b;
        break;
      case Op::power:
        a = std::pow(a, b);
        break;
      case Op::atan2:
        a = std::atan2(a, b);
        break;
      case Op::min:
        a = std::isnan(b) ? b : std::min(a, b);
        break;
      case Op::max:
        a = std::isnan(b) ? b : std::max(a, b);
        break;
      case Op::less:
        a = a < b ? 1.0 : 0.0;
        break;
      case Op::greater:
        a = a > b ? 1.0 : 0.0;
        break;
      case Op::less_equal:
        a = a <= b ? 1.0 : 0.0;
        break;
      case Op::greater_equal:
        a = a >= b ? 1.0 : 0.0;
        break;
      case Op::both:
        a = a != 0.0 && b != 0.0 ? 1.0 : 0.0;
        break;
      case Op::either:
        a = a != 0.0 || b != 0.0 ? 1.0 : 0.0;
        break;
      default:
        break;
    }
  }
  return stack[0];
}

}  // namespace ejecta
