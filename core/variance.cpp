// SPDX-License-Identifier: Apache-2.0
// Tests of equal variances for two groups. Eqs. (4)-(8).
#include "core/variance.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include <boost/math/distributions/fisher_f.hpp>

#include "core/moments.hpp"

namespace kidnapwatch::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Asked of the values: the variance of equal ones may be 1e-34 where their mean was rounded.
bool varies(std::span<const double> sample) {
  return std::ranges::any_of(sample, [&](double value) { return value != sample.front(); });
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (values.size() % 2 == 1) {
    return *middle;
  }
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double centre(VarianceTest test, std::span<const double> sample) {
  return test == VarianceTest::levene ? moments(sample).mean
                                      : median({sample.begin(), sample.end()});
}

/// Z_ij = |Y_ij - centre of group i|. Eq. (8).
std::vector<double> deviations(VarianceTest test, std::span<const double> sample) {
  const double middle = centre(test, sample);
  std::vector<double> z(sample.size());
  std::ranges::transform(sample, z.begin(), [&](double value) { return std::abs(value - middle); });
  return z;
}

/// Eq. (7) for k = 2: a one-way analysis of variance of the deviations.
double levene(VarianceTest test, std::span<const double> a, std::span<const double> b) {
  const auto n_a = static_cast<double>(a.size());
  const auto n_b = static_cast<double>(b.size());
  const Moments z_a = moments(deviations(test, a));
  const Moments z_b = moments(deviations(test, b));
  const double grand = (n_a * z_a.mean + n_b * z_b.mean) / (n_a + n_b);
  const double between =
      n_a * (z_a.mean - grand) * (z_a.mean - grand) + n_b * (z_b.mean - grand) * (z_b.mean - grand);
  const double within = (n_a - 1.0) * z_a.variance + (n_b - 1.0) * z_b.variance;
  if (within == 0.0) {  // all values of a group are equally far from its centre
    return between == 0.0 ? 0.0 : kInfinity;
  }
  return (n_a + n_b - 2.0) * between / within;
}

}  // namespace

double bartlett_statistic(const Moments& a, std::size_t n_a, const Moments& b, std::size_t n_b) {
  if (a.variance == 0.0 || b.variance == 0.0) {
    return a.variance == b.variance ? 0.0 : kInfinity;
  }
  const double dof_a = static_cast<double>(n_a) - 1.0;
  const double dof_b = static_cast<double>(n_b) - 1.0;
  const double dof = dof_a + dof_b;
  const double pooled = (dof_a * a.variance + dof_b * b.variance) / dof;          // Eq. (5)
  const double correction = 1.0 + (1.0 / dof_a + 1.0 / dof_b - 1.0 / dof) / 3.0;  // Eq. (6)
  const double statistic =
      (dof * std::log(pooled) - dof_a * std::log(a.variance) - dof_b * std::log(b.variance)) /
      correction;
  return std::max(0.0, statistic);  // Eq. (4); rounding may leave -1e-13
}

double variance_statistic(VarianceTest test, std::span<const double> a, std::span<const double> b) {
  assert(a.size() >= 2 && b.size() >= 2);
  if (!varies(a) || !varies(b)) {
    return varies(a) == varies(b) ? 0.0 : kInfinity;
  }
  return test == VarianceTest::bartlett
             ? bartlett_statistic(moments(a), a.size(), moments(b), b.size())
             : levene(test, a, b);
}

double critical_value(double significance, std::size_t samples) {
  assert(significance > 0.0 && significance < 1.0 && samples > 2);
  const boost::math::fisher_f distribution(1.0, static_cast<double>(samples) - 2.0);
  return boost::math::quantile(boost::math::complement(distribution, significance));
}

double CriticalValues::at(double significance, std::size_t samples) {
  if (significance != significance_) {
    significance_ = significance;
    values_.clear();
  }
  if (values_.size() <= samples) {
    values_.resize(samples + 1, 0.0);
  }
  if (values_[samples] == 0.0) {
    values_[samples] = critical_value(significance, samples);
  }
  return values_[samples];
}

}  // namespace kidnapwatch::core
