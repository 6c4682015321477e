#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "dem/ball_contacts.hpp"
#include "dem/body.hpp"
#include "dem/candidates.hpp"
#include "dem/domain.hpp"
#include "dem/loads.hpp"
#include "dem/materials.hpp"
#include "dem/parts.hpp"
#include "dem/solid_contacts.hpp"
#include "dem/sphere_state.hpp"
#include "dem/walls.hpp"

namespace ejecta {

/// J. Dissipated: taken by damping and friction since the start; work: done by loads, moving walls and
/// prescribed bodies.
struct DemEnergy {
  double kinetic = 0.0, potential = 0.0, elastic = 0.0, dissipated = 0.0, work = 0.0;
  /// kinetic + potential + elastic + dissipated - work: constant in exact arithmetic.
  double ledger() const { return kinetic + potential + elastic + dissipated - work; }
};

/// A contact as it is shown. World axes.
struct ContactRecord {
  int a = 0;                             ///< body
  int b = 0;                             ///< body, or -1 - n for wall n
  Vec3 point{0, 0, 0}, normal{0, 0, 1};  ///< m; unit, from b to a
  Vec3 force{0, 0, 0};                   ///< N, on a
  double overlap = 0.0;                  ///< m
};

/// The hardest contact of a body since the start.
struct ContactPeaks {
  double overlap = 0.0;  ///< m, largest (of flat contacts the mean thickness)
  double force = 0.0;    ///< N, largest sum of contact forces
  double time = 0.0;     ///< s in contact
};

/// Whether a body is there.
enum class Presence : char { waiting, here, gone };

/// Time spent in each part of a step, s.
struct DemTimes {
  double listing = 0.0;  ///< candidates
  double balls = 0.0;    ///< contacts of balls with balls and planes
  double solids = 0.0;   ///< all other contacts
  double motion = 0.0;   ///< sums of forces, integration
};

/// All bodies that move and touch, with their walls. Advances itself; knows no fluid.
class Particles {
 public:
  Particles(const Vec3& gravity, Materials materials, const ContactSpec& contact, const Domain& domain = {});

  /// Moves all bodies over dt (s) in equal sub-steps no longer than stable_dt(), which contacts that turn out
  /// stiffer than those it is made for divide further (a pebble under a rock); gravity acts, loads[i] acts
  /// on body i and is held constant (empty: none). Bodies enter and leave at its beginning. Throws
  /// DivergedError naming a body whose motion is no number.
  void advance(double dt, std::span<const Load> loads = {});
  /// The largest sub-step, s: contact.time_step or the stated fraction of the shortest contact time; less
  /// where bodies are so fast that they would step through the thinnest of them or of the walls.
  double stable_dt() const;
  double time() const { return time_; }

  std::span<const Body> bodies() const { return bodies_; }
  std::span<const Wall> walls() const { return walls_; }
  const Materials& materials() const { return materials_; }
  /// N, of all contacts of a body at the last sub-step.
  const Vec3& contact_force(int index) const { return force_[static_cast<std::size_t>(index)]; }
  const ContactPeaks& peaks(int index) const { return peaks_[static_cast<std::size_t>(index)]; }
  Presence presence(int index) const { return presence_[static_cast<std::size_t>(index)]; }
  const Domain& domain() const { return domain_; }
  std::vector<ContactRecord> contacts() const;
  std::int64_t lists() const { return lists_; }  ///< of candidates made so far
  const DemTimes& times() const { return times_; }
  DemEnergy energy() const;

  /// Returns the index of the new body.
  int add(Body body);
  void remove(int index);
  void add(Wall wall);
  /// Sets place and velocities of a body (launch).
  void place(int index, const Vec3& position, const Quat& orientation, const Vec3& velocity,
             const Vec3& angular_velocity);

  /// Throws InputError naming the pair that overlaps most, if by more than a thousandth of its size, or a
  /// body that is to enter where a wall is.
  void require_apart();
  /// A sentence for each body that has been dented deeper than a tenth of its smallest width (springs stand
  /// for small dents), and one if bodies that were due have found no place.
  std::vector<std::string> warnings() const;

  /// Everything that changes in time, contact history included: restore() continues to the same bits.
  std::vector<double> state() const;
  void restore(std::span<const double> state);

