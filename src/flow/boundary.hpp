#pragma once
#include <array>
#include <functional>
#include <vector>

#include "base/real.hpp"
#include "base/vec.hpp"
#include "grid/grid.hpp"

namespace ejecta {

/// How a face of the box acts on the incompressible flow. Every boundary of the case file is one of these
/// with a state: `inflow` also serves moving walls and jets, `open` outlets, free streams and total pressure.
enum class BoundaryKind { inflow, wall, mirror, open, periodic };

/// What comes in through a boundary: velocity (m/s), turbulent kinetic energy (m2/s2) and its dissipation
/// (epsilon, m2/s3, or omega, 1/s). Open: p / rho where fluid leaves, m2/s2 gauge.
struct BoundaryState {
  std::array<Real, 3> velocity{0, 0, 0};
  Real k = 0, dissipation = 0, pressure = 0;
  bool prescribed = false;  ///< the velocity holds although the face is open (a nozzle in it)
};

struct Boundary {
  BoundaryKind kind = BoundaryKind::wall;
  std::function<BoundaryState(const Vec3& position, double time)> state;  ///< empty: at rest
  bool varies = false;                                                    ///< state depends on time
  bool total_pressure = false;  ///< open: the state's pressure is the stagnation value where fluid enters
  bool discs = false;           ///< open: states may prescribe the velocity in parts of it
};

/// The six boundaries with their states on every face cell, refreshed once a stage.
class Boundaries {
 public:
  Boundaries(const Grid& grid, std::array<Boundary, 6> faces);

  const Boundary& operator[](int face) const { return faces_[static_cast<std::size_t>(face)]; }
  BoundaryKind kind(int face) const { return faces_[static_cast<std::size_t>(face)].kind; }
  bool open() const;  ///< at least one boundary fixes the pressure
  /// Whether face cell (a, b) of an open face has a velocity of its own.
  bool prescribed(int face, int a, int b) const {
    const Plane& plane = planes_[static_cast<std::size_t>(face)];
    return faces_[static_cast<std::size_t>(face)].discs && plane.prescribed[plane.index(a, b)];
  }
  /// The same of a face of the grid; false inside the box.
  bool prescribed_on(int d, const std::array<int, 3>& face) const;
  bool discs() const;  ///< whether there may be such cells
  /// visit(d, face of the grid, its state) for all of them.
  template <class Visit>
  void for_each_prescribed(const Visit& visit) const {
    for (int face = 0; face < 6; ++face) {
      const int d = face / 2;
      if (!grid_.active(d) || !faces_[static_cast<std::size_t>(face)].discs) continue;
      const Plane& plane = planes_[static_cast<std::size_t>(face)];
      for (int b = 0; b < plane.nb; ++b)
        for (int a = 0; a < plane.na; ++a)
          if (prescribed(face, a, b)) visit(d, on_face(face, a, b), at(face, a, b));
    }
  }

  /// Evaluates the states at `time`; those that do not vary only once.
  void update(double time);

  /// State on face cell (a, b) of a face normal to d; a, b index the other two directions in the order of
  /// storage: x -> (y, z), y -> (x, z), z -> (x, y).
  BoundaryState at(int face, int a, int b) const {
    const Plane& p = planes_[static_cast<std::size_t>(face)];
    const std::size_t n = p.index(a, b);
    return {{p.velocity[0][n], p.velocity[1][n], p.velocity[2][n]},
            p.k[n],
            p.dissipation[n],
            p.pressure[n],
            p.prescribed[n] != 0};
  }

  void fill_velocity(std::array<FieldView, 3> u, const std::array<FieldView, 3>& q) const;
  /// Ghosts of p / rho: `total` is the pressure itself, otherwise an increment (zero where pressure is
  /// fixed).
  void fill_pressure(FieldView p, const std::array<FieldView, 3>& q, bool total) const;
  /// Ghosts of k and its dissipation.
  void fill_turbulence(FieldView k, FieldView dissipation, const std::array<FieldView, 3>& q) const;
  /// Ghosts by zero gradient (periodic where periodic).
  void fill_zero_gradient(FieldView f) const;
  /// Sets q on the boundary faces: states, zero on mirrors, extrapolated u_star with the pressure force of
  /// the half cell on open ones.
  void fill_face_velocity(std::array<FieldView, 3> q, const std::array<FieldView, 3>& u_star,
                          ConstFieldView p, Real dt) const;
  /// Sets q only where the boundary prescribes it (not on open or periodic ones): a correction must not move
  /// it.
  void prescribe_face_velocity(std::array<FieldView, 3> q) const;

 private:
  /// The states of one boundary, each of their values side by side in memory.
  struct Plane {
    int na = 0, nb = 0;
    std::array<std::vector<Real>, 3> velocity;
    std::vector<Real> k, dissipation, pressure;
    std::vector<char> prescribed;
    bool fresh = false;
    std::size_t index(int a, int b) const {
      return static_cast<std::size_t>(b) * static_cast<std::size_t>(na) + static_cast<std::size_t>(a);
    }
    void resize();
    void set(int a, int b, const BoundaryState& state);
  };
  /// What is needed to walk over one face.
  struct Side {
    int d, na, nb, ghosts_a, ghosts_b;
    std::ptrdiff_t first, step_a, step_b, outward;  ///< of the boundary cell (0, 0), between cells
    std::ptrdiff_t face;                            ///< from a boundary cell to the face, in a face field
    bool upper;
    std::ptrdiff_t cell(int a, int b) const { return first + a * step_a + b * step_b; }
  };
  Side side(const FieldView& f, int face) const;
  std::array<int, 3> on_face(int face, int a, int b) const;
  template <std::size_t kN, class Ghost>
  void fill_side(const std::array<FieldView, kN>& fields, const Side& s, bool periodic,
                 const Ghost& ghost) const;

  const Grid& grid_;
  std::array<Boundary, 6> faces_;
  std::array<Plane, 6> planes_;
};

}  // namespace ejecta
