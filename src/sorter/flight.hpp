#pragma once
#include <optional>
#include <span>
#include <vector>

#include "case/case.hpp"
#include "sorter/feed_particle.hpp"
#include "sorter/jet_field.hpp"

namespace ejecta {

/// How the pressure of the air on a surface follows from the jet there: density times the square of the
/// normal velocity times a coefficient. From resolved runs of particles of two sizes (docs/theory/sorter.md),
/// of which none is a shot of a sorter; linear between them, constant beyond.
struct AirCoefficients {
  double small = 10e-3, large = 20e-3;              ///< m, the two sizes
  double sharp_small = 1.02, sharp_large = 0.88;    ///< of flat faces with edges: front and back together
  double round_small = 0.705, round_large = 0.472;  ///< of round surfaces
  double front = 2.0 / 3.0;  ///< part of it on what faces the air; the rest pulls at what faces away
  double widening = 1.5;     ///< of the jet, with the same momentum: a body spreads it over its face

  double of(const FeedParticle& particle) const;
};

/// A valve that blows, as a body meets it.
struct Blow {
  double y = 0.0;  ///< m, place of the valve
  ValvePulse pulse;
};

/// Where a body was after the air left it, and how it passed the plate.
struct FlightEnd {
  double gain = 0.0;       ///< m/s, of vertical velocity by the air
  double clearance = 0.0;  ///< m, of the centre above the plate's edge
  double y = 0.0;          ///< m, at the plate
  bool touched = false;    ///< by the air
  bool ejected() const { return clearance > 0.0; }
  std::vector<Vec3> path{};  ///< m, from the nozzle, every `kPathStep`, where it was asked for
  double path_from = 0.0;    ///< s, of its first point, in the time of `at`
};

/// The fast tier: one body through the jets of all valves near it, by the pressure on its surface.
class FastFlight {
 public:
  FastFlight(const Case& c, const JetField& field, const AirCoefficients& coefficients = {});

  /// `at`: s, when the centre is over the jets if no air blows. Where there is no blow in reach: the free
  /// flight.
  FlightEnd fly(const FeedParticle& particle, double at, double y, std::span<const Blow> blows,
                bool keep_path = false) const;
  static constexpr double kPathStep = 2e-3;  ///< s

  /// m: blows farther across than this from the centre of a body with this radius do not reach it.
  double reach(double radius) const { return radius + field_.reach(height_); }
  /// s before and after its passing that a body may meet air, for a command from..to
  bool may_meet(const FeedParticle& p, double at, double y, const Blow& blow) const;

 private:
  struct State;
  void push(State& s, const FeedParticle& p, std::span<const Blow> blows, double time, double dt) const;

  const JetField& field_;
  AirCoefficients coefficients_;
  LaunchSpec launch_;
  double gravity_, height_, edge_x_, edge_z_;
};

}  // namespace ejecta
