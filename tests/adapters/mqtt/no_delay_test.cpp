// SPDX-License-Identifier: Apache-2.0
// Nagle's algorithm is turned off on the broker's connections, and on no others.
#include "adapters/mqtt/no_delay.hpp"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "tests/support/sockets.hpp"

namespace kidnapwatch::adapters::mqtt {
namespace {

bool has_no_delay(const test::Socket& socket) {
  int on = 0;
  socklen_t size = sizeof on;
  EXPECT_EQ(::getsockopt(socket.fd(), IPPROTO_TCP, TCP_NODELAY, &on, &size), 0);
  return on != 0;
}

TEST(NoDelay, IsSetForOnePeerPortOnly) {
  const test::Socket broker = test::listening(0);
  const test::Socket other = test::listening(0);
  const test::Socket to_broker = test::connected_to(test::port_of(broker));
  const test::Socket to_other = test::connected_to(test::port_of(other));
  set_no_delay(test::port_of(broker));
  EXPECT_TRUE(has_no_delay(to_broker));
  EXPECT_FALSE(has_no_delay(to_other));
}

TEST(PortOf, ReadsUrls) {
  EXPECT_EQ(port_of("mqtt://localhost:1884"), 1884);
  EXPECT_EQ(port_of("mqtt://[::1]:1885"), 1885);
  EXPECT_EQ(port_of("ws://host:8080/mqtt:1"), 8080);
}

TEST(PortOf, KnowsTheSchemesOwn) {
  EXPECT_EQ(port_of("mqtt://localhost"), 1883);
  EXPECT_EQ(port_of("tcp://[::1]"), 1883);
  EXPECT_EQ(port_of("mqtts://localhost"), 8883);
  EXPECT_EQ(port_of("ssl://localhost/"), 8883);
  EXPECT_EQ(port_of("ws://localhost/mqtt"), 80);
  EXPECT_EQ(port_of("wss://localhost"), 443);
}

}  // namespace
}  // namespace kidnapwatch::adapters::mqtt
