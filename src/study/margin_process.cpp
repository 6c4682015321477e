#include "study/margin_process.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"

namespace ejecta {
namespace {

/// Variance of the mean of a process over that of the process: so large that the runs decide, so small that
/// matrices stay well conditioned.
constexpr double kMeanVariance = 10.0;
/// Of the sum of squares of values of order 1: runs that all gave the same leave no variance.
constexpr double kLeastSquare = 1e-12;
/// Added to the noise: keeps the factorisation from failing where points nearly coincide.
constexpr double kJitter = 1e-8;

/// A parameter's range before any run.
struct ParameterRange {
  double low, high;
};
constexpr ParameterRange kLogLength{-3.0, 0.7};       // 0.05 to 2 windows
constexpr ParameterRange kLogNoise{-14.0, -1.0};      // 1e-6 to 0.37 of the variance
constexpr ParameterRange kKinked{0.0, 1.0};           // above a half: kinked
constexpr ParameterRange kLogClip{-1.0, 1.0};         // 0.37 to 2.7 times the usual margin
constexpr ParameterRange kScale{0.5, 1.5};            // fine over coarse
constexpr ParameterRange kLogDiscrepancy{-9.0, 0.0};  // 1e-4 to 1 of the variance
constexpr int kParameters = 8, kParametersOfOneFidelity = 6;
constexpr std::array<ParameterRange, kParameters> kRanges{kLogLength, kLogLength, kLogNoise, kKinked,
                                                          kLogClip,   kLogClip,   kScale,    kLogDiscrepancy};

/// Rounds and points of the search for parameters. Twice as many points change areas by less than their
/// error.
constexpr int kRounds = 5;
constexpr std::size_t kPoints = 128;

using Vector = std::array<double, kParameters>;

ProcessParameters parameters_of(const Vector& v, const Explanation& kind) {
  ProcessParameters p;
  p.noise_of_place = kind.noise_of_place;
  p.length_x = std::exp(v[0]);
  p.length_y = std::exp(v[1]);
  p.noise = std::exp(v[2]);
  p.kinked = v[3] > 0.5;
  p.above = kind.usual * std::exp(v[4]);
  p.below = kind.usual * std::exp(v[5]);
  if (kind.two) {
    p.scale = v[6];
    p.discrepancy = std::exp(v[7]);
  }
  return p;
}

/// A smooth clip that keeps zero where it is: r/sqrt(1 + r^2) of the margin over its level on that side.
double clipped(double margin, const ProcessParameters& p) {
  const double r = margin / (margin > 0.0 ? p.above : p.below);
  return r / std::sqrt(1.0 + r * r);
}
double log_slope(double margin, const ProcessParameters& p) {
  const double level = margin > 0.0 ? p.above : p.below, r = margin / level;
  return -1.5 * std::log1p(r * r) - std::log(level);
}

/// The n-th point of a lattice that fills the unit cube of d dimensions evenly: multiples of powers of the
/// root of g^(d+1) = g + 1 (Roberts 2018).
Vector lattice_point(int n, int d) {
  double g = 1.5;
  for (int it = 0; it < 60; ++it) g = std::pow(1.0 + g, 1.0 / (d + 1));
  Vector u{};
  double a = 1.0;
  for (int k = 0; k < d; ++k) {
    a /= g;
    u[static_cast<std::size_t>(k)] = std::fmod(0.5 + a * (n + 1), 1.0);
  }
  return u;
}

}  // namespace

Eigen::ArrayXd Covariance::matern(const Eigen::ArrayXd& dx, const Eigen::ArrayXd& dy) const {
  const double order = p_.kinked ? 3.0 : 5.0;
  const Eigen::ArrayXd r = (order * ((dx / p_.length_x).square() + (dy / p_.length_y).square())).sqrt();
  if (p_.kinked) return (1.0 + r) * (-r).exp();
  return (1.0 + r + r.square() / 3.0) * (-r).exp();
}

/// f(x, y) + f(x, -y) is even, but varies twice as much on the axis: divided by this it does not.
Eigen::ArrayXd Covariance::evenness(const Eigen::ArrayXd& y) const {
  return (1.0 + matern(Eigen::ArrayXd::Zero(y.size()), 2.0 * y)).rsqrt();
}

Eigen::MatrixXd Covariance::between(const Places& a, const Places& b) const {
  Eigen::MatrixXd out(a.size(), b.size());
  const Eigen::ArrayXd even_a = mirrored_ ? evenness(a.y) : Eigen::ArrayXd();
  const Eigen::ArrayXd even_b = mirrored_ ? evenness(b.y) : Eigen::ArrayXd();
  for (Eigen::Index n = 0; n < b.size(); ++n) {
    const Eigen::ArrayXd dx = a.x - b.x[n];
    Eigen::ArrayXd shape = matern(dx, a.y - b.y[n]);
    if (mirrored_) shape = (shape + matern(dx, a.y + b.y[n])) * even_a * even_b[n];
    const double scale_b = b.fine[n] > 0.0 ? p_.scale : 1.0;
    const Eigen::ArrayXd levels =
        scale_b * (1.0 + (p_.scale - 1.0) * a.fine) + p_.discrepancy * b.fine[n] * a.fine;
    out.col(n) = ((shape + kMeanVariance) * levels).matrix();
  }
  return out;
}

Eigen::ArrayXd Covariance::variance(const Places& a) const {
  return (1.0 + kMeanVariance) * (1.0 + (p_.scale * p_.scale + p_.discrepancy - 1.0) * a.fine);
}

ConditionedProcess::ConditionedProcess(const ProcessParameters& parameters, bool mirrored,
                                       const Places& places, const Eigen::VectorXd& margins)
    : covariance_(parameters, mirrored), places_(places) {
  Eigen::MatrixXd k = covariance_.between(places, places);
  k.diagonal().array() += parameters.noise + kJitter;
  for (Eigen::Index a = 0; parameters.noise_of_place && a < places.size(); ++a)
    for (Eigen::Index b = 0; b < places.size(); ++b)
      if (a != b && places.x[a] == places.x[b] && places.y[a] == places.y[b]) k(a, b) += parameters.noise;
  factor_.compute(k);
  values_ = margins.unaryExpr([&](double m) { return clipped(m, parameters); });
  weights_ = factor_.solve(values_);
  const auto n = static_cast<double>(values_.size());
  const double square = std::max(values_.dot(weights_), kLeastSquare);
  variance_ = square / n;
  log_evidence_ = -factor_.matrixLLT().diagonal().array().log().sum() - 0.5 * n * std::log(square);
  for (const double m : margins) log_evidence_ += log_slope(m, parameters);
}

ConditionedProcess::Field ConditionedProcess::at(const Places& places) const {
  Field f;
  f.whitened = covariance_.between(places_, places);
  f.mean = f.whitened.transpose() * weights_;
  factor_.matrixL().solveInPlace(f.whitened);
  f.variance =
      variance_ * (covariance_.variance(places).matrix() - f.whitened.colwise().squaredNorm().transpose())
                      .cwiseMax(kJitter);
  return f;
}

Eigen::ArrayXd ConditionedProcess::left_out() const {
  const auto n = weights_.size();
  const Eigen::ArrayXd precision = factor_.solve(Eigen::MatrixXd::Identity(n, n)).diagonal();
  const Eigen::ArrayXd mean = values_.array() - weights_.array() / precision;
  return mean / (variance_ / precision).sqrt();
}

std::vector<ConditionedProcess> explain_runs(const Places& places, const Eigen::VectorXd& margins,
                                             const Explanation& kind, int count) {
  const int d = kind.two ? kParameters : kParametersOfOneFidelity;
  auto box = kRanges;
  std::array<Vector, kPoints> tried{};
  std::array<double, kPoints> weight{};
  for (int round = 0; round < kRounds; ++round) {
    for_each_index(static_cast<int>(kPoints), [&](int n) {
      Vector v = lattice_point(n, d);
      for (std::size_t c = 0; c < v.size(); ++c) v[c] = box[c].low + v[c] * (box[c].high - box[c].low);
      const auto at = static_cast<std::size_t>(n);
      tried[at] = v;
      weight[at] = ConditionedProcess(parameters_of(v, kind), kind.mirrored, places, margins).log_evidence();
    });
    const double best = *std::max_element(weight.begin(), weight.end());
    double sum = 0.0;
    for (double& w : weight) sum += w = std::exp(w - best);
    for (double& w : weight) w /= sum;
    if (round == kRounds - 1) break;
    for (std::size_t c = 0; c < box.size(); ++c) {  // the next lattice fills the box around what weighs
      double mean = 0.0, square = 0.0;
      for (std::size_t n = 0; n < kPoints; ++n) {
        mean += weight[n] * tried[n][c];
        square += weight[n] * tried[n][c] * tried[n][c];
      }
      const double deviation = std::sqrt(std::max(square - mean * mean, 0.0));
      const double half = std::max(2.5 * deviation, 0.2 * (box[c].high - box[c].low));
      box[c] = {std::max(box[c].low, mean - half), std::min(box[c].high, mean + half)};
    }
  }

  std::vector<ConditionedProcess> processes;
  double passed = 0.0;
  for (std::size_t n = 0; n < kPoints; ++n) {
    passed += weight[n];
    while (static_cast<int>(processes.size()) < count &&
           passed * count > static_cast<double>(processes.size()) + 0.5)
      processes.emplace_back(parameters_of(tried[n], kind), kind.mirrored, places, margins);
  }
  return processes;
}

}  // namespace ejecta
