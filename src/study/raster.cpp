#include "study/raster.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

namespace ejecta {
namespace {

/// Share of a triangle in which the linear function with these corner values is positive.
double positive_share(double a, double b, double c) {
  const int positive = (a > 0.0) + (b > 0.0) + (c > 0.0);
  if (positive == 0 || positive == 3) return positive / 3;
  if (positive == 2) return 1.0 - positive_share(-a, -b, -c);
  if (b > 0.0) std::swap(a, b);
  if (c > 0.0) std::swap(a, c);
  return a * a / ((a - b) * (a - c));
}

/// Where a linear function with values a, b of unlike sign at 0 and 1 is zero.
double crossing(double a, double b) { return a / (a - b); }

struct Corner {
  std::int64_t id;  // node, or a centre behind all nodes
  Point2 at;
  double value;
};

/// A crossing is named by the edge it lies on, so that triangles that share the edge share the point.
using Edge = std::pair<std::int64_t, std::int64_t>;
Edge edge(const Corner& a, const Corner& b) { return std::minmax(a.id, b.id); }

Point2 zero_between(const Corner& a, const Corner& b) {
  const Corner &p = a.id < b.id ? a : b, &q = a.id < b.id ? b : a;  // the same bits from both sides
  const double t = crossing(p.value, q.value);
  return {p.at.x + t * (q.at.x - p.at.x), p.at.y + t * (q.at.y - p.at.y)};
}

struct Step {
  Edge to;
  Point2 at;  // of the start
};

/// The piece of the outline in a triangle whose corners run counterclockwise: the inside is to its left.
void trace(std::map<Edge, Step>& steps, const std::array<Corner, 3>& t) {
  for (std::size_t n = 0; n < 3; ++n) {
    const Corner &a = t[n], &b = t[(n + 1) % 3], &c = t[(n + 2) % 3];
    const bool in_a = a.value > 0.0, in_b = b.value > 0.0, in_c = c.value > 0.0;
    if (in_b != in_c || in_a == in_b) continue;  // a is the one that differs
    if (in_a) steps[edge(a, b)] = {edge(c, a), zero_between(a, b)};
    else steps[edge(c, a)] = {edge(a, b), zero_between(c, a)};
  }
}

}  // namespace

RasterValues whole_plane(RasterValues values, bool symmetric) {
  if (!symmetric) return values;
  const Raster& r = values.raster;
  RasterValues whole{r, {}};
  whole.raster.cells_y = 2 * r.cells_y;
  whole.raster.y0 = -r.dy * r.cells_y;
  for (int j = -r.cells_y; j <= r.cells_y; ++j)
    for (int i = 0; i <= r.cells_x; ++i)
      whole.values.push_back(values.values[static_cast<std::size_t>(r.node(i, std::abs(j)))]);
  return whole;
}

double positive_area(const Raster& r, std::span<const double> values) {
  double cells = 0.0;
  for (int j = 0; j < r.cells_y; ++j) {
    const double* low = values.data() + r.node(0, j);
    const double* high = low + r.row();
    for (int i = 0; i < r.cells_x; ++i) {
      const double a = low[i], b = low[i + 1], c = high[i + 1], d = high[i];
      const int positive = (a > 0.0) + (b > 0.0) + (c > 0.0) + (d > 0.0);
      if (positive == 0 || positive == 4) {
        cells += positive / 4;
        continue;
      }
      const double m = 0.25 * (a + b + c + d);
      cells += 0.25 * (positive_share(a, b, m) + positive_share(b, c, m) + positive_share(c, d, m) +
                       positive_share(d, a, m));
    }
  }
  return cells * r.dx * r.dy;
}

Extent positive_extent(const Raster& r, std::span<const double> values) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Extent e{kFar, -kFar, kFar, -kFar};
  const auto take = [&e](double x, double y) {
    e = {std::min(e.low_x, x), std::max(e.high_x, x), std::min(e.low_y, y), std::max(e.high_y, y)};
  };
  for (int j = 0; j <= r.cells_y; ++j)
    for (int i = 0; i <= r.cells_x; ++i) {
      const int n = r.node(i, j);
      const double v = values[n], x = r.x(n), y = r.y(n);
      if (v > 0.0) take(x, y);
      if (i < r.cells_x && (v > 0.0) != (values[n + 1] > 0.0)) take(x + r.dx * crossing(v, values[n + 1]), y);
      if (const int up = n + r.row(); j < r.cells_y && (v > 0.0) != (values[up] > 0.0))
        take(x, y + r.dy * crossing(v, values[up]));
    }
  return e;
}

bool reaches_sides(const Raster& r, std::span<const double> values) {
  for (int n = 0; n < r.nodes(); ++n) {
    const int i = n % r.row(), j = n / r.row();
    const bool side = i == 0 || i == r.cells_x || j == 0 || j == r.cells_y;
    if (side && values[static_cast<std::size_t>(n)] > 0.0) return true;
  }
  return false;
}

std::vector<Polygon> positive_outlines(const Raster& r, std::span<const double> values) {
  // A ring of negative nodes upon the sides closes the outlines there.
  const std::int64_t row = r.row() + 2;
  const auto corner = [&](int i, int j) {
    const int in_i = std::clamp(i, 0, r.cells_x), in_j = std::clamp(j, 0, r.cells_y);
    const int n = r.node(in_i, in_j);
    return Corner{(j + 1) * row + i + 1, {r.x(n), r.y(n)}, in_i == i && in_j == j ? values[n] : -1.0};
  };
  const std::int64_t centres = row * (r.cells_y + 3);
  std::map<Edge, Step> steps;
  for (int j = -1; j <= r.cells_y; ++j)
    for (int i = -1; i <= r.cells_x; ++i) {
      const std::array<Corner, 4> c{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
      Corner centre{centres + c[0].id, {}, 0.0};
      int positive = 0;
      for (const Corner& k : c) {
        centre.at = {centre.at.x + 0.25 * k.at.x, centre.at.y + 0.25 * k.at.y};
        centre.value += 0.25 * k.value;
        positive += k.value > 0.0;
      }
      if (positive == 0 || positive == 4) continue;
      for (std::size_t n = 0; n < 4; ++n) trace(steps, {c[n], c[(n + 1) % 4], centre});
    }

  std::vector<Polygon> outlines;
  while (!steps.empty()) {
    Polygon polygon;
    for (auto at = steps.begin(); at != steps.end();) {
      const auto [to, p] = at->second;
      if (polygon.empty() || polygon.back().x != p.x || polygon.back().y != p.y) polygon.push_back(p);
      steps.erase(at);
      at = steps.find(to);
    }
    if (polygon.size() > 2) outlines.push_back(std::move(polygon));
  }
  std::sort(outlines.begin(), outlines.end(),
            [](const Polygon& a, const Polygon& b) { return signed_area(a) > signed_area(b); });
  return outlines;
}

double signed_area(const Polygon& p) {
  double twice = 0.0;
  for (std::size_t n = 0; n < p.size(); ++n) {
    const Point2 &a = p[n], &b = p[(n + 1) % p.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return 0.5 * twice;
}

bool is_inside(std::span<const Polygon> polygons, const Point2& q) {
  bool inside = false;
  for (const Polygon& p : polygons)
    for (std::size_t n = 0; n < p.size(); ++n) {
      const Point2 &a = p[n], &b = p[(n + 1) % p.size()];
      if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (q.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
  return inside;
}

}  // namespace ejecta
