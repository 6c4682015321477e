#pragma once
#include <optional>
#include <string>
#include <vector>

#include "case/problem.hpp"
#include "simulation/scene.hpp"

/// What awaits bodies that no air touches: told from the case before anything is computed.
namespace ejecta {

/// From a first to a last time, s.
struct Span {
  double from = 0.0, to = 0.0;
};

struct Prospect {
  std::optional<Span> in_box;    ///< any part of it is in the computed box
  std::optional<Span> over_jet;  ///< any part of it is where the jet of an orifice blows
  double beside = 0.0;           ///< m, least distance from the jet of one that never is over it
  std::optional<double>
      at_plate;             ///< s, its centre passes the edge of the plate; also after the end of the run
  double above_edge = 0.0;  ///< m, of the centre, as it does so
};

/// The bodies of a case, with its copies written out, and where they start.
struct Company {
  std::vector<Body> bodies;
  std::vector<FlightState> starts;
};
Company company_of(const Case& c);
Company company_of(const Scene& scene);

/// Of the n-th body. `c`: with its copies written out.
Prospect prospect_of(const Case& c, const Company& company, std::size_t n, const Splitter* plate);

/// How the valve moves: when it opens, how far, when it is shut.
struct ValveProspect {
  Span open;            ///< s, of the first pulse
  double widest = 0.0;  ///< 0 to 1
  Span widest_at;       ///< s
};
ValveProspect prospect_of_valve(const Case& c);

/// Where the jet, the pulse, the plate and the end of the run miss the bodies.
std::vector<Problem> check_prospects(const Case& c, const Company& company, const Splitter* plate);

/// "over the jet from 1.22 ms to 9.22 ms, past the plate's edge at 87 ms" of a body, "" of one that goes
/// nowhere.
std::string prospect_words(const Prospect& p, bool jet);

}  // namespace ejecta
