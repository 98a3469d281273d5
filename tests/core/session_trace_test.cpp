// SPDX-License-Identifier: Apache-2.0
// Whatever a network does to a trace, the scores are those of the clean one.
#include <map>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/session.hpp"
#include "tests/core/rooms.hpp"
#include "tests/core/session_fixture.hpp"

namespace kidnapwatch::core {
namespace {

using Trace = std::vector<Scan>;

/// A drive with a kidnapping now and then.
Trace drive(std::mt19937_64& random) {
  std::uniform_real_distribution<double> radius_m(1.0, 9.0);
  std::normal_distribution<double> noise_m(0.0, 0.003);
  double room_m = radius_m(random);
  Trace trace;
  for (int i = 0; i < 300; ++i) {
    room_m = random() % 40 == 0 ? radius_m(random) : room_m;
    trace.push_back(round_room(room_m + noise_m(random), at_s(0.2 * i)));
  }
  return trace;
}

struct Dirty {
  Trace trace;
  std::map<Outcome, int> added;
};

/// The trace with repetitions, late scans and empty ones between its scans.
Dirty disturbed(const Trace& clean, std::mt19937_64& random) {
  Dirty dirty;
  const auto add = [&](const Scan& scan, Outcome outcome) {
    dirty.trace.push_back(scan);
    ++dirty.added[outcome];
  };
  for (std::size_t i = 0; i < clean.size(); ++i) {
    dirty.trace.push_back(clean[i]);
    for (auto times = random() % 4; times > 0; --times) {
      const std::size_t which = random() % (i + 1);
      if (which == i) {
        add(clean[i], Outcome::repeated);
      } else if (random() % 2 == 0) {
        add(clean[which], Outcome::out_of_order);
      } else {
        add(empty_space(later_by_s(clean[i].stamp, 0.05)), Outcome::not_comparable);
      }
    }
  }
  return dirty;
}

struct Result {
  std::vector<Score> scores;
  std::vector<std::optional<EpisodeChange>> changes;
  std::map<Outcome, int> refused;
};

Result result_of(const Trace& trace, std::optional<double> threshold = {}) {
  DetectionConfig config;
  config.alarm = AlarmBy::qs2ddtw;
  config.calibration.warmup_pairs = 50;
  config.threshold = threshold;
  Session session(config);
  Result result;
  for (const Scan& scan : trace) {
    const Observation observation = feed(session, scan, scan.stamp);
    EXPECT_EQ(observation.verdict.has_value(), observation.outcome == Outcome::scored);
    if (observation.verdict) {
      result.scores.push_back(observation.verdict->score);
      result.changes.push_back(observation.verdict->change);
    } else if (observation.outcome != Outcome::first) {
      ++result.refused[observation.outcome];
    }
  }
  return result;
}

TEST(SessionTrace, ScoresADisturbedTraceAsTheCleanOne) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::mt19937_64 random(seed);
    const Trace clean = drive(random);
    const Dirty dirty = disturbed(clean, random);
    const Result expected = result_of(clean);
    const Result result = result_of(dirty.trace);
    ASSERT_EQ(expected.scores.size(), clean.size() - 1);
    EXPECT_TRUE(result.scores == expected.scores) << "seed " << seed;  // to the last bit
    EXPECT_TRUE(result.changes == expected.changes) << "seed " << seed;
    EXPECT_EQ(result.refused, dirty.added) << "seed " << seed;
    EXPECT_EQ(result.refused.size(), 3U) << "seed " << seed;
  }
}

TEST(SessionTrace, ComparesEachScanWithTheOneScoredBeforeIt) {
  std::mt19937_64 random(99);
  const Trace clean = drive(random);
  const Result result = result_of(disturbed(clean, random).trace);
  Stamp before = clean.front().stamp;
  for (const Score& score : result.scores) {
    EXPECT_EQ(score.reference, before);
    EXPECT_GT(score.stamp, score.reference);
    before = score.stamp;
  }
}

TEST(SessionTrace, OpensResolvesAndOpensInTurn) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::mt19937_64 random(seed);
    bool open = false;
    int changes = 0;
    for (const auto& change : result_of(drive(random), 20.0).changes) {
      if (change) {
        EXPECT_EQ(*change != EpisodeChange::opened, open) << "seed " << seed;
        open = *change != EpisodeChange::resolved;
        ++changes;
      }
    }
    EXPECT_GT(changes, 0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace kidnapwatch::core
