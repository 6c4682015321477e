#include "dem/course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "dem/rotation.hpp"

namespace ejecta {
namespace {

/// Nodes and weights of the 15-point Kronrod rule in [-1, 1] and of the 7-point Gauss rule inside it (Kronrod
/// 1965; values of QUADPACK, Piessens et al. 1983).
constexpr double kNode[8] = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                             0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                             0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
                             0.207784955007898467600689403773245, 0.0};
constexpr double kKronrod[8] = {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr double kGauss[4] = {0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                              0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
constexpr double kExact = 1e-12;  // of the way there and back: finer than that is the noise of the formula
constexpr int kMostParts = 100;   // enough to close in on a jump

struct Integral {
  double value, error, size;  // size: of the absolute value
};

Integral kronrod(const Expression& f, double t, double dt) {
  const double half = 0.5 * dt, middle = t + half;
  Integral sum{0, 0, 0};
  double gauss = 0.0;
  for (int n = 0; n < 8; ++n)
    for (const double side : {-1.0, 1.0}) {
      if (n == 7 && side > 0) break;
      const double v = f(0, 0, 0, middle + side * half * kNode[n]);
      sum.value += kKronrod[n] * v;
      sum.size += kKronrod[n] * std::abs(v);
      if (n % 2 == 1) gauss += kGauss[n / 2] * v;
    }
  return {half * sum.value, half * std::abs(sum.value - gauss), half * sum.size};
}

/// Halves the interval where the two rules differ: exact for what is smooth, and closes in on a jump.
double integrate(const Expression& f, double t, double dt, int& parts) {
  const Integral whole = kronrod(f, t, dt);
  if (!(whole.error > kExact * whole.size) || parts >= kMostParts) return whole.value;
  parts += 2;
  const double first = integrate(f, t, 0.5 * dt, parts);
  return first + integrate(f, t + 0.5 * dt, 0.5 * dt, parts);
}

/// Slopes with which the cubics between the points are monotone wherever the points are: between equal points
/// the body rests (Fritsch & Butland 1984, SIAM J. Sci. Stat. Comput. 5:300; ends as in Moler 2004, Numerical
/// Computing with MATLAB, 3.6).
std::vector<double> monotone_slopes(const std::vector<double>& t, const std::vector<double>& v) {
  const std::size_t n = t.size();
  std::vector<double> h(n - 1), secant(n - 1), slope(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    h[i] = t[i + 1] - t[i];
    secant[i] = (v[i + 1] - v[i]) / h[i];
  }
  if (n == 2) return {secant[0], secant[0]};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (!(secant[i - 1] * secant[i] > 0)) continue;
    const double a = 2 * h[i] + h[i - 1], b = h[i] + 2 * h[i - 1];
    slope[i] = (a + b) / (a / secant[i - 1] + b / secant[i]);
  }
  const auto end = [](double h0, double h1, double s0, double s1) {
    const double d = ((2 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
    if (!(d * s0 > 0)) return 0.0;
    return s0 * s1 <= 0 && std::abs(d) > 3 * std::abs(s0) ? 3 * s0 : d;
  };
  slope[0] = end(h[0], h[1], secant[0], secant[1]);
  slope[n - 1] = end(h[n - 2], h[n - 3], secant[n - 2], secant[n - 3]);
  return slope;
}

}  // namespace

double Course::Rate::integral(double t, double dt) const {
  if (!varies) return dt * constant;
  int parts = 0;
  return integrate(formula, t, dt, parts);
}

Course::Rates Course::rates(const Vec3& constant) {
  Rates r;
  for (std::size_t d = 0; d < 3; ++d) r[d].constant = constant[static_cast<int>(d)];
  return r;
}

Course::Rates Course::rates(const std::array<std::string, 3>& formulas) {
  Rates r;
  for (std::size_t d = 0; d < 3; ++d) {
    r[d].formula = Expression(formulas[d]);
    r[d].varies = r[d].formula.uses_time();
    r[d].constant = r[d].formula(0, 0, 0, 0);
  }
  return r;
}

Course::Course(const Vec3& velocity, const Vec3& spin) : velocity_(rates(velocity)), spin_(rates(spin)) {}

Course::Course(const std::array<std::string, 3>& velocity, const std::array<std::string, 3>& spin)
    : velocity_(rates(velocity)), spin_(rates(spin)) {}

Course::Course(PathTable table, const Vec3& axis) : time_(std::move(table.time)), axis_(axis) {
  for (std::size_t column = 0; column < 4; ++column) {
    for (std::size_t n = 0; n < time_.size(); ++n)
      value_[column].push_back(column == 3 ? table.angle[n] : table.way[n][static_cast<int>(column)]);
    slope_[column] = monotone_slopes(time_, value_[column]);
  }
}

Course::Point Course::on_path(std::size_t column, double t) const {
  const std::vector<double>&v = value_[column], &s = slope_[column];
  const double blur = 1e-9 * (time_.back() - time_.front());  // the end of a run is met but for rounding
  if (t < time_.front() - blur) return {v.front(), 0.0};
  if (t > time_.back() + blur) return {v.back(), 0.0};
  const auto after = std::upper_bound(time_.begin() + 1, time_.end() - 1, t);
  const auto b = static_cast<std::size_t>(after - time_.begin()), a = b - 1;
  const double h = time_[b] - time_[a], u = (t - time_[a]) / h, rise = v[b] - v[a];
  // The cubic of Hermite, from the nearer end so that the points themselves are met to the bit.
  const double value =
      u < 0.5 ? v[a] + u * (h * s[a] +
                            u * ((3 * rise - h * (2 * s[a] + s[b])) + u * (h * (s[a] + s[b]) - 2 * rise)))
              : v[b] - (1 - u) * (h * s[b] + (1 - u) * ((3 * rise - h * (2 * s[b] + s[a])) +
                                                        (1 - u) * (h * (s[a] + s[b]) - 2 * rise)));
  const double slope =
      s[a] + u * (2 * (3 * rise / h - 2 * s[a] - s[b]) + u * 3 * (s[a] + s[b] - 2 * rise / h));
  return {value, slope};
}

Vec3 Course::velocity(double t) const {
  if (time_.empty()) return {velocity_[0].at(t), velocity_[1].at(t), velocity_[2].at(t)};
  return {on_path(0, t).slope, on_path(1, t).slope, on_path(2, t).slope};
}

Vec3 Course::spin(double t) const {
  if (time_.empty()) return {spin_[0].at(t), spin_[1].at(t), spin_[2].at(t)};
  return on_path(3, t).slope * axis_;
}

Vec3 Course::way(double t, double dt) const {
  Vec3 way;
  for (std::size_t d = 0; d < 3; ++d)
    way[static_cast<int>(d)] =
        time_.empty() ? velocity_[d].integral(t, dt) : on_path(d, t + dt).value - on_path(d, t).value;
  return way;
}

/// Magnus expansion to fourth order (Blanes et al. 2009, Phys. Rep. 470:151): exact about a fixed axis; the
/// second term is what an axis that turns adds.
void Course::turn(Quat& orientation, double t, double dt) const {
  if (!time_.empty())
    return ejecta::turn(orientation, (on_path(3, t + dt).value - on_path(3, t).value) * axis_);
  const bool varies = spin_[0].varies || spin_[1].varies || spin_[2].varies;
  const double fastest = std::max({spin(t).norm(), spin(t + 0.5 * dt).norm(), spin(t + dt).norm()});
  const int pieces =
      varies ? std::clamp(static_cast<int>(std::ceil(fastest * dt / kLargestTurn)), 1, 10000) : 1;
  const double h = dt / pieces, away = std::sqrt(3.0) / 6.0;
  for (int n = 0; n < pieces; ++n) {
    const double from = t + n * h;
    Vec3 rotation{spin_[0].integral(from, h), spin_[1].integral(from, h), spin_[2].integral(from, h)};
    if (varies)
      rotation +=
          std::sqrt(3.0) / 12.0 * h * h * spin(from + (0.5 + away) * h).cross(spin(from + (0.5 - away) * h));
    ejecta::turn(orientation, rotation);
  }
}

Vec3 Course::first_way() const {
  if (time_.empty()) return Vec3::Zero();
  return {on_path(0, 0.0).value, on_path(1, 0.0).value, on_path(2, 0.0).value};
}

double Course::first_angle() const { return time_.empty() ? 0.0 : on_path(3, 0.0).value; }

Course::Pace Course::pace(double until) const {
  constexpr int windows = 256, looks = 64;  // the change is that of the liveliest window
  Pace pace;
  double fastest = 0.0, most_change = 0.0, most_turn_change = 0.0;
  Vec3 v = velocity(0.0), w = spin(0.0);
  const auto note = [&] {
    pace.speed = pace.speed.cwiseMax(v.cwiseAbs());
    pace.spin = std::max(pace.spin, w.norm());
    fastest = std::max(fastest, v.norm());
  };
  note();
  for (int n = 0; n < windows; ++n) {
    double change = 0.0, turn_change = 0.0;
    for (int i = 1; i <= looks; ++i) {
      const double t = until * (n * looks + i) / (windows * looks);
      const Vec3 next = velocity(t), next_spin = spin(t);
      change += (next - v).norm();
      turn_change += (next_spin - w).norm();
      v = next;
      w = next_spin;
      note();
    }
    most_change = std::max(most_change, change);
    most_turn_change = std::max(most_turn_change, turn_change);
  }
  const double window = until / windows;
  if (fastest > 0) pace.change = most_change / (fastest * window);
  if (pace.spin > 0) pace.change = std::max(pace.change, most_turn_change / (pace.spin * window));
  return pace;
}

std::shared_ptr<const Course> make_course(const BodySpec& spec, const std::string& directory) {
  if (!spec.path.empty()) {
    const std::string file = (std::filesystem::path(directory) / spec.path).string();
    std::vector<Problem> problems;
    PathTable table = read_path_file(file, problems);
    if (!problems.empty()) throw CaseError(problems);
    return std::make_shared<Course>(std::move(table), spec.rotation_axis.normalized());
  }
  if (!spec.velocity_formula && !spec.spin_formula) return std::make_shared<Course>(spec.velocity, spec.spin);
  const auto texts = [](const Vec3& v) {
    return std::array{fmt::format("{}", v.x()), fmt::format("{}", v.y()), fmt::format("{}", v.z())};
  };
  return std::make_shared<Course>(spec.velocity_formula.value_or(texts(spec.velocity)),
                                  spec.spin_formula.value_or(texts(spec.spin)));
}

}  // namespace ejecta
