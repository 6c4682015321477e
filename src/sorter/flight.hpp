#pragma once
#include <functional>
#include <span>
#include <vector>

#include "case/case.hpp"
#include "dem/loads.hpp"
#include "sorter/feed_particle.hpp"
#include "sorter/jet_field.hpp"

namespace ejecta {

/// How the pressure of the air on a surface follows from the jet there: density times the square of the
/// normal velocity times a coefficient. Fitted to 40 resolved gains of seven single bodies of two sizes on
/// and beside the jet (tests/sorter/resolved_gains.csv, docs/theory/sorter.md), of which none is a shot of a
/// sorter.
struct AirCoefficients {
  double sharp = 0.865;                 ///< of flat faces with edges: front and back together
  double small = 10e-3, large = 20e-3;  ///< m, two sizes of round bodies; linear between, constant beyond
  double round_small = 0.677, round_large = 0.815;  ///< of round surfaces
  double front = 2.0 / 3.0;      ///< part of it on what faces the air; the rest pulls at what faces away
  double sharp_widening = 1.30;  ///< of the jet on a face: the air leaves it at its edges
  double round_spread = 1.22;    ///< the air follows a round surface, and so spreads with its radius

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

/// A particle that comes over the jets.
struct Flyer {
  const FeedParticle* particle = nullptr;
  double at = 0.0;            ///< s, when its centre is over the jets if no air blows
  double y = 0.0;             ///< m, from the middle of the belt
  std::vector<Blow> blows{};  ///< of all valves within reach
};

/// Place and motion of a body in flight: m from the nozzle, m/s, rad/s.
struct BodyState {
  Vec3 position{0, 0, 0}, velocity{0, 0, 0}, spin{0, 0, 0};
  Quat orientation = Quat::Identity();
  void drift(double dt);
  BodyState after(double dt, const Vec3& gravity) const;  ///< in free flight
};

/// Where a body flies: free before and after a time in which it is pushed.
struct Track {
  static constexpr double kStep = 4e-4;  ///< s
  Vec3 gravity{0, 0, 0};                 ///< m/s2
  double from = 0.0;                     ///< s, of the first state, in the time of `Flyer::at`
  std::vector<BodyState> states{};       ///< every kStep while it is pushed
  BodyState end{};                       ///< kStep after the last
  double passes = 0.0;  ///< s, when its centre passes the plate's edge; where it never does, the end

  double until() const { return from + kStep * static_cast<double>(states.size()); }
  BodyState at(double time) const;
};

/// Where a body was after the air left it, and how it passed the plate.
struct FlightEnd {
  double gain = 0.0;        ///< m/s, of vertical velocity by the air
  double clearance = 0.0;   ///< m, of the centre above the plate's edge
  double y = 0.0;           ///< m, at the plate
  bool touched = false;     ///< by the air, or by another body
  bool in_company = false;  ///< it flew with others that came near it
  bool met = false;         ///< it touched one of them
  bool in_another = false;  ///< as it comes: it flies as if alone
  Track track{};
  bool ejected() const { return clearance > 0.0; }
};

/// The fast tier: one body through the jets of all valves near it, by the pressure on its surface.
class FastFlight {
 public:
  FastFlight(const Case& c, const JetField& field, const AirCoefficients& coefficients = {});

  /// Where there is no blow in reach: the free flight.
  FlightEnd fly(const Flyer& flyer) const;

  /// m: blows farther across than this from its centre do not reach it.
  double reach(const FeedParticle& particle) const;

  /// A body before the air moves it: when that may begin and when it is over.
  struct Begin {
    std::vector<Blow> blows;  ///< that it may meet
    double from = 0.0, until = 0.0;
    double widening = 1.0;  ///< of the jets, on that body
  };
  Begin begin(const Flyer& flyer) const;
  BodyState free_state(const Flyer& flyer, double time) const;
  /// True where the body has flown out of the jets.
  bool is_past(const Flyer& flyer, const BodyState& s) const;
  /// Whether something stands between the orifice `blow` and the point `at`, m.
  using Hidden = std::function<bool(const Blow& blow, const Vec3& at)>;
  Load load(const FeedParticle& p, const BodyState& s, const Begin& begin, double time,
            const Hidden& hidden = {}) const;
  /// The free flight to the plate of a body whose track holds points and end.
  FlightEnd finish(Track track, double gain) const;
  /// Of a body that passes the plate's edge between two places, without its track.
  FlightEnd pass(const Vec3& before, const Vec3& after, double gain) const;
  /// s, that a body in free flight needs to the plate's edge; 0 behind it, never (1e300) where it flies back.
  double time_to_edge(const BodyState& s) const;

  Vec3 gravity() const { return {0, 0, gravity_}; }
  double edge() const { return edge_x_; }  ///< m, along the motion

 private:
  bool may_meet(const Flyer& flyer, const Blow& blow) const;
  double widening(const FeedParticle& p) const;

  const JetField& field_;
  AirCoefficients coefficients_;
  LaunchSpec launch_;
  double gravity_, height_, edge_x_, edge_z_;
};

}  // namespace ejecta
