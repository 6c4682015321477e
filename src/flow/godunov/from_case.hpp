#pragma once
#include <memory>
#include <vector>

#include "case/case.hpp"
#include "flow/godunov/solver.hpp"

namespace ejecta::godunov {

/// What a case asks of the compressible solver.
Options options_from_case(const Case& c);

/// Gas of a StateSpec at a point and time; what it leaves open is the environment's. A turbulent quantity
/// left open is nearly none.
GasState gas_state(const Case& c, const StateSpec& spec, const Vec3& position, double time);

/// omega = epsilon / (beta* k), 1/s
double omega_of(double k, double epsilon);

/// A face or patch whose gas a valve drives: type "jet".
struct DrivenInlet {
  int face = 0;
  int handle = 0;
  Vec3 centre{0, 0, 0};
  double radius = 0.0;  ///< m; 0: the whole face
};

/// Solver of a case with its boundaries and initial state. A jet's inlet is a total-pressure inlet, shut
/// until its owner opens it.
std::unique_ptr<Solver> solver_from_case(const Case& c, const Grid& grid, std::vector<DrivenInlet>& inlets);

}  // namespace ejecta::godunov
