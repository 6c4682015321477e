#pragma once
#include <memory>
#include <span>
#include <vector>

#include "base/vec.hpp"
#include "case/case.hpp"
#include "grid/field.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// Air at a point of a jet.
struct JetPoint {
  Vec3 velocity{0, 0, 0};  ///< m/s
  double pressure = 0.0;   ///< Pa absolute
  double density = 0.0;    ///< kg/m3
  double k = 0.0;          ///< m2/s2
  double epsilon = 0.0;    ///< m2/s3
};

/// Flow of one conserved quantity through a plane across the jet.
struct JetFlow {
  double mass = 0.0;      ///< kg/s
  double momentum = 0.0;  ///< N: of rho w^2 + (p - pa) less the axial stress
};

/// The air of a jet, whichever solver computes it.
class JetAir {
 public:
  virtual ~JetAir() = default;
  /// s, from `time` on.
  virtual double stable_dt(double time) = 0;
  virtual void advance(double time, double dt) = 0;
  virtual JetPoint at(const Vec3& position) const = 0;
  /// Per area through the lower face along z of cell (i, j, k); k = nz: through the upper end of the box.
  virtual JetFlow flux(int i, int j, int k) const = 0;

  virtual bool finite(Vec3* where) const = 0;
  /// Everything a resume needs.
  virtual std::vector<NamedField> state_fields() = 0;
  virtual std::vector<double> state_numbers() const = 0;
  /// Once the fields are back.
  virtual void restore_numbers(std::span<const double> numbers, double time) = 0;
};

/// Throws InputError when the solver the case asks for computes no jet.
void require_jet_air(const Case& c);
/// That solver.
std::unique_ptr<JetAir> make_jet_air(const Case& c, const Grid& grid);

}  // namespace ejecta
