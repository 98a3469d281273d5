// SPDX-License-Identifier: Apache-2.0
// Receiver operating characteristics, as in the paper's section 5.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kidnapwatch::core::evaluation {

/// The rates of alarming whenever a score is at least `threshold`.
struct RocPoint {
  double threshold = 0.0;
  double fpr = 0.0;  ///< share of the natural scores that alarm
  double tpr = 0.0;  ///< share of the kidnappings that do

  friend bool operator==(const RocPoint&, const RocPoint&) = default;
};

struct Roc {
  /// From (0, 0) at an infinite threshold to (1, 1), one for each different score.
  std::vector<RocPoint> points;
  double auc = 0.0;       ///< area under the curve; ties count a half
  double auc_low = 0.0;   ///< 95 % confidence interval after DeLong, DeLong, Clarke-Pearson (1988);
  double auc_high = 0.0;  ///< within 0..1, and of no width where auc is 0 or 1
  std::size_t natural = 0;
  std::size_t kidnapped = 0;
};

/// Of scores that go up when the robot is kidnapped (raised()). Neither is empty, none is NaN.
[[nodiscard]] Roc roc(std::span<const double> natural, std::span<const double> kidnapped);

/// The share of kidnappings found at the lowest threshold with no more than `fpr` false alarms. Of
/// n natural scores nothing can be said about rates below 1 / n.
[[nodiscard]] double tpr_at(const Roc& roc, double fpr);

}  // namespace kidnapwatch::core::evaluation
