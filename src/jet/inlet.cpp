#include "jet/inlet.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "case/extent.hpp"
#include "jet/drive.hpp"

namespace ejecta {

JetInlet::JetInlet(const Case& c, const Note& note)
    : source_(make_jet_source(c, note)),
      orifices_{c.jet.nozzle},
      turn_(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), c.jet.direction).toRotationMatrix()),
      face_(*jet_face(c)),
      height_(jet_height(c)) {
  orifices_.insert(orifices_.end(), c.jet.more_nozzles.begin(), c.jet.more_nozzles.end());
}

InflowState JetInlet::turned(const Vec3& from_orifice, const Vec3& half, double time) const {
  const Vec3 x = turn_.transpose() * from_orifice, h = turn_.transpose().cwiseAbs() * half;
  InflowState s = source_->at(x, h.x(), h.y(), time);
  s.velocity = turn_ * s.velocity;
  return s;
}

InflowState JetInlet::at(const Vec3& position, const Vec3& half, double time) const {
  if (orifices_.size() == 1) return turned(position - orifices_[0], half, time);
  InflowState sum;
  for (const Vec3& orifice : orifices_) {
    const InflowState s = turned(position - orifice, half, time);
    sum.velocity += s.velocity.norm() * s.velocity;  // momentum flux over density, m2/s2
    sum.k += s.k;
    sum.epsilon += s.epsilon;
  }
  if (const double momentum = sum.velocity.norm(); momentum > 0.0) sum.velocity /= std::sqrt(momentum);
  return sum;
}

namespace {

/// A gas has orifices of its own where the jet is a disc in a face.
bool has_orifices(const Case& c) {
  if (c.flow.solver == FlowSolver::incompressible) return false;
  const auto is_jet = [](const PatchSpec& p) { return p.type == BoundaryType::jet; };
  return std::any_of(c.boundary.begin(), c.boundary.end(), [&](const BoundarySpec& face) {
    return std::any_of(face.patches.begin(), face.patches.end(), is_jet);
  });
}

Inflow of_orifices(const Case& c) {
  Inflow in;
  const auto drive = std::make_shared<const JetDrive>(c);
  in.supply = [drive](double time) { return drive->supply(time); };
  in.events = drive->valve().events();
  in.shut_from = drive->valve().closed_from();
  return in;
}

}  // namespace

Inflow inflow_of(const Case& c, const Note& note) {
  Inflow in;
  if (!has_jet(c)) return in;
  if (has_orifices(c)) return of_orifices(c);
  const auto inlet = std::make_shared<const JetInlet>(c, note);
  in.at = [inlet](const Vec3& x, const Vec3& half, double time) { return inlet->at(x, half, time); };
  in.fastest = [inlet](double time) { return inlet->fastest(time); };
  in.face = inlet->face();
  in.events = inlet->source().events();
  in.shut_from = inlet->source().dead_from();
  return in;
}

Inflow planned_inflow(const Case& c) {
  if (!has_jet(c) || has_orifices(c) || c.jet.kind != JetKind::computed) return inflow_of(c);
  Inflow in;
  in.at = [](const Vec3&, const Vec3&, double) { return InflowState{}; };
  in.fastest = [](double) { return 0.0; };
  in.face = *jet_face(c);
  return in;
}

}  // namespace ejecta
