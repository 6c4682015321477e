#pragma once
#include <Eigen/Geometry>

#include "case/case.hpp"
#include "study/raster.hpp"

namespace ejecta {

/// One body of the class that a map is made of ([map] lying, size_factor).
struct ClassMember {
  double size_factor = 1.0;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  ///< after the body's own rotation, world axes
};

/// Which one comes to a place is drawn once for the place: its coarse and its fine run are of the same body.
ClassMember drawn_member(const MapSpec& map, const Point2& at);
/// All lengths scaled, a given mass with their cube; turned about its centre.
void become(BodySpec& body, const ClassMember& member);

}  // namespace ejecta
