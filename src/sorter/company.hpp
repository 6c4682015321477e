#pragma once
#include <span>
#include <vector>

#include "case/case.hpp"
#include "dem/materials.hpp"
#include "sorter/flight.hpp"

namespace ejecta {

/// The fast tier for many: bodies that come near each other while the air moves them fly together. They push
/// each other (contacts by src/dem), and who is nearer to the orifice takes the air of those behind. All
/// others fly alone.
class Company {
 public:
  Company(const Case& c, const FastFlight& flight);

  /// In the order of the flyers. Bodies that lie in each other as they come, seen from above, fly through
  /// each other, and are marked so.
  std::vector<FlightEnd> fly(std::span<const Flyer> flyers) const;

 private:
  struct Group;
  double radius(const Flyer& f) const;
  /// m, from its centre.
  double reach(const Flyer& f, const BodyState& s, const Vec3& direction) const;
  bool lie_in_each_other(const Flyer& a, const Flyer& b) const;
  bool come_near(const Flyer& a, const FlightEnd& a_end, const Flyer& b, const FlightEnd& b_end) const;
  /// Throws where they lie in each other.
  std::vector<FlightEnd> fly_together(std::span<const std::size_t> members,
                                      std::span<const Flyer> flyers) const;

  const FastFlight& flight_;
  std::vector<ParticleClassSpec> classes_;
  Materials materials_;
  ContactSpec contact_;
  double belt_speed_;
  bool meet_;
};

}  // namespace ejecta
