// SPDX-License-Identifier: Apache-2.0
// A detector under trial: scans in, one score for every pair of scans out.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "core/calibration.hpp"
#include "core/dissimilarity.hpp"
#include "core/motion_detector.hpp"

namespace kidnapwatch::core::evaluation {

/// What a detector says when a scan arrived, of the newest jump that it has decided on.
struct Reading {
  double score = 0.0;
  bool alarm = false;    ///< above its own threshold
  bool carried = false;  ///< its alarm for slow carries
  std::optional<Cause> cause;
  std::optional<Trouble> trouble;
};

/// A detector in the middle of a robot's run. Copies go on from there each on its own.
class Subject {
 public:
  virtual ~Subject() = default;
  [[nodiscard]] virtual std::unique_ptr<Subject> copy() const = 0;

  /// Takes the next scan, which passed check(). Nothing for a scan that cannot be compared.
  /// `learn`: whether the scan is natural and may be learned from.
  virtual std::optional<Reading> observe(const Scan& scan, bool learn) = 0;

  /// Its threshold by now, no lower than a fleet's; nothing while warming up.
  [[nodiscard]] virtual std::optional<double> threshold() const = 0;
  /// The same without a fleet.
  [[nodiscard]] virtual std::optional<double> own_threshold() const { return threshold(); }
};

enum class DetectorKind : std::uint8_t {
  qs2ddtw,                              ///< the paper's score of every pair, as it is
  qs2ddtw_confirmed,                    ///< and the next scan must confirm it: see Session
  motion_consistency,                   ///< with odometry, where the log has it
  motion_consistency_without_odometry,  ///< the scans alone
};
inline constexpr std::array kDetectors{DetectorKind::qs2ddtw, DetectorKind::qs2ddtw_confirmed,
                                       DetectorKind::motion_consistency,
                                       DetectorKind::motion_consistency_without_odometry};

[[nodiscard]] std::string_view name(DetectorKind kind);

struct SubjectConfig {
  DissimilarityConfig dissimilarity;
  CalibrationConfig calibration;
  MotionConfig motion;
};

/// A new detector that has seen nothing yet.
[[nodiscard]] std::unique_ptr<Subject> subject(DetectorKind kind, const SubjectConfig& config);

}  // namespace kidnapwatch::core::evaluation
