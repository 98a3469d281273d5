// SPDX-License-Identifier: Apache-2.0
// A fleet that comes back all at once: after a power failure, or a broker that was restarted.
#include <array>
#include <chrono>
#include <deque>

#include <sys/resource.h>
#include <sys/socket.h>

#include "tests/reliability/mqtt_bytes.hpp"
#include "tests/reliability/promise.hpp"
#include "tests/reliability/scale.hpp"
#include "tests/support/sockets.hpp"

namespace kidnapwatch::test {
namespace {

using Seconds = std::chrono::duration<double>;

constexpr const char* kScan =
    R"({"header":{"stamp":{"sec":5,"nanosec":0}},"angle_min":0,"angle_increment":0.1,)"
    R"("range_min":0.1,"range_max":9,"ranges":[1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1]})";

class Storm : public Promise {
 protected:
  static void SetUpTestSuite() {  // before the broker, which inherits it
    rlimit files{};
    ::getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
  }
  static void say(const Socket& socket, const std::string& bytes) {
    const auto sent = ::send(socket.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    failures_ += sent == static_cast<ssize_t>(bytes.size()) ? 0 : 1;
  }
  static bool is_welcome(const Socket& socket) {
    std::array<char, 4> answer{};  // CONNACK: type, 2, no session, 0 for accepted
    return ::recv(socket.fd(), answer.data(), answer.size(), MSG_WAITALL) == 4 && answer[3] == 0;
  }

  inline static int failures_ = 0;
};

TEST_F(Storm, ManyRobotsConnectAtOnceAndEachIsHeard) {
  const int robots = at_scale(500, 10'000);
  rlimit files{};
  ::getrlimit(RLIMIT_NOFILE, &files);
  if (files.rlim_cur < static_cast<rlim_t>(robots) + 100) GTEST_SKIP() << "too few open files";
  start_service();
  const auto begin = std::chrono::steady_clock::now();
  std::deque<Socket> sockets;
  for (int i = 0; i < robots; ++i) {
    sockets.push_back(connected_to(stack_.broker.port()));
    say(sockets.back(), connect_packet("storm-" + std::to_string(i)));
  }
  for (const auto& socket : sockets) failures_ += is_welcome(socket) ? 0 : 1;
  const Seconds connected = std::chrono::steady_clock::now() - begin;
  for (int i = 0; i < robots; ++i) {
    const auto topic = "kidnapwatch/v1/storm-" + std::to_string(i) + "/scan";
    say(sockets.at(static_cast<std::size_t>(i)), publish_packet(topic, kScan));
  }
  const auto all = static_cast<std::uint64_t>(robots);
  EXPECT_TRUE(eventually([&] { return stack_.counted("first") >= all; }));
  const Seconds heard = std::chrono::steady_clock::now() - begin;
  EXPECT_EQ(stack_.counted(), all);
  EXPECT_EQ(failures_, 0);
  report(std::to_string(robots) + " robots connected in " + std::to_string(connected.count()) +
         " s, all heard after " + std::to_string(heard.count()) + " s, failures " +
         std::to_string(failures_));
}

}  // namespace
}  // namespace kidnapwatch::test
