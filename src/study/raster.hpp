#pragma once
#include <span>
#include <vector>

namespace ejecta {

struct Point2 {
  double x = 0.0, y = 0.0;
};
/// Closed: the last corner joins the first. What is inside lies to the left, so that holes run clockwise.
using Polygon = std::vector<Point2>;

/// Nodes of a rectangle, x running fastest; values between them are linear in the four triangles that the
/// diagonals make of a cell, whose centre has the mean of its corners. Area and outline are exact for that
/// interpolant and therefore agree.
struct Raster {
  double x0 = 0.0, y0 = 0.0;  ///< lower corner, m
  double dx = 0.0, dy = 0.0;  ///< sides of a cell, m
  int cells_x = 0, cells_y = 0;

  int row() const { return cells_x + 1; }
  int nodes() const { return row() * (cells_y + 1); }
  int node(int i, int j) const { return j * row() + i; }
  double x(int node) const { return x0 + dx * (node % row()); }
  double y(int node) const { return y0 + dy * (node / row()); }
};

struct RasterValues {
  Raster raster;
  std::vector<double> values;  ///< at the nodes
};

/// Of the half above y = 0, whose lowest nodes lie there, where the values are symmetric: with what is the
/// same below. Otherwise as they are.
RasterValues whole_plane(RasterValues values, bool symmetric);

/// Area where `values` at the nodes are positive, m2.
double positive_area(const Raster& raster, std::span<const double> values);

/// The box around what is positive, from the crossings on the edges of cells; low > high where nothing is.
struct Extent {
  double low_x, high_x, low_y, high_y;  ///< m
};
Extent positive_extent(const Raster& raster, std::span<const double> values);

/// Something is positive on the sides of the raster: what is positive goes on beyond them.
bool reaches_sides(const Raster& raster, std::span<const double> values);

/// Outlines of what is positive, closed along the raster's sides.
std::vector<Polygon> positive_outlines(const Raster& raster, std::span<const double> values);

/// Enclosed area, m2: positive where the inside is to the left.
double signed_area(const Polygon& polygon);
/// By the rule of even and odd crossings over all polygons.
bool is_inside(std::span<const Polygon> polygons, const Point2& point);

}  // namespace ejecta
