#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/units.hpp"
#include "base/vec.hpp"
#include "case/node.hpp"
#include "case/words.hpp"

namespace ejecta {

/// What each number of a key must satisfy (in SI units).
struct Bounds {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool open = false;  ///< `least` itself is not allowed
};
inline constexpr Bounds anything{};
inline constexpr Bounds positive{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Bounds not_negative{0.0};
inline constexpr Bounds fraction{0.0, 1.0};

/// A choice among words, bound to an enum member.
struct Choice {
  const std::vector<Word>* words;
  std::function<std::size_t()> get;
  std::function<void(std::size_t)> set;
};

/// A formula in x, y, z, t or a quantity, kept as text in SI units.
struct Formula {
  std::string* text = nullptr;
  std::optional<std::string>* optional = nullptr;
};
/// Three of them.
struct Formulas {
  std::array<std::string, 3>* text = nullptr;
  std::optional<std::array<std::string, 3>>* optional = nullptr;
};

/// Three quantities, or formulas of which `value` holds what they give at t = 0.
struct VectorOrFormulas {
  Vec3* value = nullptr;
  std::optional<std::array<std::string, 3>>* formulas = nullptr;
};

/// Where the value of a key goes.
using Slot =
    std::variant<bool*, std::optional<bool>*, int*, std::int64_t*, double*, std::optional<double>*,
                 std::string*, Vec3*, std::vector<double>*, std::vector<int>*, std::vector<std::string>*,
                 std::array<int, 3>*, std::array<double, 2>*, std::optional<std::array<double, 2>>*,
                 std::vector<std::array<double, 4>>*, std::vector<Vec3>*, std::optional<std::array<Vec3, 2>>*,
                 std::vector<Node>*, std::optional<Node>*, Choice, Formula, Formulas, VectorOrFormulas>;

/// One entry of the schema, bound to one struct. Everything that is known of a key is here, and only here.
struct Key {
  std::string name;
  Slot slot;
  Dimension dimension = Dimension::none;
  Bounds bounds{};
  std::string help{};    ///< one line
  std::string source{};  ///< where the default or the law comes from
  std::string unset{};   ///< what the default means in words, e.g. "ambient"; empty: the default as it is
  bool required = false;
  std::string example{};  ///< a value that works, as TOML; empty: made from the default or the dimension
  bool decisive = false;  ///< its default decides the result: an assumption until the user sets it
  bool file = false;      ///< names a file, relative to the one that says so
};

inline Key decisive(Key key) {
  key.decisive = true;
  return key;
}

template <class E>
Choice choice(E& e) {
  return {&words(e), [&e] { return static_cast<std::size_t>(e); },
          [&e](std::size_t i) { e = static_cast<E>(i); }};
}

/// A table of the case file, e.g. [grid.x], or one of a list, e.g. [[body]].
struct Section {
  std::string name;  ///< e.g. "boundary.z_min"
  std::string help;
  bool repeated = false;
  std::function<std::size_t()> count;                 ///< elements there are now
  std::function<void()> append;                       ///< one more element (repeated sections)
  std::function<std::vector<Key>(std::size_t)> keys;  ///< bound to the n-th element
  bool* enabled = nullptr;                            ///< set by the mere presence of the section
};

/// Type, unit and range in words, e.g. "a time, > 0".
std::string expectation(const Key&);
/// A value that works, as it stands in TOML.
std::string example(const Key&);
/// The present value as TOML; empty when unset.
std::string value_text(const Key&);

}  // namespace ejecta
