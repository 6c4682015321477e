#include "coupling/resolved/cut_map.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace ejecta {
namespace {

/// Cells around the body's box that donors of ghosts may lie in.
constexpr int kMargin = 3;
/// Widths of a cell within which distances are measured.
constexpr double kBand = 2.8;
/// How far the distances of a face's corners may be from those of a plane before an edge of the body is
/// sought in it, and between which turns of the surface (sine) it passes from smooth to sharp.
constexpr float kSharp = 0.01f;
constexpr double kSmoothTurn = 0.3, kSharpTurn = 0.6;
/// To what part of a cell points of the surface are known.
constexpr double kExact = 1e-3;
/// Of the widest cell: a point so near to a surface lies on it.
constexpr double kOnSurface = 1e-7;
/// Open up to round-off.
constexpr float kOpenRoundOff = 1e-5f;

/// The signed distance changes by no more than the way moved: calls measure(m) for the points of a row that
/// may lie within `band` of the surface, and gives the others a value beyond it with the right sign.
template <class Position, class Measure>
void measure_row(int n, double band, const Position& position, const Measure& measure, float* out) {
  double known = 0.0, known_at = 0.0;
  bool have = false;
  for (int m = 0; m < n; ++m) {
    const double x = position(m);
    if (have && std::abs(known) - (x - known_at) > band) {
      out[m] = static_cast<float>(std::copysign(std::abs(known) - (x - known_at), known));
      continue;
    }
    known = measure(m);
    known_at = x;
    have = true;
    out[m] = static_cast<float>(known);
  }
}

/// Whether the distances of the corners (0,0), (1,0), (1,1), (0,1) of a face are far from those of a plane.
bool sharp(const std::array<float, 4>& d) {
  const float along =
      std::max({std::abs(d[1] - d[0]), std::abs(d[2] - d[3]), std::abs(d[3] - d[0]), std::abs(d[2] - d[1])});
  return std::abs(d[0] - d[1] - d[3] + d[2]) > kSharp * along;
}

/// Where a function that changes sign between 0 (value a) and 1 (value b) vanishes, by the Illinois rule.
template <class F>
double root(double a, double b, const F& f) {
  double x0 = 0.0, x1 = 1.0, x = 0.5;
  for (int n = 0; n < 30; ++n) {
    x = (x0 * b - x1 * a) / (b - a);
    const double y = f(x);
    if (std::abs(y) < 1e-4 * (std::abs(a) + std::abs(b)) || x1 - x0 < 1e-4) break;
    if ((y < 0.0) == (a < 0.0)) {
      x0 = x, a = y, b *= 0.5;
    } else {
      x1 = x, b = y, a *= 0.5;
    }
  }
  return std::clamp(x, 0.0, 1.0);
}

/// Fluid part of a unit square from its corners (0,0), (1,0), (1,1), (0,1), whether they are fluid, and the
/// fluid part of the edges that follow them. tip(x, y of where the surface is left, of where it is reached
/// again) may put a further corner between both into the first pair.
template <class Tip>
float fluid_part(const std::array<bool, 4>& fluid, const std::array<float, 4>& edge, const Tip& tip) {
  constexpr float x[4] = {0, 1, 1, 0}, y[4] = {0, 0, 1, 1};
  float px[10], py[10];
  int n = 0;
  for (int c = 0; c < 4; ++c) {
    const int next = (c + 1) % 4;
    const std::size_t s = static_cast<std::size_t>(c);
    if (fluid[s]) px[n] = x[c], py[n++] = y[c];
    if (fluid[s] == fluid[static_cast<std::size_t>(next)]) continue;
    const float t = fluid[s] ? edge[s] : 1.0f - edge[s];
    px[n] = x[c] + t * (x[next] - x[c]);
    py[n++] = y[c] + t * (y[next] - y[c]);
    if (!fluid[s]) continue;
    // The surface is entered here and left at the next cut edge.
    for (int e = next; e != c; e = (e + 1) % 4) {
      const std::size_t o = static_cast<std::size_t>(e), after = static_cast<std::size_t>((e + 1) % 4);
      if (fluid[o] == fluid[after]) continue;
      const float u = fluid[o] ? edge[o] : 1.0f - edge[o];
      float tx = x[e] + u * (x[after] - x[e]), ty = y[e] + u * (y[after] - y[e]);
      if (tip(px[n - 1], py[n - 1], tx, ty)) px[n] = tx, py[n++] = ty;
      break;
    }
  }
  float area = 0;
  for (int c = 0; c < n; ++c) area += px[c] * py[(c + 1) % n] - px[(c + 1) % n] * py[c];
  return std::clamp(0.5f * area, 0.0f, 1.0f);
}

}  // namespace

