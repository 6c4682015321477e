#pragma once
#include <memory>
#include <vector>

#include "case/case.hpp"
#include "flow/godunov/gas_flow.hpp"

namespace ejecta::godunov {

/// What a case asks of the compressible solver.
Options options_from_case(const Case& c);

/// Gas of a StateSpec at a point and time; what it leaves open is the environment's. A turbulent quantity
/// left open is nearly none.
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
  double radius = 0.0;  ///< m
};

/// The solver that flow.solver names, with its boundaries and initial state. An orifice is a total-pressure
/// inlet, shut until its owner opens it; a whole face of type "jet" lets in what its owner sets cell by cell
/// (Boundaries::set_states).
std::unique_ptr<GasFlow> solver_from_case(const Case& c, const Grid& grid, std::vector<DrivenInlet>& inlets);

}  // namespace ejecta::godunov
