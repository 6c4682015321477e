#pragma once
#include <string>
#include <vector>

#include "case/case.hpp"
#include "dem/contact_law.hpp"

namespace ejecta {

/// Materials of a case and the constants of each pair of them.
class Materials {
 public:
  /// Throws InputError naming the material and the value that is out of range.
  explicit Materials(const Case& config);

  int count() const { return static_cast<int>(specs_.size()); }
  /// Index of a material by name; no name: the first. Throws InputError with the known names.
  int index(const std::string& name) const;
  const MaterialSpec& spec(int index) const { return specs_[static_cast<std::size_t>(index)]; }
  const PairConstants<double>& pair(int a, int b) const {
    return pairs_[static_cast<std::size_t>(a * count() + b)];
  }
  /// What a body of this material asks of the time step at a contact, 1/(s2) kg/m: times the root of (radius
  /// x overlap) over mass it is time_step.hpp's asked_rate_squared. 0 where the law knows no elastic
  /// stiffness.
  double swiftest(int material) const { return swiftest_[static_cast<std::size_t>(material)]; }
  ContactLaw law() const { return law_; }
  bool allow_tension() const { return allow_tension_; }
  bool any_rolling() const;

 private:
  std::vector<MaterialSpec> specs_;
  std::vector<PairConstants<double>> pairs_;
  std::vector<double> swiftest_;
  ContactLaw law_;
  bool allow_tension_;
};

}  // namespace ejecta
