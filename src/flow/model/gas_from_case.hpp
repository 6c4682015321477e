#pragma once
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "case/case.hpp"
#include "case/expression.hpp"
#include "flow/gas/gas_flow.hpp"
#include "flow/model/inflow.hpp"

namespace ejecta::gas {

/// What a case asks of the compressible solver.
Options options_from_case(const Case& c);

/// Gas of a StateSpec over place and time, compiled once; what it leaves open is the environment's. A
/// turbulent quantity left open is nearly none.
class GasFormula {
 public:
  GasFormula(const Case& c, const StateSpec& spec);
  GasState at(const Vec3& position, double time) const;
  bool is_constant() const;
  bool uses_time() const;

 private:
  const Case& case_;
  std::optional<Expression> pressure_, temperature_, density_, k_, epsilon_;
  std::optional<std::array<Expression, 3>> velocity_;
  template <class Visit>
  bool any(const Visit& visit) const;
};
/// The same, once.
GasState gas_state(const Case& c, const StateSpec& spec, const Vec3& position, double time);

/// omega = epsilon / (beta* k), 1/s
double omega_of(double k, double epsilon);
/// epsilon = beta* k omega, m2/s3
double epsilon_of(double k, double omega);

/// An orifice whose gas a valve drives: a disc of type "jet".
struct DrivenInlet {
  int face = 0;
  int handle = 0;
  Vec3 centre{0, 0, 0};
  double radius = 0.0;                  ///< m
  double still_k = 0.0, still_e = 0.0;  ///< turbulence of what it draws in while it is shut
};

/// Opens the orifices to their supply at this time.
void drive(GasFlow& flow, const std::vector<DrivenInlet>& inlets, const Supply& supply);

/// The faces whose gas is a formula in place or time, their patches apart. A whole face of type "jet" is not
/// among them.
class FormulaFaces {
 public:
  explicit FormulaFaces(const Case& c, const Grid& grid);
  bool vary() const { return vary_; }  ///< with time
  /// Lets every cell of these faces have its gas at `time`.
  void apply(double time, GasFlow& flow) const;
  /// The most that the gas outside becomes faster than at `time`, or is pushed by more pressure, within the
  /// step to `time` + dt; as a Courant number.
  double change(double time, double dt) const;

 private:
  struct Face {
    int face;
    GasFormula formula;
  };
  const Grid& grid_;
  std::vector<Face> faces_;
  bool vary_ = false;
};

/// The solver that flow.solver names, with its boundaries and initial state. An orifice is a total-pressure
/// inlet, shut until its owner opens it; a whole face of type "jet" lets in what its owner sets cell by cell
/// (Boundaries::set_states).
std::unique_ptr<GasFlow> solver_from_case(const Case& c, const Grid& grid, std::vector<DrivenInlet>& inlets);

}  // namespace ejecta::gas
