// SPDX-License-Identifier: Apache-2.0
// The shape that all detectors share, so that any of them can be evaluated and compared.
#pragma once

#include <optional>
#include <string_view>

#include "core/scan.hpp"

namespace kidnapwatch::core {

/// Which way a detector's score goes when the robot is kidnapped (section 3.2).
enum class Polarity {
  hptf,  ///< up: the score is high if the kidnapping is true
  lptf,  ///< down: it is low
};

/// Watches one robot and scores each scan against what it knows of those before.
class Detector {
 public:
  Detector() = default;
  Detector(const Detector&) = delete;
  Detector& operator=(const Detector&) = delete;
  virtual ~Detector() = default;

  /// As in configurations and reports: "qs2ddtw", "ndt_qe", ...
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual Polarity polarity() const = 0;

  /// Takes the robot's next scan, with its odometry. Nothing where the detector has no opinion: on
  /// the first scan, and on those it cannot use.
  [[nodiscard]] virtual std::optional<double> observe(const Scan& scan) = 0;
};

/// The score with "up" meaning kidnapped, whatever the polarity.
[[nodiscard]] constexpr double raised(double score, Polarity polarity) {
  return polarity == Polarity::hptf ? score : -score;
}

}  // namespace kidnapwatch::core
