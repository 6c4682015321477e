#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <span>
#include <vector>

#include "study/raster.hpp"

namespace ejecta {

/// A rectangle of the plane around the jet's axis, m.
struct Window {
  double x_low = 0.0, x_high = 0.0, y_low = 0.0, y_high = 0.0;
  double width() const { return x_high - x_low; }
  double depth() const { return y_high - y_low; }
};

enum class Fidelity { fine, coarse };

/// One run of a map.
struct MapRun {
  Point2 at;            ///< m
  double margin = 0.0;  ///< m, signed clearance: positive where the particle is ejected
  Fidelity fidelity = Fidelity::fine;
};

/// What a Gaussian process assumes of the margin.
struct ProcessParameters {
  double length_x = 1.0, length_y = 1.0;  ///< correlation lengths, shares of the window
  double noise = 0.0;                     ///< variance of the noise over that of the process
  double scale = 1.0;                     ///< fine = scale * coarse + discrepancy
  double discrepancy = 0.0;               ///< variance of the discrepancy over that of the coarse process
  bool noise_of_place = false;            ///< runs at one place, coarse and fine, share their noise
  bool kinked = false;                    ///< Matern 3/2 (kinks) instead of 5/2 (smooth)
  double above = 1.0, below = 1.0;        ///< m: margins beyond this hardly count, above and below zero
};

/// Places for which a process is asked, in shares of the window.
struct Places {
  Eigen::ArrayXd x, y;
  Eigen::ArrayXd fine;  ///< 1: the fine margin is meant, 0: the coarse one
  Eigen::Index size() const { return x.size(); }
};

/// Covariance of two places over the variance of the coarse process: Matern's function of the distance in
/// correlation lengths (Rasmussen & Williams 2006, eq. 4.17), with `mirrored` of a process that is even in y.
/// The fine process is `scale` times the coarse one plus an independent one of the same lengths (Kennedy &
/// O'Hagan 2000).
class Covariance {
 public:
  Covariance(const ProcessParameters& parameters, bool mirrored) : p_(parameters), mirrored_(mirrored) {}
  Eigen::MatrixXd between(const Places& a, const Places& b) const;
  /// Of each place with itself.
  Eigen::ArrayXd variance(const Places& a) const;
  const ProcessParameters& parameters() const { return p_; }

 private:
  Eigen::ArrayXd matern(const Eigen::ArrayXd& dx, const Eigen::ArrayXd& dy) const;
  Eigen::ArrayXd evenness(const Eigen::ArrayXd& y) const;
  ProcessParameters p_;
  bool mirrored_;
};

/// A process conditioned on the margins that runs gave. It works on clipped margins, because a margin
/// saturates far from the boundary; how they are clipped belongs to the parameters (a warped process, Snelson
/// et al. 2004).
class ConditionedProcess {
 public:
  ConditionedProcess(const ProcessParameters& parameters, bool mirrored, const Places& places,
                     const Eigen::VectorXd& margins);

  /// Logarithm of the probability density of the margins, up to a constant, with the variance of the process
  /// integrated out under Jeffreys' prior.
  double log_evidence() const { return log_evidence_; }
  double variance() const { return variance_; }  ///< of the process; values are clipped margins, -1 to 1
  double noise() const { return variance_ * covariance_.parameters().noise; }  ///< variance

  struct Field {
    Eigen::VectorXd mean, variance;
    Eigen::MatrixXd whitened;  ///< what covariances between the places lose by the runs: its Gram matrix
  };
  Field at(const Places& places) const;
  const Covariance& covariance() const { return covariance_; }
  /// Of each run, what the others say of its value: mean over deviation, noise included.
  Eigen::ArrayXd left_out() const;

 private:
  Covariance covariance_;
  Places places_;
  Eigen::VectorXd values_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd weights_;
  double variance_ = 0.0, log_evidence_ = 0.0;
};

/// The processes that explain the runs, each as often as its evidence weighs: there are too few runs to rely
/// on the best one alone. Points of a lattice in the box of all parameters are weighted, and the next lattice
/// fills the box around what weighs.
struct Explanation {
  double usual = 1.0;           ///< size of an ordinary margin, m
  bool mirrored = false;        ///< the margin is even in y
  bool two = false;             ///< fidelities are told apart
  bool noise_of_place = false;  ///< ProcessParameters
};
std::vector<ConditionedProcess> explain_runs(const Places& places, const Eigen::VectorXd& margins,
                                             const Explanation& kind, int count);

}  // namespace ejecta
