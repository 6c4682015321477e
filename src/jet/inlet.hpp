#pragma once
#include <memory>

#include "jet/source.hpp"

namespace ejecta {

/// The jet of a case where it enters the box: placed at its orifices, turned into its direction. Where the
/// jets of several orifices meet, their momentum adds up (Reichardt 1942, VDI-Forschungsheft 414), and so do
/// their k and epsilon.
class JetInlet {
 public:
  /// The case has a jet.
  explicit JetInlet(const Case& c, const Note& note = {});

  /// At a cell of the face through which the jet enters; half widths of the cell, m.
  InflowState at(const Vec3& position, const Vec3& half, double time) const;
  /// Highest velocity along the jet where its axis meets the face, m/s: for the choice of the time step.
  double fastest(double time) const { return source_->fastest(time, height_); }
  int face() const { return face_; }  ///< 0..5 = x_min, x_max, y_min, ...
  const JetSource& source() const { return *source_; }

 private:
  InflowState turned(const Vec3& from_orifice, const Vec3& half, double time) const;
  std::unique_ptr<JetSource> source_;
  std::vector<Vec3> orifices_;
  Eigen::Matrix3d turn_;  ///< from the jet's axes, z along it, to those of the box
  int face_;
  double height_;
};

/// What the jet of a case lets into its box: a stream through a face, or the supply of the orifices that the
/// grid of a gas resolves. A computed jet that is not stored yet is computed now.
Inflow inflow_of(const Case& c, const Note& note = {});
/// The same for those who take no step: no jet is computed, and a computed one blows nothing.
Inflow planned_inflow(const Case& c);

}  // namespace ejecta
