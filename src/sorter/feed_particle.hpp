#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.hpp"
#include "shape/shape.hpp"

/// What the devices of a sorter hand on: particles on the belt -> objects that the camera sees -> commands ->
/// fates. Plain data, SI units. A place along the belt is a time: what lies at x comes to any fixed line at x
/// / belt speed, so x grows against the belt's motion and smaller x are first.
namespace ejecta {

/// A particle as many have it: shape at a reference size, lying as it rests on the belt (z up).
struct Prototype {
  Shape shape;
  double size = 1.0;                   ///< m, of the reference
  Quat resting = Quat::Identity();     ///< body axes -> as it lies
  bool sharp = true;                   ///< flat faces with edges, at which the air separates; else round
  double volume = 0.0;                 ///< m3
  Vec3 inertia{0, 0, 0};               ///< m5, principal, of unit density
  double height = 0.0;                 ///< m, as it lies
  double area = 0.0, perimeter = 0.0;  ///< m2, m: of its outline from above
  std::vector<Vec3> corners{};         ///< m, of its convex hull, body axes
  std::vector<Vec3> outline{};         ///< m, from above, counter-clockwise, about the centre of mass (z = 0)
  /// The surface in small pieces, body axes: point and area times outward normal, m and m2.
  struct Piece {
    Vec3 point, area;
  };
  std::vector<Piece> surface{};
  double file_scale = 1.0;  ///< of a mesh: this size over that in its file
};

struct FeedParticle {
  std::uint64_t id = 0;
  int kind = 0;  ///< class
  const Prototype* prototype = nullptr;
  double scale = 1.0;            ///< size over that of the prototype
  double x = 0.0, y = 0.0;       ///< m, centre of mass; y from the middle of the belt
  double yaw = 0.0;              ///< rad, about z as it flies, x along the motion
  Quat tilt = Quat::Identity();  ///< before that: where it does not lie as it rests
  double mass = 0.0;             ///< kg
  double signal = 0.0;
  double late = 0.0, beside = 0.0;  ///< s, m: what it comes later and farther across than it was seen
  double slip = 0.0;                ///< m/s, that it is slower than the belt as it is seen
  Quat turned = Quat::Identity();   ///< between being seen and leaving the belt
  Vec3 spin{0, 0, 0};               ///< rad/s, as it leaves the belt

  double size() const { return scale * prototype->size; }
};

/// Body axes -> as it lies on the belt where it is seen (x along the motion).
Quat orientation_of(const FeedParticle& p);

/// Its outline on the belt, m.
std::vector<Vec3> outline_of(const FeedParticle& p);
double plan_area(const FeedParticle& p);  ///< m2, of it

/// What the camera makes out.
struct SeenObject {
  double x_low = 0.0, x_high = 0.0, y_low = 0.0, y_high = 0.0;  ///< m
  double x = 0.0, y = 0.0;                                      ///< m, centre of its pixels
  std::int64_t pixels = 0;
  double signal = 0.0;       ///< mean over them
  std::vector<int> members;  ///< the particles that it truly is; no device reads this
  bool eject = false;        ///< as it is read
};

/// Valves `first` to `last` are told to open for [from, to) (s, in which x = 0 is at the jets at time 0).
struct ValveCommand {
  int object = 0;
  int first = 0, last = 0;
  double from = 0.0, to = 0.0;
};

/// One opening of one valve after overlapping commands are merged.
struct ValvePulse {
  double from = 0.0, to = 0.0;  ///< s, as commanded
  double strength = 1.0;        ///< momentum of its jet over that of the full supply
  double use = 1.0;             ///< of air, likewise
};
/// Of every valve, in ascending time.
using ValvePulses = std::vector<std::vector<ValvePulse>>;

}  // namespace ejecta
