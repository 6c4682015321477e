#pragma once
#include <filesystem>
#include <vector>

#include "base/vec.hpp"
#include "jet/inflow.hpp"

namespace ejecta {

/// A computed jet as it crosses one plane: velocity along and across its axis, k and epsilon on a disc, over
/// time. Stored in a file with a checksum; feeds the lower face of an ejection box.
class JetProfile {
 public:
  /// One moment: values on all radii.
  struct Moment {
    double time = 0.0;  ///< s
    std::vector<double> axial, radial, k, epsilon;
  };

  /// `radii` ascending, m; `height` of the plane above the orifice, m.
  JetProfile(double height, std::vector<double> radii);
  /// Throws Error that names the file and the damage.
  static JetProfile read(const std::filesystem::path& file);
  /// Writes to a temporary file and renames it: the file is whole or not there.
  void write(const std::filesystem::path& file) const;

  /// Moments in ascending time. Throws Error when a value is not finite.
  void add(const Moment& moment);

  /// State at distance r (m) from the axis at time t (s), linear in both; still air outside the last radius,
  /// the first and last moment hold before and after.
  InflowState at(const Vec3& axis_to_point, double t) const;
  /// Thrust through the plane at time t, N: integral of density w^2
  double momentum(double t, double density) const;
  double fastest(double t) const;  ///< largest axial velocity, m/s
  double height() const { return height_; }
  double end_time() const { return moments_.empty() ? 0.0 : moments_.back().time; }
  const std::vector<double>& radii() const { return radii_; }
  const std::vector<Moment>& moments() const { return moments_; }

 private:
  struct Between {
    std::size_t low = 0;
    double share = 0.0;
  };
  Between moment_at(double t) const;
  double height_;
  std::vector<double> radii_;
  std::vector<Moment> moments_;
};

}  // namespace ejecta
