// SPDX-License-Identifier: Apache-2.0
// Counting connections.
#include "api/connections.hpp"

#include <array>

#include <gtest/gtest.h>

namespace kidnapwatch::api {
namespace {

class ConnectionsTest : public ::testing::Test {
 protected:
  Place enter(int i, const std::string& peer = "peer") {
    return connections.enter(&ids.at(static_cast<std::size_t>(i)), peer, [this] { ++stopped; });
  }
  void leave(int i) { connections.leave(&ids.at(static_cast<std::size_t>(i))); }

  Connections connections{2, 2};
  std::array<int, 8> ids{};
  int stopped = 0;
};

TEST_F(ConnectionsTest, ServesThenRefusesThenCuts) {
  EXPECT_EQ(enter(0), Place::served);
  EXPECT_EQ(enter(1), Place::served);
  EXPECT_EQ(enter(2), Place::refused);
  EXPECT_EQ(enter(3), Place::refused);
  EXPECT_EQ(enter(4), Place::cut);
}

TEST_F(ConnectionsTest, ServesAgainWhenAServedOneLeaves) {
  enter(0);
  enter(1);
  enter(2);
  leave(2);  // was refused: makes no room
  EXPECT_EQ(enter(3), Place::refused);
  leave(0);
  EXPECT_EQ(enter(4), Place::served);
}

TEST_F(ConnectionsTest, IgnoresThatSomebodyLeavesWhoWasCut) {
  enter(0);
  leave(5);
  leave(5);
  EXPECT_EQ(enter(1), Place::served);
  EXPECT_EQ(enter(2), Place::refused);
}

TEST_F(ConnectionsTest, StopsAllAndCutsNewOnesOnceClosed) {
  enter(0);
  enter(1);
  enter(2);
  connections.close();
  EXPECT_EQ(stopped, 3);
  EXPECT_EQ(enter(3), Place::cut);
}

TEST(ConnectionsPerPeer, OnePeerLeavesRoomForOthers) {
  Connections connections(3, 2);
  const std::array<int, 8> ids{};
  const auto enter = [&](std::size_t i, const char* peer) {
    return connections.enter(&ids.at(i), peer, [] {});
  };
  EXPECT_EQ(enter(0, "rude"), Place::served);
  EXPECT_EQ(enter(1, "rude"), Place::served);
  EXPECT_EQ(enter(2, "rude"), Place::refused);
  EXPECT_EQ(enter(3, "calm"), Place::served);
  connections.leave(&ids.at(2));  // was refused: makes no room
  EXPECT_EQ(enter(4, "rude"), Place::refused);
  connections.leave(&ids.at(0));
  EXPECT_EQ(enter(5, "rude"), Place::served);
}

TEST(ConnectionsPerPeer, OnePeerIsNotToldForeverThatThereAreTooMany) {
  Connections connections(2, 1);
  const std::array<int, 8> ids{};
  const auto enter = [&](std::size_t i, const char* peer) {
    return connections.enter(&ids.at(i), peer, [] {});
  };
  EXPECT_EQ(enter(0, "rude"), Place::served);
  EXPECT_EQ(enter(1, "rude"), Place::refused);
  EXPECT_EQ(enter(2, "rude"), Place::cut);  // or it would take the places of the refused, too
  EXPECT_EQ(enter(3, "calm"), Place::served);
  connections.leave(&ids.at(1));
  EXPECT_EQ(enter(4, "rude"), Place::refused);
}

TEST_F(ConnectionsTest, WaitsForNobodyWhenEmpty) {
  enter(0);
  leave(0);
  connections.wait_until_empty(std::chrono::hours(1));
}

}  // namespace
}  // namespace kidnapwatch::api
