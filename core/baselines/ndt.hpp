// SPDX-License-Identifier: Apache-2.0
// Normal distributions transform: registers a scan with the one before (Biber and Strasser 2003).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/cloud.hpp"
#include "core/pose.hpp"

namespace kidnapwatch::core::baselines {

struct NdtConfig {
  double cell_m = 1.0;
  std::size_t least_points = 3;      ///< in a cell, for it to count
  double least_spread_m = 0.02;      ///< a wall is never thinner; floor of a cell's deviations
  double least_eigen_share = 0.001;  ///< nor is it thinner than this share of the larger variance
  double wide_variances = 4.0;       ///< first the variances times this, for the way there; then 1
  std::size_t iterations = 30;       ///< of each of the two
};

/// What Newton's method needs of the objective at one pose.
struct NdtFit {
  double objective = 0.0;            ///< minus the sum of likelihoods; the lower the better
  std::array<double, 3> gradient{};  ///< by x, y (m) and theta (rad)
  std::array<double, 9> hessian{};   ///< of the objective, row by row
};

/// Points as normal distributions in the cells of four grids, each shifted by half a cell.
class NormalDistributions {
 public:
  /// `points` is not empty.
  NormalDistributions(const Cloud& points, const NdtConfig& config);

  /// The objective for `points` seen from `pose`, with all variances times `widening`: minus the
  /// sum over points and grids of exp(-d' S^-1 d / 2) (their eq. 3).
  [[nodiscard]] double objective(const Cloud& points, const Pose& pose, double widening) const;

  /// With its first and second derivatives (eqs. 8-12 there).
  [[nodiscard]] NdtFit fit(const Cloud& points, const Pose& pose, double widening) const;

 private:
  struct Cell {
    double x = 0.0;  // mean
    double y = 0.0;
    double xx = 0.0;  // inverse covariance
    double xy = 0.0;
    double yy = 0.0;
  };
  struct Sums;

  [[nodiscard]] long cell_at(double x, double y, std::size_t grid) const;
  template <typename Visit>
  void for_each_hit(const Cloud& points, const Pose& pose, double widening, Visit visit) const;
  void add_cell(const Sums& sums, std::size_t slot, const NdtConfig& config);

  double cell_m_;
  double west_m_ = 0.0;  // of the south-western corner of the first grid
  double south_m_ = 0.0;
  long columns_ = 0;
  long rows_ = 0;
  std::vector<int> slots_;  // per grid and cell: index into cells_, or -1
  std::vector<Cell> cells_;
};

struct NdtMatch {
  Pose T_before_now;                ///< where the scan's sensor is, seen from the reference's
  double mean_likelihood = 0.0;     ///< over points and grids, 0..1
  std::array<double, 9> hessian{};  ///< of the objective there
  bool converged = false;
};

/// Newton's method with line search from `guess`: once with wide distributions, then with them as
/// they are. `points` is not empty.
[[nodiscard]] NdtMatch match(const NormalDistributions& reference, const Cloud& points,
                             const Pose& guess, const NdtConfig& config);

}  // namespace kidnapwatch::core::baselines
