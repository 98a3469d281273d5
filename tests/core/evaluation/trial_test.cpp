// SPDX-License-Identifier: Apache-2.0
// Trials on a simulated tour: honest halves, the same plan for all, rows that add up.
#include "core/evaluation/trial.hpp"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "core/evaluation/summary.hpp"
#include "tests/core/evaluation/tour.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

const Recording& run() {
  static const Recording recording = tour(400);
  return recording;
}

constexpr TrialConfig kFew{.episodes = 4};

TrialResult tried(DetectorKind kind) {
  return trial(run(), plan(run(), kFew), kFew, subject(kind, {}));
}

TEST(Plan, IsTheSameForTheSameSeedAndWithinTheSecondHalf) {
  const Plan one = plan(run(), kFew);
  const Plan again = plan(run(), kFew);
  ASSERT_EQ(one.entries.size(), again.entries.size());
  ASSERT_GT(one.entries.size(), 60U);
  for (std::size_t i = 0; i < one.entries.size(); ++i) {
    EXPECT_EQ(one.entries[i].episode.at, again.entries[i].episode.at);
    EXPECT_GT(one.entries[i].episode.at, run().scans.size() / 2);
  }
  EXPECT_NE(plan(run(), {.episodes = 4, .seed = 2}).entries.front().episode.at,
            one.entries.front().episode.at);
}

TEST(Trial, FindsFarKidnappingsWithEveryDetector) {
  for (const DetectorKind kind : kDetectors) {
    const TrialResult result = tried(kind);
    ASSERT_TRUE(result.threshold) << name(kind);
    EXPECT_EQ(result.natural.size() + result.skipped, 200U);
    const auto& far = result.kidnaps.at("far");
    const auto found = std::ranges::count_if(far, &EpisodeResult::alarm);
    EXPECT_GE(found, 3) << name(kind);
  }
}

TEST(Trial, LearnsNothingFromTheHalfThatIsJudged) {
  Recording spoiled = run();
  for (std::size_t i = 200; i < spoiled.scans.size(); ++i)
    std::ranges::reverse(spoiled.scans[i].scan.ranges_m);
  const auto detector = DetectorKind::motion_consistency;
  EXPECT_EQ(trial(spoiled, {}, kFew, subject(detector, {})).threshold,
            trial(run(), {}, kFew, subject(detector, {})).threshold);
}

TEST(Trial, OfAConfirmingDetectorForgivesAGlitch) {
  const auto alarms = [](const TrialResult& result) {
    return std::ranges::count_if(result.confounders.at("glitch"), &EpisodeResult::alarm);
  };
  EXPECT_GT(alarms(tried(DetectorKind::qs2ddtw)), 0);
  EXPECT_EQ(alarms(tried(DetectorKind::qs2ddtw_confirmed)), 0);
  EXPECT_EQ(alarms(tried(DetectorKind::motion_consistency)), 0);
}

TEST(Rows, PoolWhatTheLogsHave) {
  const auto detector = DetectorKind::motion_consistency;
  const LogTrial trials[] = {{"one", {{detector, tried(detector)}}},
                             {"two", {{detector, tried(detector)}}}};
  std::size_t single = 0;
  for (const Row& row : rows(trials)) {
    if (row.kind != "far") continue;
    if (row.log == "pooled") {
      EXPECT_EQ(row.alarms.trials, 8U);
      EXPECT_EQ(row.alarms.hits, single);
      ASSERT_TRUE(row.roc);
      EXPECT_GT(row.roc->auc, 0.9);
      EXPECT_EQ(row.points.size(), 3U);
    } else {
      single += row.alarms.hits;
    }
  }
  EXPECT_GT(single, 0U);
}

TEST(Rows, DoNotPoolALogThatNeverWarmedUp) {
  TrialResult cold;
  cold.natural = {1.0, 2.0};
  const LogTrial trials[] = {{"short", {{DetectorKind::qs2ddtw, cold}}}};
  const auto all = rows(trials);
  EXPECT_TRUE(std::ranges::none_of(all, [](const Row& row) { return row.log == "pooled"; }));
  EXPECT_FALSE(all.empty());
}

}  // namespace
}  // namespace kidnapwatch::core::evaluation
