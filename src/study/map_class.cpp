#include "study/map_class.hpp"

#include <cmath>
#include <numbers>

#include "base/random.hpp"

namespace ejecta {
namespace {

/// Places closer than this are one, m.
constexpr double kSamePlace = 1e-8;

}  // namespace

ClassMember drawn_member(const MapSpec& map, const Point2& at) {
  ClassMember member;
  if (!map.is_of_class()) return member;
  const auto number = [](double v) { return static_cast<std::uint64_t>(std::llround(v / kSamePlace)); };
  const CounterRandom random(static_cast<std::uint64_t>(map.seed), (number(at.x) << 32) ^ number(at.y));
  const auto [low, high] = map.size_factor;
  member.size_factor = low + (high - low) * random.uniform(0);
  if (map.lying == MapLying::turned)
    member.turn = Eigen::AngleAxisd(2.0 * std::numbers::pi * random.uniform(1), Eigen::Vector3d::UnitZ());
  if (map.lying == MapLying::any)
    member.turn = uniform_rotation(random.uniform(1), random.uniform(2), random.uniform(3));
  return member;
}

void become(BodySpec& body, const ClassMember& member) {
  const double f = member.size_factor;
  body.diameter *= f;
  body.size *= f;
  for (auto& sphere : body.spheres)
    for (double& length : sphere) length *= f;
  body.sphere_diameter *= f;
  for (Vec3& vertex : body.vertices) vertex *= f;
  if (body.shape == ShapeKind::mesh || !body.file.empty()) body.scale *= f;
  if (body.mass) *body.mass *= f * f * f;
  if (member.turn.isApprox(Eigen::Quaterniond::Identity())) return;
  const Eigen::AngleAxisd turned(member.turn *
                                 Eigen::AngleAxisd(body.rotation_angle, body.rotation_axis.normalized()));
  body.rotation_axis = turned.axis();
  body.rotation_angle = turned.angle();
}

}  // namespace ejecta