CutMap::CutMap(const Grid& grid, const std::array<bool, 3>& periodic) : grid_(grid), periodic_(periodic) {}

double CutMap::coordinate(int d, int node) const {
  const Axis& axis = grid_.axis(d);
  // Two-dimensional flow: bodies are cut by the plane of the cells.
  return grid_.active(d) ? axis.face[static_cast<std::size_t>(node)] : axis.centre[0];
}

bool CutMap::find_region(const Body& body, const Vec3& shift, Region& r) const {
  for (int d = 0; d < 3; ++d) {
    const std::size_t s = static_cast<std::size_t>(d);
    const Axis& axis = grid_.axis(d);
    r.low[s] = 0;
    r.n[s] = axis.n;
    if (!grid_.active(d)) continue;
    const Vec3 along = body.orientation.conjugate() * Vec3::Unit(d);
    const double at = body.position[d] + shift[d];
    const double high = at + along.dot(body.shape.support(along)),
                 low = at + along.dot(body.shape.support(-along));
    if (high <= axis.face.front() || low >= axis.face.back()) return false;
    const int first = std::max(axis.cell_at(low) - kMargin, 0),
              last = std::min(axis.cell_at(high) + kMargin, axis.n - 1);
    r.low[s] = first;
    r.n[s] = last - first + 1;
  }
  r.body = &body;
  r.shift = shift;
  return true;
}

void CutMap::measure(Region& r) {
  double widest = 0.0;
  for (int d = 0; d < 3; ++d)
    for (int m = 0; grid_.active(d) && m < r.n[static_cast<std::size_t>(d)]; ++m)
      widest = std::max(
          widest, grid_.axis(d).width[static_cast<std::size_t>(r.low[static_cast<std::size_t>(d)] + m)]);
  const Vec3 shift = r.shift;
  const Body& body = *r.body;
  // What lies on a surface but for round-off lies on it, on whichever side the round-off is.
  const auto distance = [&, hair = kOnSurface * widest](const Vec3& x) {
    const double d = body.signed_distance(x - shift);
    return std::abs(d) < hair ? 0.0 : d;
  };
  const int nx = r.n[0] + 1, ny = r.n[1] + 1, nz = r.n[2] + 1;
  r.node.resize(static_cast<std::size_t>(nx) * ny * nz);
  for_each_index(nz, [&](int k) {
    for (int j = 0; j < ny; ++j)
      measure_row(
          nx, kBand * widest, [&](int i) { return coordinate(0, r.low[0] + i); },
          [&](int i) {
            return distance(
                {coordinate(0, r.low[0] + i), coordinate(1, r.low[1] + j), coordinate(2, r.low[2] + k)});
          },
          r.node.data() + static_cast<std::size_t>(k * ny + j) * nx);
  });
  r.distance.resize(static_cast<std::size_t>(r.n[0]) * r.n[1] * r.n[2]);
  for_each_index(r.n[2], [&](int k) {
    for (int j = 0; j < r.n[1]; ++j) {
      const float* a = r.node.data() + static_cast<std::size_t>(k * ny + j) * nx;
      const float *b = a + nx, *c = a + static_cast<std::ptrdiff_t>(nx) * ny, *d = c + nx;
      float* out = r.distance.data() + r.at(r.low[0], r.low[1] + j, r.low[2] + k);
      for (int i = 0; i < r.n[0]; ++i) {
        out[i] = 0.125f * (a[i] + a[i + 1] + b[i] + b[i + 1] + c[i] + c[i + 1] + d[i] + d[i + 1]);
        if (std::abs(out[i]) < 1.5 * widest)
          out[i] = static_cast<float>(distance(grid_.centre(r.low[0] + i, r.low[1] + j, r.low[2] + k)));
      }
    }
  });
}

