#include "app/jet_inlet.hpp"

#include <Eigen/Geometry>

#include "case/extent.hpp"

namespace ejecta {

JetInlet::JetInlet(const Case& c)
    : source_(make_jet_source(c)),
      orifices_{c.jet.nozzle},
      turn_(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), c.jet.direction).toRotationMatrix()),
      face_(*jet_face(c)),
      height_(jet_height(c)) {
  orifices_.insert(orifices_.end(), c.jet.more_nozzles.begin(), c.jet.more_nozzles.end());
}

JetState JetInlet::turned(const Vec3& from_orifice, const Vec3& half, double time) const {
  const Vec3 x = turn_.transpose() * from_orifice, h = turn_.transpose().cwiseAbs() * half;
  JetState s = source_->at(x, h.x(), h.y(), time);
  s.velocity = turn_ * s.velocity;
  return s;
}

JetState JetInlet::at(const Vec3& position, const Vec3& half, double time) const {
  if (orifices_.size() == 1) return turned(position - orifices_[0], half, time);
  JetState sum;
  for (const Vec3& orifice : orifices_) {
    const JetState s = turned(position - orifice, half, time);
    sum.velocity += s.velocity.norm() * s.velocity;  // momentum flux over density, m2/s2
    sum.k += s.k;
    sum.epsilon += s.epsilon;
  }
  if (const double momentum = sum.velocity.norm(); momentum > 0.0) sum.velocity /= std::sqrt(momentum);
  return sum;
}

Vec3 half_widths(const Grid& grid, const Vec3& x) {
  Vec3 half;
  for (int d = 0; d < 3; ++d) {
    const Axis& a = grid.axis(d);
    half[d] = 0.5 * a.width[static_cast<std::size_t>(a.cell_at(x[d]))];
  }
  if (grid.axisymmetric()) half.y() = 0.0;
  return half;
}

double width_inside(const Grid& grid, int face) {
  const Axis& a = grid.axis(face / 2);
  return face % 2 ? a.width.back() : a.width.front();
}

std::unique_ptr<JetInlet> make_jet_inlet(const Case& c) {
  return has_jet(c) ? std::make_unique<JetInlet>(c) : nullptr;
}

}  // namespace ejecta
