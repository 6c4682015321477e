#pragma once
#include <array>
#include <memory>
#include <string>

#include "base/vec.hpp"
#include "case/case.hpp"
#include "case/expression.hpp"
#include "case/path_file.hpp"

namespace ejecta {

/// How a prescribed body moves, at any time of the run (s). What it covers in a step is the integral of its
/// velocity, not velocity times step: a body that swings comes back to where it was.
class Course {
 public:
  Course(const Vec3& velocity, const Vec3& spin);
  /// Formulas in t, m/s and rad/s.
  Course(const std::array<std::string, 3>& velocity, const std::array<std::string, 3>& spin);
  /// Through all points of a table, turning about `axis` (unit); at rest before and after it.
  Course(PathTable table, const Vec3& axis);

  Vec3 velocity(double t) const;  ///< m/s
  Vec3 spin(double t) const;      ///< rad/s, world axes
  /// What is covered from t to t + dt, m.
  Vec3 way(double t, double dt) const;
  /// Turns an orientation by what the spin does from t to t + dt.
  void turn(Quat& orientation, double t, double dt) const;
  /// What is added to the place the case gives at the time 0: nothing but for a path, m and rad about its
  /// axis.
  Vec3 first_way() const;
  double first_angle() const;

  /// What a time step must cope with until a time.
  struct Pace {
    Vec3 speed{0, 0, 0};  ///< m/s, highest of the centre along each axis
    double spin = 0.0;    ///< rad/s, highest
    double change =
        0.0;  ///< 1/s, how fast velocity or spin changes, of its highest value; four a period of a swing
  };
  Pace pace(double until) const;

 private:
  /// One component: a number or a formula in t.
  struct Rate {
    Expression formula;
    double constant = 0.0;
    bool varies = false;
    double at(double t) const { return varies ? formula(0, 0, 0, t) : constant; }
    double integral(double t, double dt) const;
  };
  using Rates = std::array<Rate, 3>;
  static Rates rates(const Vec3& constant);
  static Rates rates(const std::array<std::string, 3>& formulas);
  /// Value and slope of a column of the table at a time.
  struct Point {
    double value, slope;
  };
  Point on_path(std::size_t column, double t) const;

  Rates velocity_, spin_;
  std::vector<double> time_;                          // of a path
  std::array<std::vector<double>, 4> value_, slope_;  // x, y, z, angle
  Vec3 axis_{0, 0, 1};
};

/// The course of a [[body]] entry; `directory`: where relative file names start.
std::shared_ptr<const Course> make_course(const BodySpec& spec, const std::string& directory);

}  // namespace ejecta