/// Entry (i, j, k) of edge_[d] is the edge from node (i, j, k) along d, all arrays with the extent of the
/// nodes.
void CutMap::cut_edges(const Region& r) {
  const int nx = r.n[0] + 1, ny = r.n[1] + 1, nz = r.n[2] + 1;
  const std::array<int, 3> extent{nx, ny, nz}, step{1, nx, nx * ny};
  for (auto& e : edge_) e.resize(r.node.size());
  for_each_index(nz, [&](int k) {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const std::size_t at = static_cast<std::size_t>((k * ny + j) * nx + i);
        const std::array<int, 3> index{i, j, k};
        for (std::size_t d = 0; d < 3; ++d) {
          if (index[d] + 1 >= extent[d]) continue;
          const double a = r.node[at], b = r.node[at + static_cast<std::size_t>(step[d])];
          float& fluid = edge_[d][at];
          if ((a < 0.0) == (b < 0.0)) {
            fluid = a < 0.0 ? 0.0f : 1.0f;
            continue;
          }
          Vec3 x;
          for (int e = 0; e < 3; ++e)
            x[e] = coordinate(e, r.low[static_cast<std::size_t>(e)] + index[static_cast<std::size_t>(e)]);
          const double start = x[int(d)], length = coordinate(int(d), r.low[d] + index[d] + 1) - start;
          const double t = root(a, b, [&](double s) {
            x[int(d)] = start + s * length;
            return r.body->signed_distance(x - r.shift);
          });
          fluid = static_cast<float>(a < 0.0 ? 1.0 - t : t);
        }
      }
  });
}

/// Where the tangents of the surface in the points 0 and 1 of a face (parts of its widths) meet: the edge of
/// a body, which the line between both would cut off (Kobbelt et al. 2001). Not where they meet outside;
/// where the surface hardly turns, between that point and the line.
CutMap::Tip CutMap::find_tip(const Region& r, const std::array<int, 3>& node, std::size_t a, std::size_t b,
                             float x0, float y0, float x1, float y1) const {
  Vec3 low, size{0, 0, 0};
  for (std::size_t d = 0; d < 3; ++d) low[int(d)] = coordinate(int(d), r.low[d] + node[d]);
  for (const std::size_t d : {a, b}) size[int(d)] = coordinate(int(d), r.low[d] + node[d] + 1) - low[int(d)];
  const auto normal = [&](float x, float y) {
    Vec3 point = low - r.shift;
    point[int(a)] += double(x) * size[int(a)];
    point[int(b)] += double(y) * size[int(b)];
    return Vec3(r.body->orientation * r.body->shape.gradient(r.body->to_body(point)));
  };
  // A hair towards each other: a point on an edge of the body has the normal of the side that lies between.
  const float hair_x = float(kExact) * (x1 - x0), hair_y = float(kExact) * (y1 - y0);
  const Vec3 normal0 = normal(x0 + hair_x, y0 + hair_y), normal1 = normal(x1 - hair_x, y1 - hair_y);
  const double sharp =
      std::clamp((normal0.cross(normal1).norm() - kSmoothTurn) / (kSharpTurn - kSmoothTurn), 0.0, 1.0);
  if (!(sharp > 0.0)) return {};
  const auto in_face = [&](const Vec3& n) {
    return Eigen::Vector2d(n[int(a)] * size[int(a)], n[int(b)] * size[int(b)]).normalized();
  };
  const Eigen::Vector2d n0 = in_face(normal0), n1 = in_face(normal1);
  const double turn = n0.x() * n1.y() - n0.y() * n1.x();
  if (!(std::abs(turn) > kExact)) return {};
  const double c0 = n0.x() * double(x0) + n0.y() * double(y0), c1 = n1.x() * double(x1) + n1.y() * double(y1);
  const double x = (c0 * n1.y() - c1 * n0.y()) / turn, y = (n0.x() * c1 - n1.x() * c0) / turn;
  if (!(std::abs(x - 0.5) <= 0.5 + kExact && std::abs(y - 0.5) <= 0.5 + kExact)) return {};
  const double mx = 0.5 * double(x0 + x1), my = 0.5 * double(y0 + y1);
  return {static_cast<float>(sharp), static_cast<float>(mx + sharp * (std::clamp(x, 0.0, 1.0) - mx)),
          static_cast<float>(my + sharp * (std::clamp(y, 0.0, 1.0) - my))};
}

