#include "shape/stl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>

#include "base/error.hpp"

namespace ejecta {
namespace {

constexpr std::size_t kHeader = 84, kRecord = 50;  // bytes: header with count; one binary triangle

std::uint32_t binary_count(std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader) std::memcpy(&count, bytes.data() + 80, 4);
  return count;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// A text file starts with "solid", but so do some binary ones: the length decides, and bytes that no text
/// has.
bool is_binary(std::string_view bytes) {
  if (bytes.size() >= kHeader && bytes.size() == kHeader + kRecord * std::size_t{binary_count(bytes)})
    return true;
  std::string_view start = bytes;
  if (start.starts_with(kByteOrderMark)) start.remove_prefix(kByteOrderMark.size());
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  return !same_word(start.substr(0, 5), "solid");
}

std::vector<Vec3> corners_binary(std::string_view bytes, const std::string& name) {
  const std::size_t count = binary_count(bytes);
  if (bytes.size() < kHeader || (bytes.size() - kHeader) / kRecord < count)
    throw InputError(
        fmt::format("{}: a binary STL of {} triangles has {} bytes, this has {}: the file is cut short or no "
                    "STL",
                    name, count, kHeader + kRecord * count, bytes.size()));
  if (bytes.size() != kHeader + kRecord * count)
    throw InputError(fmt::format(
        "{}: a binary STL of {} triangles has {} bytes, this has {}: bytes {} on are no part of it, "
        "or its count of triangles is wrong",
        name, count, kHeader + kRecord * count, bytes.size(), kHeader + kRecord * count));
  std::vector<Vec3> corners;
  corners.reserve(3 * count);
  for (std::size_t n = 0; n < count; ++n)
    for (std::size_t c = 0; c < 3; ++c) {
      float xyz[3];
      std::memcpy(xyz, bytes.data() + kHeader + kRecord * n + 12 * (c + 1), sizeof xyz);
      corners.emplace_back(xyz[0], xyz[1], xyz[2]);
    }
  return corners;
}

/// Reads the text form word by word, so that the division into lines does not matter:
///   solid NAME { facet normal X Y Z outer loop { vertex X Y Z } x 3 endloop endfacet } endsolid NAME
/// in letters of any case, one solid after the other. Anything else is refused with its line.
class TextReader {
 public:
  TextReader(std::string_view bytes, const std::string& name) : text_(bytes), name_(name) {
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
    // Some systems mark the end of a text, or fill it up.
    while (!text_.empty() && (text_.back() == '\0' || text_.back() == '\x1a')) text_.remove_suffix(1);
  }

  std::vector<Vec3> read() {
    while (!peek().empty()) {
      expect("solid");
      skip_name();
      while (same_word(peek(), "facet")) facet();
      expect("endsolid");
      skip_name();
    }
    return std::move(corners_);
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r\n\v\f";

  [[noreturn]] void fail(const std::string& what) const {
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    throw InputError(fmt::format("{}:{}: {}", name_, line, what));
  }

  std::string_view peek() {
    at_ = std::min(text_.find_first_not_of(kBlanks, at_), text_.size());
    return text_.substr(at_, std::min(text_.find_first_of(kBlanks, at_), text_.size()) - at_);
  }

  std::string_view next(std::string_view expected) {
    const std::string_view word = peek();
    if (word.empty())
      fail(fmt::format("the file ends early: \"{}\" was to come, after {} whole triangles", expected,
                       corners_.size() / 3));
    return word;
  }

  void expect(std::string_view expected) {
    const std::string_view word = next(expected);
    if (at_ + word.size() == text_.size() && same_word(word, expected.substr(0, word.size())) &&
        word.size() < expected.size())
      fail(fmt::format("the file ends early, in \"{}\" after {} whole triangles", expected,
                       corners_.size() / 3));
    if (!same_word(word, expected))
      fail(fmt::format("expected \"{}\", found \"{}\"", expected, word.substr(0, 40)));
    at_ += word.size();
  }

  /// To the end of the line, or to the first facet where the lines have been joined.
  void skip_name() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    while (at_ < end) {
      const std::string_view word = peek();
      if (at_ >= end) break;
      const std::size_t before = at_;
      at_ += word.size();
      if (same_word(word, "facet") && same_word(peek(), "normal")) {
        at_ = before;
        return;
      }
    }
    at_ = std::min(at_, end);
  }

  void facet() {
    expect("facet");
    expect("normal");
    for (int n = 0; n < 3; ++n)
      at_ += next("a number").size();  // the corners say it better, if it is one at all
    expect("outer");
    expect("loop");
    for (int n = 0; n < 3; ++n) {
      expect("vertex");
      Vec3 p;
      for (int d = 0; d < 3; ++d) p[d] = number();
      corners_.push_back(p);
    }
    expect("endloop");
    expect("endfacet");
  }

  double number() {
    const std::string_view word = next("a number");
    std::string digits(word);
    for (char& c : digits)
      if (c == 'd' || c == 'D') c = 'e';  // of Fortran
    const char* first = digits.data() + (digits.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(first, digits.data() + digits.size(), value);
    if (error == std::errc() && end == digits.data() + digits.size() && std::isfinite(value)) {
      at_ += word.size();
      return value;
    }
    const bool comma = word.find(',') != std::string_view::npos;
    fail(comma ? fmt::format(
                     "\"{}\" has a decimal comma; a number has a decimal point, e.g. \"vertex 0 0 1.5\"",
                     word.substr(0, 40))
               : fmt::format("expected three numbers after \"vertex\", e.g. \"vertex 0 0 1.5\", found \"{}\"",
                             word.substr(0, 40)));
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  std::vector<Vec3> corners_;
};

}  // namespace

TriangleMesh parse_stl(std::string_view bytes, double scale, const std::string& name) {
  const std::vector<Vec3> corners =
      is_binary(bytes) ? corners_binary(bytes, name) : TextReader(bytes, name).read();
  if (corners.empty()) throw InputError(fmt::format("{}: the file holds no triangles", name));
  Vec3 low = corners.front(), high = corners.front();
  for (std::size_t n = 0; n < corners.size(); ++n) {
    if (!corners[n].allFinite())
      throw InputError(
          fmt::format("{}: corner {} of triangle {} is not a finite number", name, n % 3 + 1, n / 3 + 1));
    low = low.cwiseMin(corners[n]);
    high = high.cwiseMax(corners[n]);
  }
  const double grid = 1e-7 * (high - low).norm();
  TriangleMesh mesh;
  std::map<std::array<std::int64_t, 3>, int> known;
  // A corner may fall on either side of a rounding boundary: look into the neighbouring grid cells as well.
  const auto vertex = [&](const Vec3& p) {
    const Vec3 q = grid > 0 ? Vec3((p - low) / grid) : Vec3(0, 0, 0);
    std::array<std::int64_t, 3> cell{};
    for (std::size_t c = 0; c < 3; ++c) cell[c] = std::llround(q[static_cast<int>(c)]);
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz)
          if (const auto at = known.find({cell[0] + dx, cell[1] + dy, cell[2] + dz}); at != known.end())
            return at->second;
    mesh.vertices.push_back(scale * p);
    return known[cell] = static_cast<int>(mesh.vertices.size()) - 1;
  };
  for (std::size_t n = 0; n < corners.size(); n += 3)
    mesh.triangles.push_back({vertex(corners[n]), vertex(corners[n + 1]), vertex(corners[n + 2])});
  return mesh;
}

TriangleMesh read_stl(const std::string& path, double scale) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("cannot open the mesh \"{}\"", path));
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return parse_stl(bytes, scale, path);
}

}  // namespace ejecta
