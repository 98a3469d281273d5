// SPDX-License-Identifier: Apache-2.0
// Kidnappings cut into runs: far ones only, repeatable, and seen by the detectors.
#include "core/study/recorded.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/evaluation/roc.hpp"
#include "core/sim/drive.hpp"
#include "core/study/systems.hpp"

namespace kidnapwatch::core::study {
namespace {

Recording toured(std::size_t scans) {
  const sim::World world = sim::corridor_world();
  sim::Drive drive(world, {}, 2, Stamp{});
  Recording recording{"tour", {}};
  for (std::size_t i = 0; i < scans; ++i) recording.scans.push_back(drive.next(1.0));
  return recording;
}

Detectors ndt() { return ndt_systems(); }

TEST(RecordedScores, HaveARowPerNaturalPairAndPerKidnapping) {
  const RecordedScores scores = recorded_scores(toured(150), ndt, {.kidnappings = 30});
  EXPECT_EQ(scores.name, "tour");
  EXPECT_EQ(scores.ids.size(), 4U);
  EXPECT_EQ(scores.natural.size(), 149U);
  EXPECT_EQ(scores.kidnapped.size(), 30U);
  for (const auto& row : scores.kidnapped) EXPECT_EQ(row.size(), 4U);
}

TEST(RecordedScores, EndWithThoseOfAFilterInTheRunsOwnMap) {
  const Recording recording = toured(100);
  RecordedScores scores = recorded_scores(recording, ndt, {.kidnappings = 20, .particles = 300});
  ASSERT_EQ(scores.ids,
            (std::vector<std::string>{"ndt_qe", "ndt_qs", "ndt_qh", "ndt_qo", "mcw", "me"}));
  EXPECT_EQ(scores.polarities.back(), Polarity::lptf);
  std::vector<double> natural;
  std::vector<double> kidnapped;
  for (const auto& row : scores.natural) natural.push_back(-row[4]);
  for (const auto& row : scores.kidnapped) kidnapped.push_back(-row[4]);
  EXPECT_GT(evaluation::roc(natural, kidnapped).auc, 0.9);  // mcw, which falls
  const RecordedScores again =
      recorded_scores(recording, ndt, {.kidnappings = 20, .particles = 300});
  EXPECT_EQ(scores.kidnapped, again.kidnapped);
}

TEST(RecordedScores, OfAFilterNeedNoOdometry) {
  Recording recording = toured(60);
  for (auto& recorded : recording.scans) recorded.scan.odometry.reset();
  const RecordedScores scores =
      recorded_scores(recording, ndt, {.kidnappings = 10, .particles = 300});
  EXPECT_EQ(scores.natural.size(), 59U);
  EXPECT_EQ(scores.kidnapped.size(), 10U);
}

TEST(RecordedScores, AreTheSameForTheSameSeed) {
  const Recording recording = toured(60);
  const RecordedConfig config{.kidnappings = 5};
  EXPECT_EQ(recorded_scores(recording, ndt, config).kidnapped,
            recorded_scores(recording, ndt, config).kidnapped);
}

TEST(RecordedScores, TellKidnappingsFromDriving) {
  const RecordedScores scores = recorded_scores(toured(150), ndt, {.kidnappings = 30});
  std::vector<double> natural;
  std::vector<double> kidnapped;
  for (const auto& row : scores.natural) natural.push_back(row[0]);
  for (const auto& row : scores.kidnapped) kidnapped.push_back(row[0]);
  EXPECT_GT(evaluation::roc(natural, kidnapped).auc, 0.9);  // Qe
}

TEST(RecordedScores, HaveNoKidnappingWhereNoPlaceIsFar) {
  const RecordedScores scores =
      recorded_scores(toured(20), ndt, {.kidnappings = 5, .least_distance_m = 100.0});
  EXPECT_TRUE(scores.kidnapped.empty());
  EXPECT_TRUE(recorded_scores({"empty", {}}, ndt).natural.empty());
}

}  // namespace
}  // namespace kidnapwatch::core::study
