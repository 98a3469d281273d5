// SPDX-License-Identifier: Apache-2.0
// The six variants as detectors: names, and the scores of core/dissimilarity.
#include "core/dissimilarity_detector.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/core/rooms.hpp"

namespace kidnapwatch::core {
namespace {

TEST(DtwVariants, AreSixByName) {
  std::set<std::string_view> names;
  for (const auto& config : dtw_variants({})) {
    const auto detector = dissimilarity_detector(config);
    EXPECT_EQ(detector->polarity(), Polarity::hptf);
    names.insert(detector->name());
  }
  EXPECT_EQ(names, (std::set<std::string_view>{"1ddtw", "s1ddtw", "qs1ddtw", "2ddtw", "s2ddtw",
                                               "qs2ddtw"}));
}

TEST(DtwVariants, KeepTheReadingInAllElse) {
  DissimilarityConfig reading;
  reading.gate = Gate::homogeneous;
  reading.variance_test = VarianceTest::levene;
  reading.invalid = InvalidPolicy::clamp;
  for (const auto& config : dtw_variants(reading)) {
    EXPECT_EQ(config.variance_test, VarianceTest::levene);
    EXPECT_EQ(config.invalid, InvalidPolicy::clamp);
    EXPECT_NE(config.gate, Gate::paper);
  }
}

TEST(DissimilarityDetector, ScoresEachScanAgainstTheLastGoodOne) {
  const Scan first = round_room(2.0, at_s(0.0));
  const Scan second = round_room(3.0, at_s(0.4));
  Scan blind = empty_space(at_s(0.2));
  for (const auto& config : dtw_variants({})) {
    const auto detector = dissimilarity_detector(config);
    EXPECT_FALSE(detector->observe(first));
    EXPECT_FALSE(detector->observe(blind));
    EXPECT_EQ(detector->observe(second), dissimilarity(first, second, config).cost);
    EXPECT_EQ(detector->observe(first), dissimilarity(second, first, config).cost);
  }
}

}  // namespace
}  // namespace kidnapwatch::core
