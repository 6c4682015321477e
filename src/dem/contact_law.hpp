#pragma once
#include <cmath>
#include <numbers>

#include "case/case.hpp"
#include "dem/lanes.hpp"

/// Contact laws: pure functions of one contact (or of eight, T = Lanes). They never ask what touches what. A
/// law is a struct with its normal spring, the ratio of its dashpots and how long a contact lasts; with_law()
/// knows them all.
namespace ejecta {

/// Constants of a pair of materials.
template <class T>
struct PairConstants {
  T youngs{};     ///< Pa, E* = 1/((1-nu_a^2)/E_a + (1-nu_b^2)/E_b)
  T shear{};      ///< Pa, G* = 1/((2-nu_a)/G_a + (2-nu_b)/G_b)
  T stiffness{};  ///< N/m, linear law
  T damping{};    ///< dimensionless, gamma of contact_damping.hpp
  T drag{};       ///< sqrt(tangential / normal stiffness): tangential dashpot over normal one
  T friction{};   ///< Coulomb
  T rolling{};    ///< rolling friction: moment / (radius * normal force)
};

/// What the narrow phase and the bodies say of a contact of a with b.
template <class T>
struct Contact {
  Triple<T> normal;    ///< unit, from b to a
  T overlap{};         ///< m, > 0
  T radius{};          ///< m, 1/(1/r_a + 1/r_b)
  T mass{};            ///< kg, 1/(1/m_a + 1/m_b)
  Triple<T> velocity;  ///< m/s, of a relative to b at the contact point
  T share{T{} + 1.0};  ///< of the energy that all contacts of the two bodies store against this motion
};

template <class T>
struct ContactForce {
  Triple<T> force;           ///< N, on a
  T normal{};                ///< N, its normal part, >= 0 unless tension is allowed
  T spring{};                ///< N, the normal spring alone
  T tangential_stiffness{};  ///< N/m
  T dashpot{}, drag{};       ///< N s/m, normal and tangential
  T stiffening{};            ///< d ln tangential_stiffness / d ln overlap
  T elastic_normal{};        ///< J, stored in the normal spring
  T elastic_tangential{};    ///< J
};

/// Normal spring, as stiffnesses at this overlap. Force = secant * overlap.
template <class T>
struct NormalSpring {
  T secant{}, tangential{}, energy{};  ///< N/m, N/m, J
  T sharpness{};                       ///< force^2/(2 energy secant)
  T stiffening{};                      ///< d ln tangential / d ln overlap
};

/// Hertz 1882: F = 4/3 E* sqrt(R) d^1.5; Mindlin 1949: tangential stiffness 8 G* sqrt(R d). Johnson 1985,
/// Contact Mechanics, eqs 4.23 and 7.43.
struct HertzMindlin {
  template <class T>
  EJECTA_INLINE static NormalSpring<T> spring(const Contact<T>& c, const PairConstants<T>& p) {
    const T a = root(c.radius * c.overlap);
    NormalSpring<T> s;
    s.secant = (4.0 / 3.0) * p.youngs * a;
    s.tangential = 8.0 * p.shear * a;
    s.energy = 0.4 * s.secant * c.overlap * c.overlap;
    s.sharpness = T{} + 1.25;
    s.stiffening = T{} + 0.5;
    return s;
  }
  /// sqrt(tangential / tangent normal stiffness), 8 G* a over 2 E* a.
  static double drag(const PairConstants<double>& p) { return std::sqrt(4.0 * p.shear / p.youngs); }
  /// s, of an impact at `velocity` (m/s), reduced mass (kg) and radius (m): 2.9432 d/v with the deepest dent
  /// d = (15 m v^2 / (16 E* sqrt(R)))^(2/5) (Timoshenko & Goodier 1970, 142).
  static double contact_time(double mass, double radius, const PairConstants<double>& p, double velocity) {
    const double depth = std::pow(15 * mass * velocity * velocity / (16 * p.youngs * std::sqrt(radius)), 0.4);
    return 2.9432 * depth / velocity;
  }
  static constexpr bool kIsElastic = true;  ///< its stiffness is that of the materials
};

/// Cundall & Strack 1979, Geotechnique 29:47: F = k d, tangential stiffness 2/7 k (equal periods of a
/// sphere's normal and tangential motion; Schaefer, Dippel & Wolf 1996).
struct LinearSpring {
  template <class T>
  EJECTA_INLINE static NormalSpring<T> spring(const Contact<T>& c, const PairConstants<T>& p) {
    NormalSpring<T> s;
    s.secant = p.stiffness;
    s.tangential = (2.0 / 7.0) * p.stiffness;
    s.energy = 0.5 * p.stiffness * c.overlap * c.overlap;
    s.sharpness = T{} + 1.0;
    return s;
  }
  static double drag(const PairConstants<double>&) { return std::sqrt(2.0 / 7.0); }
  static double contact_time(double mass, double, const PairConstants<double>& p, double) {
    return std::numbers::pi * std::sqrt(mass / p.stiffness);
  }
  static constexpr bool kIsElastic = false;
};

/// f(law) with the law that a case asks for.
template <class F>
decltype(auto) with_law(ContactLaw law, const F& f) {
  if (law == ContactLaw::linear) return f(LinearSpring{});
  return f(HertzMindlin{});
}

/// Dashpot gamma F sqrt(m/(2 E)) of a spring of force F and energy E: with u = sqrt(2 E) as coordinate the
/// motion is that of a linear oscillator whatever the law, so that gamma alone sets the restitution
/// (contact_damping.hpp; Hertz's law gives that of Antypov & Elliott 2011, EPL 94:50004). Several contacts of
/// two bodies are one such spring: of their common energy each holds a share.
template <class T>
EJECTA_INLINE T dashpot_of(const NormalSpring<T>& s, const Contact<T>& c, const PairConstants<T>& p) {
  return p.damping * root(c.mass * c.share * s.sharpness * s.secant);
}

/// Force of a contact with friction: a spring and a dashpot side by side, behind them a slider that gives way
/// at Coulomb's limit. `slip` is the history: the stretch of the spring (m), turned into the tangent plane,
/// lengthened by the motion over dt less what the slider gives, which leaves spring and dashpot the limit.
/// The tangential dashpot is the normal one times sqrt(tangential / tangent stiffness), as for two
/// oscillators of equal damping ratio (Tsuji, Tanaka & Ishida 1992, Powder Technol. 71:239).
template <class T>
EJECTA_INLINE ContactForce<T> contact_force(const NormalSpring<T>& s, const Contact<T>& c,
                                            const PairConstants<T>& p, bool allow_tension, double dt,
                                            Triple<T>& slip) {
  const T dashpot = dashpot_of(s, c, p);
  const T approach = dot(c.velocity, c.normal);  // > 0: parting
  slip = slip - dot(slip, c.normal) * c.normal;
  const T spring = s.secant * c.overlap;
  T normal = spring - dashpot * approach;
  if (!allow_tension) normal = larger(normal, T{});

  const Triple<T> sliding = c.velocity - approach * c.normal;
  slip = slip + (T{} + dt) * sliding;
  const T drag = dashpot * p.drag, damped = dt * s.tangential + drag;
  Triple<T> tangential = (T{} - s.tangential) * slip - drag * sliding;
  const T size = root(dot(tangential, tangential));
  const T limit = p.friction * larger(normal, T{});
  // Divisions take longest: one for the cut and for what the slider gives.
  const T both = (T{} + 1.0) / (size * damped);
  const T cut = size > limit ? limit * damped * both : T{} + 1.0;
  const Triple<T> given = ((size - limit) * dt * both) * tangential;
  slip = {size > limit ? slip.x + given.x : slip.x, size > limit ? slip.y + given.y : slip.y,
          size > limit ? slip.z + given.z : slip.z};
  tangential = cut * tangential;

  ContactForce<T> f;
  f.force = normal * c.normal + tangential;
  f.normal = normal;
  f.tangential_stiffness = s.tangential;
  f.dashpot = dashpot;
  f.drag = drag;
  f.stiffening = s.stiffening;
  f.spring = spring;
  f.elastic_normal = s.energy;
  f.elastic_tangential = 0.5 * s.tangential * dot(slip, slip);
  return f;
}

template <class Law, class T>
EJECTA_INLINE ContactForce<T> contact_force(const Contact<T>& c, const PairConstants<T>& p,
                                            bool allow_tension, double dt, Triple<T>& slip) {
  return contact_force(Law::spring(c, p), c, p, allow_tension, dt, slip);
}

/// Elastic-plastic rolling resistance (Iwashita & Oda 1998; type C of Ai et al. 2011, Powder Technol.
/// 206:269): a spring against relative rolling, k = k_t R^2, cut at mu_r R F_n. `roll`: its angle (rad),
/// history; where a growing dent makes the spring stiffer it keeps its energy. `spin`: angular velocity of a
/// relative to b, rad/s. Returns the moment on a, N m.
template <class T>
EJECTA_INLINE Triple<T> rolling_moment(const Contact<T>& c, const PairConstants<T>& p,
                                       const ContactForce<T>& f, const Triple<T>& spin, double dt,
                                       Triple<T>& roll) {
  const T stiffness = f.tangential_stiffness * c.radius * c.radius;
  const T nearing = larger(T{} - dot(c.velocity, c.normal), T{});
  const T kept = larger(T{} + 1.0 - (0.5 * dt) * f.stiffening * nearing / c.overlap, T{});
  roll =
      kept * (roll - dot(roll, c.normal) * c.normal) + (T{} + dt) * (spin - dot(spin, c.normal) * c.normal);
  const T size = stiffness * root(dot(roll, roll));
  const T limit = p.rolling * c.radius * larger(f.normal, T{});
  const T cut = size > limit ? limit / size : T{} + 1.0;
  roll = cut * roll;
  return (T{} - stiffness) * roll;
}

/// Twist of a flat contact, history: angle (rad) of its spring, and that spring's stiffness (N m/rad).
struct Twist {
  double angle = 0.0, stiffness = 0.0;
  bool operator==(const Twist&) const = default;
};

/// Moment of a flat contact, of springs and dashpots spread evenly over a round patch of radius a. Returns
/// what acts on a, N m; `spin`: angular velocity of a relative to b, rad/s. Twisting about the normal: second
/// moment a^2/2 times tangential stiffness and drag, cut where all of the patch slides, 2/3 mu F_n a, as the
/// force is. Tilting: second moment a^2/4 times the dashpot (the spring is in the place of the contact
/// point), cut at F_n a, beyond which the load would lie outside the patch. `rocking`: what part of the
/// tilting moves the pressure in the patch.
inline Triple<double> patch_moment(double a, const Triple<double>& normal, const PairConstants<double>& p,
                                   const ContactForce<double>& f, const Triple<double>& spin, double rocking,
                                   double dt, Twist& twist) {
  const double stiffness = 0.5 * f.tangential_stiffness * a * a, drag = 0.5 * a * a * f.drag;
  if (!(stiffness > 0)) return {};
  const double pressing = larger(f.normal, 0.0), twisting = dot(spin, normal);
  const double limit = 2.0 / 3.0 * p.friction * pressing * a;
  // As rolling: a patch that grows is no reason for more energy.
  const double kept = stiffness > twist.stiffness ? root(twist.stiffness / stiffness) : 1.0;
  twist = {kept * twist.angle + dt * twisting, stiffness};
  double about_normal = -stiffness * twist.angle - drag * twisting;
  if (about_normal > limit || about_normal < -limit) {
    const double most = about_normal > 0 ? limit : -limit;
    twist.angle += dt * (about_normal - most) / (dt * stiffness + drag);
    about_normal = most;
  }
  const Triple<double> tilting = spin - twisting * normal;
  const double damping = rocking * 0.25 * a * a * f.dashpot, size = damping * root(dot(tilting, tilting));
  const double cut = size > pressing * a ? pressing * a / size : 1.0;
  return about_normal * normal + (-cut * damping) * tilting;
}

}  // namespace ejecta