 private:
  /// The half of a kick that ends a sub-step of `kicked` s, and the half and the drift that begin the next,
  /// of `drifted` s; 0: there is none.
  void move_bodies(double kicked, double drifted, std::span<const Load> loads);
  double shortest_contact(double speed) const;
  /// Into how many a sub-step has to be divided for the contacts as they were at its beginning.
  int pieces_of(double step) const;
  void collect_solids();
  struct Work {
    double into_contacts = 0.0, from_outside = 0.0;  // W
    double driven = 0.0;                             // J, what speeds prescribed bodies up
    double asked = 0.0;                              // 1/s4, fourth power of asked_rate_
  };
  double drift_body(int index, std::span<const Load> loads, double dt, Work& work);
  void kick_body(int index, std::span<const Load> loads, double dt, Work& work);
  void release(std::size_t n);
  void pack_spheres();
  void unpack_spheres();
  void add_work(double dt);
  void find_contacts(double dt);
  bool moves(std::size_t n) const;
  void note_size(const Shape& shape);
  void cover_walls();
  void join_walls();
  void enter_and_leave();
  void enter_and_leave(int begin, int end, int& looks);
  bool inside(const Body& b) const;
  void show(std::size_t n, Presence presence);
  bool place_is_free(std::size_t n) const;
  double mechanical_energy(std::size_t n) const;
  Vec3 acceleration(std::size_t n, std::span<const Load> loads) const;
  Vec3 torque_on(std::size_t n, std::span<const Load> loads) const;
  void list_candidates(double dt);
  /// Whether there are such parts and walls.
  bool exists(const SolidPair& pair) const;
  void note_friction();
  void pass_friction_on();
  /// How deep a body lies in something.
  struct Dent {
    double overlap = 0.0;     // m; 0: nowhere by more than a thousandth of its size
    int body = 0, other = 0;  // other: body, or -1 - n for wall n
    Vec3 normal{0, 0, 1};     // the way out
    double way = 0.0;         // m, how far that is: of a corner more than its mean dent
  };
  /// `only`: of this body, if not -1.
  Dent deepest(const CandidateSearch& found, int only = -1) const;
  /// How far a polytope must move along a contact's normal to be clear of what it touches, m.
  double way_out(const SolidPair& pair, const Touch& touch) const;
  /// Near where it is, where the body of a dent would touch nothing; none: not found.
  std::optional<Vec3> clear_place(const Dent& dent) const;
  Dent deepest_in_walls(std::size_t n) const;
  void require_clear(const Dent& dent, const char* when) const;
  [[noreturn]] void throw_diverged() const;
  void require_paid_for() const;
  void note_leaps(double step);

  Vec3 gravity_;
  Materials materials_;
  ContactSpec contact_;
  Domain domain_;
  double time_ = 0.0;
  std::vector<Body> bodies_;
  std::vector<Wall> walls_;
  std::vector<WallPlane> planes_;
  std::vector<Vec3> momentum_;         // angular, world, kg m2/s
  std::vector<Vec3> force_, torque_;   // of contacts at the last sub-step
  std::vector<Vec3> velocity_, spin_;  // as the contact laws see them: extrapolated to the whole step
  std::vector<SphereState> spheres_;   // of bodies that are free spheres, in advance()
  std::vector<ContactPeaks> peaks_;
  std::vector<Presence> presence_;
  std::vector<char> fresh_;  // which bodies were put where they are since candidates were listed
  struct Launch {
    bool waiting = false;
    Vec3 velocity{0, 0, 0}, spin{0, 0, 0};
  };
  std::vector<Launch> launches_;            // of bodies that rest until they are released
  std::map<int, Eigen::Vector3i> crossed_;  // bodies that came back, and the periods they went through
  std::vector<char> changes_;               // in which blocks of bodies some may come or go
  std::vector<char> packed_;                // which bodies spheres_ holds
  std::vector<char> pushed_;                // by solids: force_ and torque_ are not zero
  std::vector<Vec3> listed_at_;             // positions for which candidates were listed
  std::vector<double> turned_;              // m, no part of a body has moved farther by its turning since
  /// The two largest of some lengths (or squares): no two bodies have come nearer by more than their sum.
  template <class T>
  struct Farthest {
    T first = 0, second = 0, sum = 0;  // the sum tells NaN
    void note(T value) {
      second = std::max(second, std::min(first, value));
      first = std::max(first, value);
      sum += value;
    }
  };
  std::vector<Farthest<double>> block_moved_;
  std::vector<Work> block_work_;
  Work power_;               // at the last sub-step
  double asked_rate_ = 0.0;  // sub-steps a second that its contacts asked for
  Parts parts_;
  CandidateSearch search_;
  mutable CandidateSearch look_;  // of single bodies
  /// What a ball's contact with a surface remembers, for when its pair turns from triangle to plane or back.
  struct Friction {
    int ball = 0, wall = 0;
    Vec3 normal{0, 0, 1};
    std::array<double, 6> history{};
    bool plane = false;
    double energy = 0.0;  // J, of a contact with a plane
    double dent = 1.0;    // of one with a triangle: of its overlap, what its energy suffices for
    int region = -1;      // the only one of the surface to which this matters
  };
  std::vector<Friction> friction_;
  BallContacts balls_;
  SolidContacts solids_;
  double skin_ = 0.0;                                          // m, candidates are pairs with gap < skin
  double smallest_ = std::numeric_limits<double>::infinity();  // m, of the bounding radii
  double thinnest_ = std::numeric_limits<double>::infinity();  // m, of bodies but balls, and of walls
  bool relist_ = true;
  std::int64_t lists_ = 0;
  DemTimes times_;
  double contact_work_ = 0.0, outer_work_ = 0.0;  // J
  double exchanged_ = 0.0;                        // J, that went into contacts and out of them
  double leap_ = 0.0;  // the farthest that a ball has come in a contact step, in diameters
};

/// Bodies, materials, walls and contact law of a case. Refuses bodies that overlap and steps that are too
/// long.
Particles make_particles(const Case& config);

}  // namespace ejecta
