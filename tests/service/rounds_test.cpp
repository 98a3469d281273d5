// SPDX-License-Identifier: Apache-2.0
// Rounds by the clock, rounds on demand, and none after the end.
#include "service/rounds.hpp"

#include <atomic>
#include <future>

#include <gtest/gtest.h>

namespace kidnapwatch::service {
namespace {

TEST(Rounds, ComeByThemselves) {
  std::atomic<int> rounds = 0;
  std::promise<void> third;
  Rounds subject(std::chrono::milliseconds(1), [&](bool asked) {
    EXPECT_FALSE(asked);
    if (++rounds == 3) third.set_value();
  });
  third.get_future().wait();
}

TEST(Rounds, ComeAtOnceWhenAskedAndNeverAfterTheStop) {
  std::promise<bool> first;
  Rounds subject(std::chrono::hours(1), [&](bool asked) { first.set_value(asked); });
  subject.ask();
  EXPECT_TRUE(first.get_future().get());
  subject.stop();
  subject.ask();  // a second round would set the promise again, and throw
}

}  // namespace
}  // namespace kidnapwatch::service
