#include "case/expression.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

#include "base/error.hpp"

namespace ejecta {
namespace {

constexpr int kMaxStack = 32, kMaxNesting = 200;  // deeper formulas are refused when they are compiled

double truth(bool b) { return b ? 1.0 : 0.0; }

using Function1 = double (*)(double);
using Function2 = double (*)(double, double);

const std::map<std::string_view, Function1>& functions_of_one() {
  static const std::map<std::string_view, Function1> list{
      {"sin", std::sin},
      {"cos", std::cos},
      {"tan", std::tan},
      {"asin", std::asin},
      {"acos", std::acos},
      {"atan", std::atan},
      {"sinh", std::sinh},
      {"cosh", std::cosh},
      {"tanh", std::tanh},
      {"exp", std::exp},
      {"log", std::log},
      {"ln", std::log},
      {"log10", std::log10},
      {"sqrt", std::sqrt},
      {"abs", std::fabs},
      {"floor", std::floor},
      {"step", [](double a) { return std::isnan(a) ? a : truth(a >= 0.0); }}};
  return list;
}

const std::map<std::string_view, Function2>& functions_of_two() {
  // Unlike std::fmin, NaN is not hidden.
  static const std::map<std::string_view, Function2> list{
      {"atan2", std::atan2},
      {"pow", std::pow},
      {"min", [](double a, double b) { return std::isnan(b) || b < a ? b : a; }},
      {"max", [](double a, double b) { return std::isnan(b) || b > a ? b : a; }}};
  return list;
}

struct Operator {
  std::string_view sign;
  Function2 apply;
};
/// Binary operators by level, loosest first; within a level a sign before its own beginning ("<=" before
/// "<").
const std::array<std::vector<Operator>, 5>& operators() {
  static const std::array<std::vector<Operator>, 5> levels{
      {{{"||", [](double a, double b) { return truth(a != 0.0 || b != 0.0); }}},
       {{"&&", [](double a, double b) { return truth(a != 0.0 && b != 0.0); }}},
       {{"<=", [](double a, double b) { return truth(a <= b); }},
        {">=", [](double a, double b) { return truth(a >= b); }},
        {"<", [](double a, double b) { return truth(a < b); }},
        {">", [](double a, double b) { return truth(a > b); }}},
       {{"+", [](double a, double b) { return a + b; }}, {"-", [](double a, double b) { return a - b; }}},
       {{"*", [](double a, double b) { return a * b; }}, {"/", [](double a, double b) { return a / b; }}}}};
  return levels;
}

}  // namespace

/// Recursive descent from text to a stack program.
class ExpressionCompiler {
 public:
  ExpressionCompiler(std::string_view text, Expression& out) : text_(text), out_(out) {}

  void compile() {
    choice();
    skip_blanks();
    if (at_ < text_.size()) fail(fmt::format("unexpected \"{}\"", text_[at_]));
  }

 private:
  using Kind = Expression::Kind;

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

  void emit(const Expression::Instruction& i) {
    depth_ += i.kind <= Kind::t ? 1 : i.kind == Kind::one ? 0 : i.kind == Kind::two ? -1 : -2;
    if (depth_ > kMaxStack) fail("formula too deeply nested");
    out_.program_.push_back(i);
  }
  void emit(Expression::Function1 f) { emit({.kind = Kind::one, .one = f}); }
  void emit(Expression::Function2 f) { emit({.kind = Kind::two, .two = f}); }

  void enter() {
    if (++nesting_ > kMaxNesting) fail("formula too deeply nested");
  }

  void choice() {
    enter();
    binary(0);
    if (take("?")) {
      choice();
      expect(":");
      choice();
      emit({.kind = Kind::choose});
    }
    --nesting_;
  }

  void binary(std::size_t level) {
    if (level == operators().size()) return sign();
    binary(level + 1);
    while (const Operator* o = take_operator(level)) {
      binary(level + 1);
      emit(o->apply);
    }
  }

  const Operator* take_operator(std::size_t level) {
    for (const Operator& o : operators()[level])
      if (take(o.sign)) return &o;
    return nullptr;
  }

  void sign() {
    enter();
    if (take("-")) {
      sign();
      emit([](double a) { return -a; });
    } else if (take("+")) {
      sign();
    } else {
      atom();
      if (take("^")) {
        sign();
        emit(static_cast<Expression::Function2>(std::pow));
      }
    }
    --nesting_;
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
    emit({.kind = Kind::constant, .value = value});
  }

  std::string_view word() {
    const std::size_t start = at_;
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    while (at_ < text_.size() && (letter(text_[at_]) || (at_ > start && digit(text_[at_])))) ++at_;
    return text_.substr(start, at_ - start);
  }

  void name() {
    const std::size_t start = at_;
    const std::string_view w = word();
    const auto one = functions_of_one().find(w);
    const auto two = functions_of_two().find(w);
    if (w == "x" || w == "y" || w == "z") {
      out_.uses_space_ = true;
      emit({.kind = w == "x" ? Kind::x : w == "y" ? Kind::y : Kind::z});
    } else if (w == "t") {
      out_.uses_time_ = true;
      emit({.kind = Kind::t});
    } else if (w == "pi" || w == "e") {
      emit({.kind = Kind::constant, .value = w == "pi" ? std::numbers::pi : std::numbers::e});
    } else if (one != functions_of_one().end()) {
      expect("(");
      choice();
      expect(")");
      emit(one->second);
    } else if (two != functions_of_two().end()) {
      expect("(");
      choice();
      expect(",");
      choice();
      expect(")");
      emit(two->second);
    } else {
      at_ = start;
      fail(w.empty() ? fmt::format("unexpected \"{}\"", text_[at_])
                     : fmt::format("unknown name \"{}\" (known: x, y, z, t, pi, e and functions)", w));
    }
  }

  std::string_view text_;
  Expression& out_;
  std::size_t at_ = 0;
  int depth_ = 0, nesting_ = 0;
};

Expression::Expression(const std::string& text) { ExpressionCompiler(text, *this).compile(); }

double Expression::operator()(double x, double y, double z, double t) const {
  std::array<double, kMaxStack + 1> stack{};  // an empty program returns 0
  int top = -1;
  for (const Instruction& i : program_) {
    switch (i.kind) {
      case Kind::constant:
        stack[++top] = i.value;
        break;
      case Kind::x:
        stack[++top] = x;
        break;
      case Kind::y:
        stack[++top] = y;
        break;
      case Kind::z:
        stack[++top] = z;
        break;
      case Kind::t:
        stack[++top] = t;
        break;
      case Kind::one:
        stack[top] = i.one(stack[top]);
        break;
      case Kind::two:
        --top;
        stack[top] = i.two(stack[top], stack[top + 1]);
        break;
      case Kind::choose:
        top -= 2;
        stack[top] = stack[top] != 0.0 ? stack[top + 1] : stack[top + 2];
        break;
    }
  }
  return stack[0];
}

}  // namespace ejecta
