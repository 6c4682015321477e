#include "case/key.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/text.hpp"

namespace ejecta {
namespace {

std::string quoted(const std::string& s) {
  std::string out = "\"";
  for (char c : s) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += std::string("\\") + c;
    else if (u < 0x20 || u == 0x7f) out += fmt::format("\\u{:04X}", u);
    else out += c;
  }
  return out + "\"";
}

template <class List, class Format>
std::string bracketed(const List& list, const Format& format) {
  std::string out;
  for (const auto& item : list) out += (out.empty() ? "" : ", ") + format(item);
  return "[" + out + "]";
}

/// TOML takes 1 for an integer, 1.0 or 1e-3 for a float; both are read as numbers here.
std::string scalar(double v, Dimension d) {
  v += 0.0;  // "-0" would be read as the whole number 0, and written as "0" the next time
  return d == Dimension::none ? fmt::format("{}", v) : quoted(format_quantity(v, d));
}

std::string formula_text(const std::string& text, Dimension d) {
  const auto number = parse_number(text);
  return number ? scalar(*number, d) : quoted("= " + text);
}

/// As it was written, on one line.
std::string written(const Node& node) {
  struct Text {
    const Node& node;
    std::string operator()(Node::Table) const { return "{}"; }
    std::string operator()(Node::List) const { return bracketed(node.children, written); }
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return fmt::format("{}", i); }
    std::string operator()(double d) const {
      const std::string text = fmt::format("{}", d);
      return text.find_first_of(".en") == std::string::npos ? fmt::format("{}.0", text) : text;
    }
    std::string operator()(const std::string& s) const { return quoted(s); }
  };
  return std::visit(Text{node}, node.value);
}

/// Writes the value of each kind of slot.
struct ValueText {
  Dimension d;
  std::string operator()(const bool* v) const { return *v ? "true" : "false"; }
  std::string operator()(const std::optional<bool>* v) const { return *v ? (*this)(&**v) : ""; }
  std::string operator()(const int* v) const { return fmt::format("{}", *v); }
  std::string operator()(const std::int64_t* v) const { return fmt::format("{}", *v); }
  std::string operator()(const double* v) const { return scalar(*v, d); }
  std::string operator()(const std::optional<double>* v) const { return *v ? scalar(**v, d) : ""; }
  std::string operator()(const std::string* v) const { return v->empty() ? "" : quoted(*v); }
  std::string operator()(const Vec3* v) const { return numbers(std::array{v->x(), v->y(), v->z()}); }
  std::string operator()(const std::vector<double>* v) const { return v->empty() ? "" : numbers(*v); }
  std::string operator()(const std::vector<int>* v) const { return v->empty() ? "" : integers(*v); }
  std::string operator()(const std::vector<std::string>* v) const {
    return v->empty() ? "" : bracketed(*v, quoted);
  }
  std::string operator()(const std::array<int, 3>* v) const { return integers(*v); }
  std::string operator()(const std::array<double, 2>* v) const { return numbers(*v); }
  std::string operator()(const std::optional<std::array<double, 2>>* v) const {
    return *v ? numbers(**v) : "";
  }
  std::string operator()(const std::vector<std::array<double, 4>>* v) const {
    return v->empty() ? "" : bracketed(*v, [&](const auto& s) { return numbers(s); });
  }
  std::string operator()(const std::vector<Vec3>* v) const {
    return v->empty() ? "" : bracketed(*v, [&](const Vec3& p) { return (*this)(&p); });
  }
  std::string operator()(const std::optional<std::array<Vec3, 2>>* v) const {
    return *v ? bracketed(**v, [&](const Vec3& p) { return (*this)(&p); }) : "";
  }
  std::string operator()(const std::vector<Node>* v) const {
    return v->empty() ? "" : bracketed(*v, written);
  }
  std::string operator()(const std::optional<Node>* v) const { return *v ? written(**v) : ""; }
  std::string operator()(const Choice& c) const { return quoted(c.words->at(c.get()).name); }
  std::string operator()(const Formula& f) const {
    if (f.text) return formula_text(*f.text, d);
    return *f.optional ? formula_text(**f.optional, d) : "";
  }
  std::string operator()(const Formulas& f) const {
    if (f.optional && !*f.optional) return "";
    return bracketed(f.text ? *f.text : **f.optional,
                     [&](const std::string& s) { return formula_text(s, d); });
  }
  std::string operator()(const VectorOrFormulas& v) const {
    return *v.formulas ? (*this)(Formulas{.optional = v.formulas}) : (*this)(v.value);
  }