/// Entry (i, j, k) of face_[d] is the lower d-face of cell (i, j, k), with the extent of the nodes.
void CutMap::close_faces(const Region& r) {
  const int nx = r.n[0] + 1, ny = r.n[1] + 1, nz = r.n[2] + 1;
  const std::array<int, 3> extent{nx, ny, nz}, step{1, nx, nx * ny};
  for (auto& f : face_) f.resize(r.node.size());
  for (auto& t : tip_) t.assign(r.node.size(), {});
  for_each_index(nz, [&](int k) {
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const std::size_t at = static_cast<std::size_t>((k * ny + j) * nx + i);
        const std::array<int, 3> index{i, j, k};
        for (std::size_t d = 0; d < 3; ++d) {
          const std::size_t a = (d + 1) % 3, b = (d + 2) % 3;
          if (index[a] + 1 >= extent[a] || index[b] + 1 >= extent[b]) continue;
          const std::size_t sa = static_cast<std::size_t>(step[a]), sb = static_cast<std::size_t>(step[b]);
          const std::array<float, 4> corner{r.node[at], r.node[at + sa], r.node[at + sa + sb],
                                            r.node[at + sb]};
          const std::array<bool, 4> fluid{corner[0] >= 0, corner[1] >= 0, corner[2] >= 0, corner[3] >= 0};
          const int corners = fluid[0] + fluid[1] + fluid[2] + fluid[3];
          const auto tip = [&](float x0, float y0, float& x1, float& y1) {
            if ((corners == 2 && fluid[0] == fluid[2]) || !sharp(corner)) return false;
            const Tip found = find_tip(r, {i, j, k}, a, b, x0, y0, x1, y1);
            if (!(found.sharp > 0)) return false;
            tip_[d][at] = found;
            x1 = found.x;
            y1 = found.y;
            return true;
          };
          face_[d][at] =
              corners == 4 ? 0.0f
              : corners == 0
                  ? 1.0f
                  : 1.0f - fluid_part(fluid,
                                      {edge_[a][at], edge_[b][at + sa], edge_[a][at + sb], edge_[b][at]},
                                      tip);
        }
      }
  });
}

void CutMap::record(const Region& r, int region) {
  const int nx = r.n[0] + 1, ny = r.n[1] + 1;
  const std::array<std::size_t, 3> step{1, static_cast<std::size_t>(nx), static_cast<std::size_t>(nx) * ny};
  if (planes_.size() < static_cast<std::size_t>(r.n[2])) planes_.resize(static_cast<std::size_t>(r.n[2]));
  for_each_index(r.n[2], [&](int k) {
    std::vector<Record>& list = planes_[static_cast<std::size_t>(k)];
    list.clear();
    for (int j = 0; j < r.n[1]; ++j)
      for (int i = 0; i < r.n[0]; ++i) {
        const std::size_t at = static_cast<std::size_t>((k * ny + j) * nx + i);
        Record c{r.low[0] + i, r.low[1] + j, r.low[2] + k, region, {}, 0, 0, {}};
        float most = 0, tips = 0;
        for (std::size_t d = 0; d < 3; ++d) {
          c.closed[2 * d] = face_[d][at];
          c.closed[2 * d + 1] = face_[d][at + step[d]];
          most = std::max({most, c.closed[2 * d], c.closed[2 * d + 1]});
          for (std::size_t up = 0; up < 2; ++up) {
            const Tip& tip = tip_[d][at + up * step[d]];
            tips += tip.sharp;
            c.edge = std::max(c.edge, tip.sharp);
            c.tip[d] += tip.sharp * static_cast<float>(up);
            c.tip[(d + 1) % 3] += tip.sharp * tip.x;
            c.tip[(d + 2) % 3] += tip.sharp * tip.y;
          }
        }
        if (most < kOpenRoundOff) continue;
        for (float& x : c.tip) x = tips > 0 ? x / tips : 0.5f;
        c.distance = r.distance[r.at(c.i, c.j, c.k)];
        list.push_back(c);
      }
  });
  for (int k = 0; k < r.n[2]; ++k) {
    const auto& list = planes_[static_cast<std::size_t>(k)];
    records_.insert(records_.end(), list.begin(), list.end());
  }
}

/// From the distances of the corners of the cell.
Vec3 CutMap::normal_at(const Region& r, int i, int j, int k) const {
  const int nx = r.n[0] + 1, ny = r.n[1] + 1;
  const float* first =
      r.node.data() + static_cast<std::size_t>(((k - r.low[2]) * ny + j - r.low[1]) * nx + i - r.low[0]);
  const int at[3] = {i, j, k};
  Vec3 n{0, 0, 0};
  for (int corner = 0; corner < 8; ++corner) {
    const int up[3] = {corner & 1, (corner >> 1) & 1, corner >> 2};
    const double distance = first[up[0] + nx * (up[1] + ny * up[2])];
    for (int d = 0; d < 3; ++d)
      if (grid_.active(d))
        n[d] += (up[d] ? distance : -distance) / grid_.axis(d).width[static_cast<std::size_t>(at[d])];
  }
  const double length = n.norm();
  return length > 0.0 ? Vec3(n / length) : Vec3(Vec3::Zero());
}

