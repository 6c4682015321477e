#pragma once
#include <optional>
#include <span>
#include <vector>

#include "case/case.hpp"
#include "case/problem.hpp"
#include "dem/body.hpp"
#include "grid/grid.hpp"
#include "simulation/scene.hpp"

/// What is wrong with bodies that only shape and grid together can tell: too large, not resolved, half
/// outside.
namespace ejecta {

/// Corners of the box, with edges along the world's axes, that just holds a body where it is; from its
/// centre, m.
struct Reach {
  Vec3 low{0, 0, 0}, high{0, 0, 0};
};
Reach reach_of(const Body& body);
/// Edges of the box in body axes that just holds it, m.
Vec3 body_size(const Body& body);

/// Edges of the box along the axes that just holds a surface, m.
Vec3 extent_of(const TriangleMesh& mesh);

/// The width of a body that the fewest cells lie across, with the widest cells around its place.
struct Resolution {
  double cells = 1e300;
  Width width;  ///< direction in world axes
};
Resolution resolution_of(const Grid& grid, const Body& body, const Vec3& place);
/// E.g. "4.5 cells across its smallest feature (5 mm)".
std::string resolution_words(const Resolution& r, const Body& body);

/// Of the bodies of a case, in its order, as they start.
std::vector<Problem> check_bodies(const Case& c, const Grid& grid, std::span<const Body> bodies);

/// The same for a case that was just read; what cannot be built is a problem too. `scene` receives what was
/// set up (see scene_of), if there is no error.
std::vector<Problem> check_bodies(const Case& c, std::optional<Scene>* scene = nullptr);

/// All that is wrong with a case which only those know who set it up: its bodies, the feed of its sorter.
/// `scene`: as for check_bodies.
std::vector<Problem> check_set_up(const Case& c, std::optional<Scene>* scene = nullptr);

/// Reads a case file and checks it as it is set up as well (see load_case and check_set_up).
Case load_checked(const std::string& path, const std::vector<std::string>& overrides = {},
                  std::vector<Problem>* warnings = nullptr, std::optional<Scene>* scene = nullptr);

}  // namespace ejecta
