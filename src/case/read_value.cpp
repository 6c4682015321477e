#include "case/read_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/error.hpp"
#include "base/text.hpp"
#include "case/expression.hpp"

namespace ejecta {
namespace {

/// Reads one node for each kind of slot. Every method returns whether it succeeded and reports if not.
class ValueReader {
 public:
  ValueReader(const Node& node, const Key& key, const std::string& path, double ambient,
              std::vector<Problem>& problems)
      : root_(node), key_(key), path_(path), ambient_(ambient), problems_(problems) {}

  bool operator()(bool* out) { return plain<bool>(root_, *out); }
  bool operator()(std::optional<bool>* out) { return plain<bool>(root_, out->emplace()); }
  bool operator()(std::string* out) { return text(root_, *out); }
  bool operator()(int* out) { return integer(root_, *out); }
  bool operator()(std::int64_t* out) { return integer(root_, *out); }
  bool operator()(double* out) { return number(root_, *out); }
  bool operator()(std::optional<double>* out) { return number(root_, out->emplace()); }
  bool operator()(Vec3* out) { return vector(root_, *out); }
  bool operator()(std::vector<double>* out) { return items(root_, *out, &ValueReader::number); }
  bool operator()(std::vector<int>* out) { return items(root_, *out, &ValueReader::integer<int>); }
  bool operator()(std::vector<std::string>* out) { return items(root_, *out, &ValueReader::text); }
  bool operator()(std::array<int, 3>* out) { return fixed(root_, *out, &ValueReader::integer<int>); }
  bool operator()(std::array<double, 2>* out) { return fixed(root_, *out, &ValueReader::number); }
  bool operator()(std::optional<std::array<double, 2>>* out) {
    return fixed(root_, out->emplace(), &ValueReader::number);
  }
  bool operator()(std::vector<std::array<double, 4>>* out) { return items(root_, *out, &ValueReader::four); }
  bool operator()(std::vector<Vec3>* out) { return items(root_, *out, &ValueReader::vector); }
  bool operator()(std::optional<std::array<Vec3, 2>>* out) {
    return fixed(root_, out->emplace(), &ValueReader::vector);
  }
  /// Values of another key, which is not known yet: read when the study is set up.
  bool operator()(std::vector<Node>* out) {
    if (!root_.is_list()) return fail(root_, kind_words(root_) + " instead of a list of values");
    *out = root_.children;
    return true;
  }
  bool operator()(std::optional<Node>* out) {
    *out = root_;
    return true;
  }
  bool operator()(const Formula& f) { return formula(root_, f.text ? *f.text : f.optional->emplace()); }
  bool operator()(const Formulas& f) {
    return fixed(root_, f.text ? *f.text : f.optional->emplace(), &ValueReader::formula);
  }
  bool operator()(const VectorOrFormulas& v) {
    std::array<std::string, 3> texts;
    if (!fixed(root_, texts, &ValueReader::formula)) return false;
    bool constant = true;
    for (std::size_t d = 0; d < 3; ++d) {
      const Expression formula(texts[d]);
      constant = constant && formula.is_constant();
      (*v.value)[static_cast<int>(d)] = formula(0, 0, 0, 0);
    }
    v.formulas->reset();
    if (!constant) *v.formulas = texts;
    return true;
  }
  bool operator()(const Choice& choice) {
    std::string name;
    if (!plain<std::string>(root_, name)) return false;
    std::vector<std::string> known;
    for (std::size_t i = 0; i < choice.words->size(); ++i) {
      known.push_back((*choice.words)[i].name);
      if (known.back() == name) {
        choice.set(i);
        return true;
      }
    }
    return fail(root_, fmt::format("unknown word \"{}\"", name), nearest(name, known));
  }

 private:
  /// `instead`: what the user most likely meant, as TOML.
  bool fail(const Node& node, const std::string& what, const std::string& closest = "",
            const std::string& instead = "") {
    if (enough(problems_)) return false;
    problems_.push_back({.key = path_,
                         .what = what,
                         .expected = expectation(key_),
                         .nearest = closest,
                         .example = key_.name + " = " + (instead.empty() ? example_ : instead),
                         .place = node.place});
    return false;
  }

  template <class T>
  bool plain(const Node& node, T& out) {
    const T* value = std::get_if<T>(&node.value);
    if (!value) return fail(node, kind_words(node) + " does not fit here");
    out = *value;
    return true;
  }

  /// A file that an extended case names lies beside that case.
  bool text(const Node& node, std::string& out) {
    if (!plain<std::string>(node, out) || !without_escapes(node, out)) return false;
    if (key_.file && !out.empty() && node.place.source && !node.place.source->folder.empty())
      out = (std::filesystem::path(node.place.source->folder) / out).string();
    return true;
  }

