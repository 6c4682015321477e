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
  double sharp_small = 0.824, sharp_large = 0.778;  ///< of flat faces with edges: front and back together
  double round_small = 0.690, round_large = 0.797;  ///< of round surfaces
  double front = 2.0 / 3.0;      ///< part of it on what faces the air; the rest pulls at what faces away
  double sharp_widening = 1.24;  ///< of the jet on a face: the air leaves it at its edges
  double round_spread = 1.3;     ///< the air follows a round surface, and so spreads with its radius

  double of(const FeedParticle& particle) const;
  /// How much wider than a free jet of that half radius (m) the jet on the particle is, with the same
  /// momentum. Round: sqrt(1 + (spread r/half radius)^2), r the radius of a disc as large as it from above.
  double widening(const FeedParticle& particle, double half_radius) const;
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

  /// m: blows farther across than this from its centre do not reach it.
  double reach(const FeedParticle& particle) const;
  /// s before and after its passing that a body may meet air, for a command from..to
  bool may_meet(const FeedParticle& p, double at, double y, const Blow& blow) const;

 private:
  struct State;
  /// Of the jets, on that body.
  double widening(const FeedParticle& p) const;
  void push(State& s, const FeedParticle& p, std::span<const Blow> blows, double widening, double time,
            double dt) const;

  const JetField& field_;
  AirCoefficients coefficients_;
  LaunchSpec launch_;
  double gravity_, height_, edge_x_, edge_z_;
};

}  // namespace ejecta
