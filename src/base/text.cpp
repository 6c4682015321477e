#include "base/text.hpp"

#include <algorithm>

namespace ejecta {
namespace {

constexpr std::size_t edit = 2, other_case = 1;  // costs

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::size_t replacement(char a, char b) { return a == b ? 0 : lower(a) == lower(b) ? other_case : edit; }

/// Letters inserted, left out, replaced or swapped with their neighbour (optimal string alignment).
std::size_t edit_cost(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = edit * i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = edit * j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min(
          {d[i - 1][j] + edit, d[i][j - 1] + edit, d[i - 1][j - 1] + replacement(a[i - 1], b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + edit);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t least = edit * std::max<std::size_t>(1, word.size() / 3) + 2;
  for (const std::string& c : candidates) {
    // A word that goes on where the other ends ("k-omega", "msec") is about as near as one wrong letter.
    const bool begins = (word.size() > 2 && c.starts_with(word)) || (c.size() > 1 && word.starts_with(c));
    const std::size_t letters = edit_cost(word.substr(0, 100), c);
    const std::size_t cost = begins ? std::min(letters, edit + 1) : letters;
    if (cost < least) {
      least = cost;
      best = c;
    }
  }
  return best;
}

std::string joined(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (const std::string& word : words) text.append(text.empty() ? "" : separator).append(word);
  return text;
}

}  // namespace ejecta