  /// "C:\rocks\rock.stl" holds two carriage returns.
  bool without_escapes(const Node& node, const std::string& text) {
    if (std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
      return true;
    std::string mended(node.place.text());
    std::replace(mended.begin(), mended.end(), '\\', key_.file ? '/' : ' ');
    return fail(
        node,
        "a \\ in double quotes begins a sign of its own, such as \\n or \\r; in the name of a file, write /",
        "", mended);
  }

  template <class T>
  bool integer(const Node& node, T& out) {
    const auto* value = std::get_if<std::int64_t>(&node.value);
    if (!value) return fail(node, kind_words(node) + " is no whole number");
    if (*value < std::numeric_limits<T>::min() || *value > std::numeric_limits<T>::max())
      return fail(node, fmt::format("{} is too large", *value));
    out = static_cast<T>(*value);
    return in_range(node, static_cast<double>(*value));
  }

  bool number(const Node& node, double& out) {
    const auto* whole = std::get_if<std::int64_t>(&node.value);
    const auto* real = std::get_if<double>(&node.value);
    const auto* text = std::get_if<std::string>(&node.value);
    if (key_.dimension == Dimension::none) {
      if (!whole && !real) {
        const std::string point = text && !parse_number(*text) ? with_decimal_point(*text) : "";
        const std::string meant = text && parse_number(*text) ? *text : parse_number(point) ? point : "";
        return fail(
            node,
            kind_words(node) + (!point.empty() ? " has a comma; a number has a decimal point and no quotes"
                                : text         ? " is no bare number (no quotes here)"
                                               : " is no number"),
            "", &node == &root_ ? meant : "");
      }
      out = whole ? static_cast<double>(*whole) : *real;
      if (!std::isfinite(out)) return fail(node, "not a finite number");
      return in_range(node, out);
    }
    if (whole || real) return fail(node, fmt::format("{} has no unit", kind_words(node)));
    if (!text) return fail(node, kind_words(node) + " is no quantity");
    return quantity(node, *text, out) && in_range(node, out);
  }

  bool quantity(const Node& node, const std::string& text, double& out) {
    try {
      out = parse_quantity(text, key_.dimension, ambient_);
    } catch (const InputError& e) {
      const std::string point = with_decimal_point(text);
      const bool helps = !point.empty() && &node == &root_ && is_quantity(point);
      return fail(node, e.what(), "", helps ? fmt::format("\"{}\"", point) : "");
    }
    if (std::isnan(out)) return fail(node, "the ambient pressure itself cannot be gauge");
    return true;
  }

  bool is_quantity(const std::string& text) const {
    try {
      parse_quantity(text, key_.dimension, ambient_);
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  bool in_range(const Node& node, double v) {
    const Bounds& b = key_.bounds;
    if (!((b.open ? v > b.least : v >= b.least) && v <= b.most))
      return fail(node, fmt::format("{} is out of range", node.place.text()));
    const Magnitudes m = magnitudes(key_.dimension);
    const double size = std::abs(v);
    const bool too_small = b.least == 0.0 && v != 0.0 && size < m.least;
    if (size <= m.most && !too_small) return true;
    return fail(node, fmt::format("{} cannot be meant: {} {}", node.place.text(),
                                  too_small ? "it is less than" : "at most",
                                  format_quantity(too_small ? m.least : m.most, key_.dimension)));
  }

  bool formula(const Node& node, std::string& out) {
    const auto* text = std::get_if<std::string>(&node.value);
    const auto first = text ? text->find_first_not_of(" \t") : std::string::npos;
    if (first == std::string::npos || (*text)[first] != '=') {
      double value = 0.0;
      if (!number(node, value)) return false;
      out = fmt::format("{}", value);
      return true;
    }
    const auto start = text->find_first_not_of(" \t", first + 1);
    out = start == std::string::npos ? "" : text->substr(start);
    try {
      Expression check(out);
      return true;
    } catch (const InputError& e) {
      return fail(node, e.what());
    }
  }

  template <class Out, class Element>
  bool fixed(const Node& node, Out& out, bool (ValueReader::*read)(const Node&, Element&)) {
    if (!node.is_list() || node.children.size() != out.size())
      return fail(node,
                  fmt::format("{} instead of a list of {}{}", kind_words(node), out.size(),
                              node.children.size() == 2 * out.size() && key_.dimension == Dimension::none
                                  ? " (a number has a decimal point, not a comma)"
                                  : ""));
    bool good = true;
    for (std::size_t i = 0; i < out.size(); ++i) good = (this->*read)(node.children[i], out[i]) && good;
    return good;
  }

  template <class Element>
  bool items(const Node& node, std::vector<Element>& out, bool (ValueReader::*read)(const Node&, Element&)) {
    out.clear();
    if (!node.is_list()) return (this->*read)(node, out.emplace_back());  // a list of one may be written bare
    bool good = true;
    for (const Node& child : node.children) good = (this->*read)(child, out.emplace_back()) && good;
    return good;
  }

  bool vector(const Node& node, Vec3& out) {
    std::array<double, 3> parts{};
    if (!fixed(node, parts, &ValueReader::number)) return false;
    out = Vec3(parts[0], parts[1], parts[2]);
    return true;
  }

  bool four(const Node& node, std::array<double, 4>& out) { return fixed(node, out, &ValueReader::number); }

  const Node& root_;
  const Key& key_;
  const std::string example_ = example(key_);  // while the key still holds its default
  const std::string& path_;
  double ambient_;
  std::vector<Problem>& problems_;
};

}  // namespace

void read_value(const Node& node, const Key& key, const std::string& path, double ambient,
                std::vector<Problem>& problems) {
  std::visit(ValueReader(node, key, path, ambient, problems), key.slot);
}

}  // namespace ejecta
