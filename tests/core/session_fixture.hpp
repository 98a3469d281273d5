// SPDX-License-Identifier: Apache-2.0
// A session whose scores can be worked out by hand.
#pragma once

#include <gtest/gtest.h>

#include "core/session.hpp"
#include "tests/core/rooms.hpp"

namespace kidnapwatch::core {

/// Scores are sums of differences of ranges: 40 times that of the radii of two round rooms.
inline DetectionConfig plain_config() {
  DetectionConfig config;
  config.alarm = AlarmBy::qs2ddtw;
  config.dissimilarity = {.dimension = Dimension::ranges, .gate = Gate::never};
  config.threshold = 4.0;  // 0.1 m of radius
  config.resync_scans = 3;
  return config;
}

/// Feeds a scan to a session that shares its memory with nobody.
inline Observation feed(Session& session, Scan scan, Stamp arrival) {
  DissimilarityWorkspace workspace;
  return session.observe(scan, arrival, workspace);
}

class SessionTest : public testing::Test {
 protected:
  /// A scan of a round room that arrives as soon as it is taken.
  Observation observe(double radius_m, double t_s) {
    return feed(session_, round_room(radius_m, at_s(t_s)), at_s(t_s));
  }

  /// The verdict on a scan that is to be scored.
  Verdict judged(double radius_m, double t_s) {
    const Observation observation = observe(radius_m, t_s);
    EXPECT_EQ(observation.outcome, Outcome::scored) << name(observation.outcome);
    return observation.verdict.value_or(Verdict{});
  }

  /// Carried from a room of 2 m to one of 8 m, and confirmed at 0.4 s.
  void kidnap() {
    observe(2.0, 0.0);
    observe(8.0, 0.2);
    ASSERT_EQ(judged(8.0, 0.4).change, EpisodeChange::opened);
  }

  void calibrate_instead(std::size_t warmup_pairs) {
    DetectionConfig config = plain_config();
    config.threshold.reset();
    config.calibration.warmup_pairs = warmup_pairs;
    session_.configure(config);
  }

  Session session_{plain_config()};
};

}  // namespace kidnapwatch::core
