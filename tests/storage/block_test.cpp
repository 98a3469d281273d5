// SPDX-License-Identifier: Apache-2.0
// Packed scores: what goes in comes out, whatever it is; broken bytes are told apart.
#include "storage/block.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "storage/sqlite.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

using core::RobotState;
using core::Score;
using std::chrono::hours;
using std::chrono::nanoseconds;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A minute at 5 Hz of a robot that drives about.
std::vector<Score> drive(std::mt19937& random, std::size_t size = 300) {
  std::lognormal_distribution cost(2.0, 0.6);
  std::uniform_int_distribution beams(600, 720);
  std::normal_distribution jitter_ms(0.0, 1.0);
  std::vector<Score> scores;
  auto stamp = at_s(0);
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t part = i / 50;
    Score score{.stamp = stamp + nanoseconds(200'000'000 + std::llround(jitter_ms(random)) * 1000),
                .reference = stamp,
                .threshold = part == 0 ? std::nullopt
                                       : std::optional(20.0 + 0.1 * static_cast<double>(part)),
                .state = RobotState::normal};
    score.dissimilarity.cost = cost(random);
    score.dissimilarity.cost_per_beam = score.dissimilarity.cost / beams(random);
    scores.push_back(as_stored(score));
    stamp = score.stamp;
  }
  return scores;
}

/// Of each detector, perhaps.
std::vector<core::DetectorScore> some_others(std::mt19937_64& random) {
  std::vector<core::DetectorScore> others;
  for (const auto name : core::kDetectorNames) {
    if (random() % 4 != 0) continue;
    others.push_back({core::detector_id(name, ""), static_cast<float>(random() % 1000) * 0.37F});
  }
  return others;
}

std::optional<core::MotionScore> some_motion(std::mt19937_64& random) {
  const auto coin = [&] { return random() % 2 == 0; };
  const auto real = [&] { return static_cast<double>(random() % 4000) * 0.013 - 8.0; };
  if (coin()) return std::nullopt;
  return core::MotionScore{.score = real(),
                           .confirmed = coin() ? std::optional(real()) : std::nullopt,
                           .threshold = coin() ? std::optional(real()) : std::nullopt,
                           .carry = real()};
}

/// Any score at all, with little in common with those before it.
Score anything(std::mt19937_64& random) {
  const auto coin = [&] { return random() % 2 == 0; };
  const auto real = [&] {
    constexpr std::array kOdd{0.0, -0.0, kInf, -kInf, 1e300, 5e-324, -1.5, 1e-40};
    return coin() ? kOdd.at(random() % kOdd.size()) : std::bit_cast<double>(random() >> 2);
  };
  return as_stored(
      {.stamp = core::stamp_from_ns(static_cast<std::int64_t>(random())),
       .reference = core::stamp_from_ns(static_cast<std::int64_t>(random())),
       .dissimilarity = {.cost = real(), .cost_per_beam = real(), .standardized = coin()},
       .threshold = coin() ? std::optional(real()) : std::nullopt,
       .motion = some_motion(random),
       .state = static_cast<RobotState>(random() % 6),
       .others = some_others(random)});
}

TEST(Block, ADriveComesBack) {
  std::mt19937 random(1);
  for (const std::size_t size : {1U, 2U, 3U, 300U, 5000U}) {
    const auto scores = drive(random, size);
    EXPECT_EQ(unpacked(packed(scores)), scores);
  }
}

TEST(Block, AnythingComesBack) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 500; ++round) {
    std::vector<Score> scores;
    for (auto i = random() % 20; i > 0; --i) scores.push_back(anything(random));
    EXPECT_EQ(unpacked(packed(scores)), scores);
  }
}

TEST(Block, NanComesBack) {
  auto score = score_at(1, kNan);
  score.threshold = kNan;
  const auto found = unpacked(packed(std::vector{as_stored(score), as_stored(score)}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(std::isnan(found[1].dissimilarity.cost));
  EXPECT_TRUE(std::isnan(found[1].dissimilarity.cost_per_beam));
  EXPECT_TRUE(std::isnan(found[1].threshold.value()));
}

TEST(Block, NothingComesBackAsNothing) { EXPECT_TRUE(unpacked(packed({})).empty()); }

TEST(Block, AScoreTakesFewBytes) {
  std::mt19937 random(3);
  const auto scores = drive(random);
  EXPECT_LT(packed(scores).size(), scores.size() * 6);  // of 64 in memory
}

TEST(AsStored, CostsKeepSixteenBits) {
  std::mt19937 random(4);
  std::lognormal_distribution cost(2.0, 3.0);
  for (int i = 0; i < 1000; ++i) {
    const auto score = score_at(i, cost(random));
    const auto stored = as_stored(score);
    const auto& d = score.dissimilarity;
    EXPECT_NEAR(stored.dissimilarity.cost, d.cost, d.cost * 0x1p-16);
    EXPECT_NEAR(stored.dissimilarity.cost_per_beam, d.cost_per_beam, d.cost_per_beam * 0x1.001p-16);
    EXPECT_EQ(as_stored(stored), stored);
  }
}

std::vector<ArrivedScore> arrived(const std::vector<double>& stamps_s) {
  std::vector<ArrivedScore> scores;
  scores.reserve(stamps_s.size());
  for (const double t : stamps_s) {
    scores.push_back({score_at(t), at_s(1000.0 + static_cast<double>(scores.size()))});
  }
  return scores;
}

TEST(Blocks, OneIsEnoughForAnHour) {
  const auto found = blocks(arrived({0, 1, 3600}));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].first, at_s(0));
  EXPECT_EQ(found[0].last, at_s(3600));
  EXPECT_EQ(found[0].arrival, at_s(1002));
  EXPECT_EQ(found[0].scores, 3U);
  EXPECT_EQ(unpacked(found[0].data).at(1), score_at(1));
}

TEST(Blocks, AClockSetBackOrAPauseStartsAnother) {
  const auto found = blocks(arrived({10, 11, 5, 6, 3607, 3608}));
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].last, at_s(11));
  EXPECT_EQ(found[1].first, at_s(5));
  EXPECT_EQ(found[1].last, at_s(6));
  EXPECT_EQ(found[1].arrival, at_s(1003));
  EXPECT_EQ(found[2].first, at_s(3607));
  EXPECT_EQ(found[2].scores, 2U);
}

TEST(Blocks, NoScoresAreNoBlocks) { EXPECT_TRUE(blocks({}).empty()); }

TEST(Block, BrokenBytesAreRefused) {
  std::mt19937 random(5);
  const auto whole = packed(drive(random, 50));
  EXPECT_THROW((void)unpacked({}), StorageError);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW((void)unpacked(std::span(whole).first(size)), StorageError) << size;
  }
  int refused = 0;
  for (int round = 0; round < 2000; ++round) {
    auto broken = whole;
    broken.at(random() % broken.size()) ^= static_cast<std::byte>(1 + random() % 255);
    try {
      (void)unpacked(broken);  // may be other scores, but must end
    } catch (const StorageError& error) {
      EXPECT_TRUE(error.is_damage());
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace kidnapwatch::storage
