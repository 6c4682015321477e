#include "shape/convex_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "base/error.hpp"
#include "shape/faceted_solid.hpp"

namespace ejecta {
namespace {

constexpr std::size_t kMostParts = 100;
constexpr std::size_t kMostPlanes = 16;  // of hollow faces, tried for a cut
constexpr double kTolerance = 1e-9;      // of the size: corners this near to a plane lie on it
constexpr double kSliver = 1e-9;         // of the volume: less than this is no piece
constexpr double kFlat = 1e-5;           // of the size: shallower ones are no hollows

struct Piece {
  FacetedSolid solid;
  Polytope hull;
  double volume = 0.0, hull_volume = 0.0;  // m3
  double hollow = 0.0;                     // m, no face lies deeper below the hull
  std::vector<std::size_t> hollow_faces;   // deepest first
};

/// Nothing for a sliver.
std::optional<Piece> make_piece(FacetedSolid solid, double least_volume) {
  Piece piece;
  piece.volume = solid.faces.empty() ? 0.0 : solid.volume();
  if (!(piece.volume > least_volume)) return {};
  try {
    piece.hull = convex_hull(solid.corners());
  } catch (const InputError&) {  // as flat as round-off
    return {};
  }
  piece.hull_volume = volume_polytope(piece.hull);
  piece.solid = std::move(solid);
  return piece;
}

bool same_plane(const Plane& a, const Plane& b, double tolerance) {
  return a.normal.dot(b.normal) > 1 - 1e-12 && std::abs(a.height(b.offset * b.normal)) <= 10 * tolerance;
}

/// Which faces of the hull lie in a cut. They hide no hollow: another piece lies behind them.
std::vector<bool> hull_cuts(const Piece& piece, double tolerance) {
  std::vector<bool> cuts;
  std::vector<Plane> planes;
  for (const FacetedSolid::Face& f : piece.solid.faces)
    if (f.from_cut) planes.push_back(f.plane);
  for (const Polytope::Face& h : piece.hull.faces)
    cuts.push_back(std::any_of(planes.begin(), planes.end(), [&](const Plane& p) {
      return same_plane(p, {h.normal, h.offset}, tolerance);
    }));
  return cuts;
}

/// How deep all of the face lies below one face of the hull: nowhere on it is deeper below the hull.
/// `nearest`: the face of the hull to look at first, as the last was near the one before.
double depth_below(const FacetedSolid::Face& face, const Polytope& hull, const std::vector<bool>& cuts,
                   double tolerance, std::size_t& nearest) {
  double least = 2 * hull.radius;
  const std::size_t count = hull.faces.size(), first = nearest;
  for (std::size_t k = 0; k <= count; ++k) {
    const std::size_t n = k == 0 ? first : k - 1;
    const Polytope::Face& h = hull.faces[n];
    double deepest = 0.0;
    for (const auto& edge : face.edges) {
      deepest = std::max(deepest, h.offset - h.normal.dot(edge.from));
      if (deepest >= least) break;
    }
    if (deepest >= least || (cuts[n] && deepest > 10 * tolerance)) continue;
    least = deepest;
    nearest = n;
  }
  return least;
}

void find_hollows(Piece& piece, double error, double tolerance) {
  const std::vector<bool> cuts = hull_cuts(piece, tolerance);
  std::vector<std::pair<double, std::size_t>> deep;
  std::size_t nearest = 0;
  for (std::size_t n = 0; n < piece.solid.faces.size(); ++n) {
    const FacetedSolid::Face& face = piece.solid.faces[n];
    const double depth = face.from_cut ? 0.0 : depth_below(face, piece.hull, cuts, tolerance, nearest);
    piece.hollow = std::max(piece.hollow, depth);
    if (depth > error) deep.emplace_back(-depth, n);
  }
  std::sort(deep.begin(), deep.end());
  for (const auto& [depth, n] : deep) piece.hollow_faces.push_back(n);
}

/// Planes along which the piece may be cut: of some of its hollow faces, and at quarters of its extent.
std::vector<Plane> planes_for(const Piece& piece, double tolerance) {
  std::vector<Plane> distinct, planes;
  for (const std::size_t n : piece.hollow_faces) {
    const Plane& plane = piece.solid.faces[n].plane;
    if (std::none_of(distinct.begin(), distinct.end(),
                     [&](const Plane& p) { return same_plane(p, plane, tolerance); }))
      distinct.push_back(plane);
  }
  const std::size_t step = (distinct.size() + kMostPlanes - 1) / kMostPlanes;
  for (std::size_t n = 0; n < distinct.size(); n += step) planes.push_back(distinct[n]);
  Vec3 low = piece.hull.vertices.front(), high = low;
  for (const Vec3& v : piece.hull.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  for (const double part : {0.5, 0.25, 0.75})
    for (int c = 0; c < 3; ++c) planes.push_back({Vec3::Unit(c), low[c] + part * (high[c] - low[c])});
  return planes;
}

struct Halves {
  Piece below, above;
};

/// The cut after which the two hulls hold least.
std::optional<Halves> best_cut(const Piece& piece, double tolerance, double least_volume) {
  std::optional<Halves> best;
  double least = std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes_for(piece, tolerance)) {
    CutSolid halves = cut(piece.solid, plane, tolerance);
    auto below = make_piece(std::move(halves.below), least_volume);
    auto above = make_piece(std::move(halves.above), least_volume);
    if (!below || !above) continue;
    const double held = below->hull_volume + above->hull_volume;
    if (held < least - 1e-9 * piece.volume) {  // by round-off is not less: the first stays
      least = held;
      best = Halves{std::move(*below), std::move(*above)};
    }
    if (least <= (1 + 1e-9) * piece.volume) break;  // nothing left to gain
  }
  return best;
}

}  // namespace

std::vector<Polytope> convex_parts(const TriangleMesh& mesh, double error, const std::string& name) {
  FacetedSolid solid = faceted(mesh);
  const double volume = solid.volume();
  std::optional<Piece> whole = make_piece(std::move(solid), 0.0);
  if (!whole) throw InputError(fmt::format("{}: the solid is too flat to be divided", name));
  const double size = whole->hull.radius, tolerance = kTolerance * size;
  const double allowed = std::max(error, kFlat * size);
  find_hollows(*whole, allowed, tolerance);
  std::vector<Piece> pieces{std::move(*whole)};
  while (true) {
    const auto deepest = std::max_element(pieces.begin(), pieces.end(),
                                          [](const Piece& a, const Piece& b) { return a.hollow < b.hollow; });
    if (deepest->hollow <= allowed) break;
    auto halves = pieces.size() < kMostParts ? best_cut(*deepest, tolerance, kSliver * volume) : std::nullopt;
    if (!halves)
      throw InputError(
          fmt::format("{}: the solid is not convex, and {} convex parts still leave hollows of {:.4g} mm",
                      name, pieces.size(), 1e3 * deepest->hollow),
          {.key = "fit_error",
           .expected = "hollows of that depth filled, a simpler mesh, or its hull (shape = \"polyhedron\")",
           .example = fmt::format("fit_error = \"{:.4g} mm\"", 1.05e3 * deepest->hollow)});
    find_hollows(halves->below, allowed, tolerance);
    find_hollows(halves->above, allowed, tolerance);
    *deepest = std::move(halves->below);
    pieces.push_back(std::move(halves->above));
  }
  std::vector<Polytope> parts;
  for (Piece& piece : pieces) parts.push_back(std::move(piece.hull));
  return parts;
}

}  // namespace ejecta
