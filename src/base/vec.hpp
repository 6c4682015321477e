#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ejecta {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;  ///< rotates body axes into the world

}  // namespace ejecta
