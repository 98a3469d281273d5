// SPDX-License-Identifier: Apache-2.0
// Waits that grow, stay below their limit, and differ between clients.
#include "adapters/mqtt/backoff.hpp"

#include <set>

#include <gtest/gtest.h>

namespace kidnapwatch::adapters::mqtt {
namespace {

using namespace std::chrono_literals;

TEST(Backoff, DoublesUpToItsLimit) {
  Backoff backoff(100ms, 1000ms, 1);
  for (const auto longest : {100ms, 200ms, 400ms, 800ms, 1000ms, 1000ms}) {
    const auto wait = backoff.next();
    EXPECT_GE(wait, longest / 2);
    EXPECT_LE(wait, longest);
  }
}

TEST(Backoff, StartsAgainAfterReset) {
  Backoff backoff(100ms, 1000ms, 1);
  (void)backoff.next();
  (void)backoff.next();
  backoff.reset();
  EXPECT_LE(backoff.next(), 100ms);
}

TEST(Backoff, SpreadsClients) {
  std::set<std::chrono::milliseconds> waits;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    waits.insert(Backoff(10'000ms, 10'000ms, seed).next());
  }
  EXPECT_GT(waits.size(), 90U);
}

}  // namespace
}  // namespace kidnapwatch::adapters::mqtt
