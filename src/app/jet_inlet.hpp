#pragma once
#include <memory>

#include "app/jet_source.hpp"

namespace ejecta {

/// The jet of a case where it enters the box: placed at its orifices, turned into its direction. Where the
/// jets of several orifices meet, their momentum adds up (Reichardt 1942, VDI-Forschungsheft 414), and so do
/// their k and epsilon.
class JetInlet {
 public:
  /// The case has a jet.
  explicit JetInlet(const Case& c);

  /// At a cell of the face through which the jet enters; half widths of the cell, m.
  JetState at(const Vec3& position, const Vec3& half, double time) const;
  /// Highest velocity along the jet where its axis meets the face, m/s: for the choice of the time step.
  double fastest(double time) const { return source_->fastest(time, height_); }
  int face() const { return face_; }  ///< 0..5 = x_min, x_max, y_min, ...
  const JetSource& source() const { return *source_; }

 private:
  JetState turned(const Vec3& from_orifice, const Vec3& half, double time) const;
  std::unique_ptr<JetSource> source_;
  std::vector<Vec3> orifices_;
  Eigen::Matrix3d turn_;  ///< from the jet's axes, z along it, to those of the box
  int face_;
  double height_;
};

/// Half widths of the cell at x, or of the nearest, m; none around the axis of an axisymmetric grid.
Vec3 half_widths(const Grid& grid, const Vec3& x);
/// Width across a face (0..5) of the cells inside it, m.
double width_inside(const Grid& grid, int face);

/// The jet of the case; null where it has none.
std::unique_ptr<JetInlet> make_jet_inlet(const Case& c);

}  // namespace ejecta