 private:
  template <class List>
  std::string numbers(const List& list) const {
    return bracketed(list, [&](double x) { return scalar(x, d); });
  }
  template <class List>
  std::string integers(const List& list) const {
    return bracketed(list, [](int i) { return fmt::format("{}", i); });
  }
};

std::string range_words(const Key& key) {
  const Bounds& b = key.bounds;
  const auto limit = [&](double v) {
    return key.dimension == Dimension::none || v == 0.0 ? fmt::format("{}", v)
                                                        : format_quantity(v, key.dimension);
  };
  std::string words;
  if (std::isfinite(b.least))
    words += fmt::format(", {} {}", b.open ? "more than" : "at least", limit(b.least));
  if (std::isfinite(b.most))
    words += fmt::format("{} at most {}", words.empty() ? "," : " and", limit(b.most));
  return words;
}

struct TypeWords {
  Dimension d;
  std::string one() const { return std::string(describe(d)); }
  std::string many() const {
    return d == Dimension::none ? "numbers" : fmt::format("quantities in {}", unit_words(d));
  }
  std::string operator()(const bool*) const { return "true or false"; }
  std::string operator()(const std::optional<bool>*) const { return "true or false"; }
  std::string operator()(const int*) const { return "a whole number"; }
  std::string operator()(const std::int64_t*) const { return "a whole number"; }
  std::string operator()(const double*) const { return one() + units(); }
  std::string operator()(const std::optional<double>*) const { return one() + units(); }
  std::string operator()(const std::string*) const { return "a text in quotes"; }
  std::string operator()(const Vec3*) const { return "a list of 3 " + many(); }
  std::string operator()(const std::vector<double>*) const { return "a list of " + many(); }
  std::string operator()(const std::vector<int>*) const { return "a list of whole numbers"; }
  std::string operator()(const std::vector<std::string>*) const { return "a list of texts"; }
  std::string operator()(const std::array<int, 3>*) const { return "a list of 3 whole numbers"; }
  std::string operator()(const std::array<double, 2>*) const { return "a list of 2 " + many(); }
  std::string operator()(const std::optional<std::array<double, 2>>*) const {
    return "a list of 2 " + many();
  }
  std::string operator()(const std::vector<std::array<double, 4>>*) const {
    return "a list of lists of 4 " + many();
  }
  std::string operator()(const std::vector<Vec3>*) const { return "a list of lists of 3 " + many(); }
  std::string operator()(const std::optional<std::array<Vec3, 2>>*) const {
    return "a list of 2 lists of 3 " + many();
  }
  std::string operator()(const std::vector<Node>*) const { return "a list of values of that key"; }
  std::string operator()(const std::optional<Node>*) const { return "a value of that key"; }
  std::string operator()(const Choice& c) const {
    std::vector<std::string> names;
    for (const Word& w : *c.words) names.push_back(quoted(w.name));
    return fmt::format("one of {}", joined(names));
  }
  std::string operator()(const Formula&) const { return one() + units() + " or a formula \"= ...\""; }
  std::string operator()(const Formulas&) const { return "a list of 3 " + many() + " or formulas \"= ...\""; }
  std::string operator()(const VectorOrFormulas&) const { return (*this)(Formulas{}); }

 private:
  std::string units() const { return d == Dimension::none ? "" : fmt::format(" in {}", unit_words(d)); }
};

}  // namespace

std::string expectation(const Key& key) {
  return std::visit(TypeWords{key.dimension}, key.slot) + range_words(key);
}

std::string value_text(const Key& key) {
  return std::visit([&](const auto& slot) { return ValueText{key.dimension}(slot); }, key.slot);
}

std::string example(const Key& key) {
  if (!key.example.empty()) return key.example;
  if (std::holds_alternative<double*>(key.slot) || std::holds_alternative<std::optional<double>*>(key.slot)) {
    const std::string now = value_text(key);
    const bool meaningful = !now.empty() && key.unset.empty();
    if (!meaningful)
      return key.dimension == Dimension::none ? std::string(example(key.dimension))
                                              : quoted(std::string(example(key.dimension)));
  }
  if (std::holds_alternative<Vec3*>(key.slot) && key.dimension == Dimension::length && !key.unset.empty())
    return R"(["10 mm", "10 mm", "10 mm"])";
  return value_text(key);
}

}  // namespace ejecta
