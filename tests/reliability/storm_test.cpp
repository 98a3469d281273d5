// SPDX-License-Identifier: Apache-2.0
// A fleet that comes back all at once: after a power failure, or a broker that was restarted.
#include <algorithm>
#include <array>
#include <chrono>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include <poll.h>
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

// mosquitto keeps 100 that it has not accepted yet waiting. What comes on top of them is refused in
// silence and tries again after 1, 3, 7... s, which is TCP's waiting and not the broker's work.
constexpr std::ptrdiff_t kWaiting = 90;

/// Connects, says hello, and sends one scan when it is welcome.
class Robot {
 public:
  enum class State : std::uint8_t { connecting, greeting, welcome, failed };

  Robot(std::uint16_t port, std::string id) : socket_(connecting_to(port)), id_(std::move(id)) {}

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] pollfd awaited() const {
    const bool is_busy = state_ == State::connecting || state_ == State::greeting;
    const short event = state_ == State::connecting ? POLLOUT : POLLIN;
    return {.fd = is_busy ? socket_.fd() : -1, .events = event, .revents = 0};
  }

  /// What it waited for is there.
  void go_on() {
    if (state_ == State::connecting) {
      say(connect_packet(id_), State::greeting);
    } else if (is_welcome()) {
      say(publish_packet("kidnapwatch/v1/" + id_ + "/scan", kScan), State::welcome);
    } else {
      state_ = State::failed;
    }
  }

 private:
  void say(const std::string& bytes, State then) {
    const auto sent = ::send(socket_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    state_ = sent == static_cast<ssize_t>(bytes.size()) ? then : State::failed;
  }
  [[nodiscard]] bool is_welcome() const {
    std::array<char, 4> answer{};  // CONNACK: type, 2, no session, 0 for accepted
    return ::recv(socket_.fd(), answer.data(), answer.size(), 0) == 4 && answer[3] == 0;
  }

  Socket socket_;
  std::string id_;
  State state_ = State::connecting;
};

class Storm : public Promise {
 protected:
  static void SetUpTestSuite() {  // before the broker, which inherits it
    rlimit files{};
    ::getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &files);
  }

  /// New robots, as many as the broker lets wait, and a step of those on their way.
  void go_on(int robots) {
    while (std::ssize(robots_) < robots && std::ssize(robots_) - met() < kWaiting) {
      robots_.emplace_back(stack_.broker.port(), "storm-" + std::to_string(robots_.size()));
    }
    std::vector<pollfd> awaited;
    for (const Robot& robot : robots_) awaited.push_back(robot.awaited());
    (void)::poll(awaited.data(), awaited.size(), 100);
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (awaited[i].revents != 0) robots_[i].go_on();
    }
  }
  [[nodiscard]] std::ptrdiff_t count(Robot::State state) const {
    return std::ranges::count(robots_, state, &Robot::state);
  }

  [[nodiscard]] std::ptrdiff_t met() const {
    return count(Robot::State::welcome) + count(Robot::State::failed);
  }

  std::deque<Robot> robots_;
};

TEST_F(Storm, ManyRobotsConnectAtOnceAndEachIsHeard) {
  const int robots = at_scale(500, 10'000);
  rlimit files{};
  ::getrlimit(RLIMIT_NOFILE, &files);
  if (files.rlim_cur < static_cast<rlim_t>(robots) + 100) GTEST_SKIP() << "too few open files";
  start_service();
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed_s = [&] { return Seconds(std::chrono::steady_clock::now() - begin).count(); };
  while (met() < robots && elapsed_s() < 60.0) go_on(robots);
  const double met_s = elapsed_s();
  const auto all = static_cast<std::uint64_t>(robots);
  EXPECT_TRUE(eventually([&] { return stack_.counted("first") >= all; }));
  const double heard_s = elapsed_s();
  EXPECT_EQ(stack_.counted(), all);
  EXPECT_EQ(count(Robot::State::failed), 0);
  report(std::to_string(robots) + " robots: all connected in " + std::to_string(met_s) +
         " s, all heard after " + std::to_string(heard_s) + " s, failures " +
         std::to_string(count(Robot::State::failed)));
}

}  // namespace
}  // namespace kidnapwatch::test