double CutMap::width_along(const Vec3& normal, int i, int j, int k) const {
  const int at[3] = {i, j, k};
  double width = 0.0;
  for (int d = 0; d < 3; ++d)
    width += std::abs(normal[d]) * grid_.axis(d).width[static_cast<std::size_t>(at[d])];
  return width;
}

/// Fluid part of a cell by the divergence theorem: the integral of x . n over its open faces and its wall is
/// its volume times the number of directions; x from its centre, or from a point on the body's edge, which
/// both walls there pass through.
double CutMap::part_fluid(const Record& r) const {
  double from_centre = 0.0, from_tip = 0.0, wall2 = 0.0;
  int directions = 0;
  const int at[3] = {r.i, r.j, r.k};
  double volume = 1.0;
  for (int d = 0; d < 3; ++d) volume *= grid_.axis(d).width[static_cast<std::size_t>(at[d])];
  for (std::size_t d = 0; d < 3; ++d) {
    if (!grid_.active(int(d))) continue;
    ++directions;
    const double low = 1.0 - double(r.closed[2 * d]), high = 1.0 - double(r.closed[2 * d + 1]);
    from_centre += 0.5 * (low + high);
    from_tip += double(r.tip[d]) * low + (1.0 - double(r.tip[d])) * high;
    const double area = volume / grid_.axis(int(d)).width[static_cast<std::size_t>(at[d])] * (low - high);
    wall2 += area * area;
  }
  from_centre += std::sqrt(wall2) * double(r.distance) / volume;
  return std::clamp((from_centre + double(r.edge) * (from_tip - from_centre)) / directions, 0.0, 1.0);
}

void CutMap::clear(CutCells& out) const {
  if (out.index.size() == 0) {
    out.index = Array3<int>(grid_.nx(), grid_.ny(), grid_.nz());
    for (Field& f : out.closed) f = grid_.make_field();
  }
  for (const CutCell& c : out.cells) out.index(c.i, c.j, c.k) = 0;
  for (const GhostCell& g : out.ghosts) out.index(g.i, g.j, g.k) = 0;
  for (const CutFace& f : out.faces) out.closed[static_cast<std::size_t>(f.d)](f.i, f.j, f.k) = 0;
  out.cells.clear();
  out.members.clear();
  out.walls.clear();
  out.faces.clear();
  out.ghosts.clear();
  out.near.clear();
}

void CutMap::map(std::span<const Body> bodies, std::span<const double> roughness, CutCells& out) {
  clear(out);
  records_.clear();
  ghost_region_.clear();
  used_ = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::array<int, 3> images{};
    for (std::size_t d = 0; d < 3; ++d) images[d] = periodic_[d] && grid_.active(int(d)) ? 1 : 0;
    for (int kz = -images[2]; kz <= images[2]; ++kz)
      for (int ky = -images[1]; ky <= images[1]; ++ky)
        for (int kx = -images[0]; kx <= images[0]; ++kx) {
          const Vec3 shift(kx * grid_.axis(0).length(), ky * grid_.axis(1).length(),
                           kz * grid_.axis(2).length());
          if (static_cast<std::size_t>(used_) == regions_.size()) regions_.emplace_back();
          Region& r = regions_[static_cast<std::size_t>(used_)];
          if (!find_region(bodies[b], shift, r)) continue;
          r.index = static_cast<int>(b);
          r.roughness = b < roughness.size() ? roughness[b] : 0.0;
          measure(r);
          cut_edges(r);
          close_faces(r);
          record(r, used_);
          ++used_;
        }
  }
  if (used_ > 1)
    std::stable_sort(records_.begin(), records_.end(), [this](const Record& a, const Record& b) {
      return key(a.i, a.j, a.k) < key(b.i, b.j, b.k);
    });
  collect_faces(out);
  collect_cells(out);
  lock_in(out);
  choose_carriers(out);
  close_dead_ends(out);
  list_members(out);
  find_donors(out);
  list_near(out);
  out.pressure_impulse.assign(out.walls.size(), Vec3::Zero());
  out.friction_impulse.assign(out.walls.size(), Vec3::Zero());
}

}  // namespace ejecta
