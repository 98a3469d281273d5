// SPDX-License-Identifier: Apache-2.0
// Stored scores judged anew: which incidents there would have been at another threshold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/incident.hpp"

namespace kidnapwatch::core::evaluation {

/// Whose threshold is tuned.
enum class TunedDetector : std::uint8_t {
  motion_consistency,  ///< MotionConfig::threshold_min
  qs2ddtw,             ///< DetectionConfig::threshold
};

[[nodiscard]] std::string_view name(TunedDetector detector);
/// The inverse of name(). Throws BadInput naming `field` for any other text.
[[nodiscard]] TunedDetector tuned_detector(std::string_view text, std::string_view field);

/// Whether the threshold of this detector decided on the incident: a carry has one of its own.
[[nodiscard]] bool decided_on(TunedDetector detector, const Incident& incident);

/// The score that the detector would have held against its threshold while nothing happened;
/// nothing where it had none, or something did.
[[nodiscard]] std::optional<double> natural_score(TunedDetector detector, const Score& score);

/// An incident that would have been: stamps of the scans after its first and its last jump.
struct WouldBe {
  Stamp first;
  Stamp last;
  double score = 0.0;  ///< the highest

  friend bool operator==(const WouldBe&, const WouldBe&) = default;
};

/// One robot's scores at another threshold. As Session confirms a jump, but for one thing that is
/// not stored: whether QS-2DDTW finds the scan after the jump unlike the one before it. So there it
/// may tell more incidents than there would be, never fewer.
class WhatIf {
 public:
  /// Alarms less than `merge_s` apart are one incident.
  WhatIf(TunedDetector detector, double threshold, double merge_s)
      : detector_(detector), threshold_(threshold), merge_s_(merge_s) {}

  /// By stamp, ascending.
  void add(const Score& score);

  /// By stamp, ascending.
  [[nodiscard]] const std::vector<WouldBe>& incidents() const { return incidents_; }
  [[nodiscard]] std::size_t scores() const { return scores_; }
  /// How long scans came at least every 5 s.
  [[nodiscard]] double observed_s() const { return observed_s_; }

 private:
  struct Seen {
    Stamp stamp;
    double cost = 0.0;
    double motion = 0.0;
    double confirmed = 0.0;
  };
  [[nodiscard]] std::optional<double> alarm(const Seen& now) const;
  void note(Stamp stamp, double score);

  TunedDetector detector_;
  double threshold_;
  double merge_s_;
  std::optional<Seen> before_;   // the pair before the last
  std::optional<Seen> suspect_;  // the last
  std::vector<WouldBe> incidents_;
  std::size_t scores_ = 0;
  double observed_s_ = 0.0;
};

/// What would be otherwise.
struct Difference {
  std::vector<Incident> kept;
  std::vector<Incident> lost;
  std::vector<WouldBe> raised;
};

/// Of one robot's incidents. One is kept where a would-be incident is no farther away than
/// `merge_s`.
[[nodiscard]] Difference difference(std::span<const Incident> incidents,
                                    std::span<const WouldBe> would_be, double merge_s);

}  // namespace kidnapwatch::core::evaluation
