#include "case/size_distribution.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "case/csv_table.hpp"

namespace ejecta {
namespace {

constexpr int kMeanSamples = 4096;

/// The quantile of the normal distribution (Acklam's rational approximation, relative error 1.2e-9).
double normal_quantile(double p) {
  constexpr double a[] = {-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                          1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
  constexpr double b[] = {-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02,
                          6.680131188771972e+01, -1.328068155288572e+01};
  constexpr double c[] = {-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                          -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
  constexpr double d[] = {7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
                          3.754408661907416e+00};
  if (p < 0.02425) {
    const double q = std::sqrt(-2.0 * std::log(p));
    return (((((c[0] * q + c[1]) * q + c[2]) * q + c[3]) * q + c[4]) * q + c[5]) /
           ((((d[0] * q + d[1]) * q + d[2]) * q + d[3]) * q + 1.0);
  }
  if (p > 1.0 - 0.02425) return -normal_quantile(1.0 - p);
  const double q = p - 0.5, r = q * q;
  return (((((a[0] * r + a[1]) * r + a[2]) * r + a[3]) * r + a[4]) * r + a[5]) * q /
         (((((b[0] * r + b[1]) * r + b[2]) * r + b[3]) * r + b[4]) * r + 1.0);
}

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto above = std::upper_bound(x.begin(), x.end(), at);
  if (above == x.begin()) return y.front();
  if (above == x.end()) return y.back();
  const auto n = static_cast<std::size_t>(above - x.begin());
  return y[n - 1] + (at - x[n - 1]) / (x[n] - x[n - 1]) * (y[n] - y[n - 1]);
}

struct SieveAnalysis {
  std::vector<double> size, finer;  ///< m; share of the mass below it
};

SieveAnalysis read_sieves(const std::string& file) {
  std::vector<Problem> problems;
  const CsvTable table = read_csv(file,
                                  {.kind = "a sieve analysis",
                                   .columns = {{"size", Dimension::length}, {"finer", Dimension::none}},
                                   .example_head = "size [mm], finer",
                                   .example_row = "10, 0"},
                                  problems);
  for (Problem& p : problems) p.key = "sieves";
  if (!problems.empty()) throw CaseError(problems);
  SieveAnalysis a;
  for (const auto& row : table.rows) {
    a.size.push_back(row[0]);
    a.finer.push_back(row[1]);
  }
  const bool sound = a.size.size() >= 2 && a.finer.front() == 0.0 && a.finer.back() == 1.0 &&
                     a.size.front() > 0.0 && std::is_sorted(a.finer.begin(), a.finer.end());
  if (!sound)
    throw InputError(fmt::format("{}: no distribution of sizes", file),
                     {.key = "sieves",
                      .expected = "a share that is finer which ascends from 0 to 1, at sizes above 0",
                      .example = "size [mm], finer: 5, 0; 10, 0.4; 20, 1"});
  return a;
}

}  // namespace

SizeDistribution::SizeDistribution(SizeLaw law, double size, double size_to, double spread,
                                   const std::string& sieves)
    : law_(law), size_(size), size_to_(size_to), spread_(spread) {
  if (law == SizeLaw::sieves) {
    const SieveAnalysis a = read_sieves(sieves);
    tabulate(a.size, a.finer);
  } else if (law == SizeLaw::rosin_rammler) {
    // From 1 % to 99 %: the law itself has no smallest particle, and a feed has.
    SieveAnalysis a;
    for (int n = 0; n <= 200; ++n) {
      const double f = 0.01 + 0.98 * n / 200.0;
      a.size.push_back(size * std::pow(-std::log(1.0 - f), 1.0 / spread));
      a.finer.push_back(n / 200.0);
    }
    tabulate(a.size, a.finer);
  }
}

/// From shares of the mass to shares of the number.
void SizeDistribution::tabulate(const std::vector<double>& size, const std::vector<double>& finer) {
  sizes_.push_back(size.front());
  finer_.push_back(0.0);
  constexpr int kSteps = 16;  // between sieves the mass is spread evenly over the size
  for (std::size_t n = 1; n < size.size(); ++n)
    for (int k = 0; k < kSteps; ++k) {
      const double middle = size[n - 1] + (k + 0.5) / kSteps * (size[n] - size[n - 1]);
      sizes_.push_back(size[n - 1] + (k + 1.0) / kSteps * (size[n] - size[n - 1]));
      finer_.push_back(finer_.back() + (finer[n] - finer[n - 1]) / kSteps / std::pow(middle, 3));
    }
  const double all = finer_.back();
  for (double& f : finer_) f /= all;
}

double SizeDistribution::quantile(double u) const {
  switch (law_) {
    case SizeLaw::one:
      return size_;
    case SizeLaw::uniform:
      return size_ + u * (size_to_ - size_);
    case SizeLaw::lognormal:
      return size_ * std::exp(spread_ * normal_quantile(u));
    case SizeLaw::rosin_rammler:
    case SizeLaw::sieves:
      break;
  }
  return interpolate(finer_, sizes_, u);
}

double SizeDistribution::mean_power(int power) const {
  double sum = 0.0;
  for (int n = 0; n < kMeanSamples; ++n)
    sum += std::pow(quantile((n + 0.5) / kMeanSamples), power) / kMeanSamples;
  return sum;
}

}  // namespace ejecta
