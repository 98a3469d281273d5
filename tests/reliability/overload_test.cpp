// SPDX-License-Identifier: Apache-2.0
// More scans than can be judged: the oldest go, each is counted, memory stays flat.
#include <fstream>

#include <sys/socket.h>

#include "tests/reliability/mqtt_bytes.hpp"
#include "tests/reliability/promise.hpp"
#include "tests/reliability/scale.hpp"
#include "tests/support/sockets.hpp"

namespace kidnapwatch::test {
namespace {

constexpr int kScansPerWave = 2000;

class Overload : public Promise {
 protected:
  void connect() {
    line_ = connected_to(stack_.broker.port());
    say(connect_packet("flood"));
  }
  void say(const std::string& bytes) const {
    ASSERT_EQ(::send(line_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  /// The next scan of a robot, 0.2 s after its last.
  void scan(const std::string& robot, int number) {
    const std::string stamp = R"({"header":{"stamp":{"sec":)" + std::to_string(number / 5) +
                              R"(,"nanosec":)" + std::to_string(number % 5 * 200'000'000);
    say(publish_packet("kidnapwatch/v1/" + robot + "/scan", stamp + kRest));
    ++sent_;
  }
  /// As much as goes through the line at once; one more robot goes on calmly.
  void wave(int number, int robots) {
    scan("calm", number);
    for (int i = 0; i < kScansPerWave; ++i) {
      for (int robot = 0; robot < robots; ++robot) {
        scan("robot-" + std::to_string(robot), number * kScansPerWave + i);
      }
    }
    EXPECT_TRUE(eventually([&] { return stack_.counted() >= sent_; }, std::chrono::seconds(90)));
  }
  /// The most memory that the service ever had.
  [[nodiscard]] double peak_mb() const {
    std::ifstream status("/proc/" + std::to_string(stack_.service->pid()) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024.0;
    }
    return 0.0;
  }

  static inline const std::string kRest = [] {
    std::string ranges = "1";
    for (int beam = 1; beam < 180; ++beam) ranges += ",1." + std::to_string(beam);
    return R"(}},"angle_min":0,"angle_increment":0.03,"range_min":0.1,"range_max":9,"ranges":[)" +
           ranges + "]}";
  }();
  Socket line_;
  std::uint64_t sent_ = 0;
};

TEST_F(Overload, TheOldestGoEachIsCountedAndMemoryStaysFlat) {
  const int robots = at_scale(4, 20);
  const int waves = at_scale(3, 30);
  start_service();
  connect();
  wave(0, robots);
  const double first_mb = peak_mb();
  for (int i = 1; i < waves; ++i) wave(i, robots);
  const double last_mb = peak_mb();
  EXPECT_EQ(stack_.counted(), sent_);
  const auto dropped = stack_.counted("overload");
  EXPECT_GT(dropped, 0U);
  EXPECT_TRUE(degraded().contains("overload"));
  const Json calm = stack_.get("/api/v1/robots/calm").at("scans");
  EXPECT_EQ(calm.at("first").get<int>() + calm.at("scored").get<int>(), waves) << calm;
  const bool is_plain = std::string(KW_SANITIZED).empty();  // a sanitizer keeps what was freed
  if (is_plain) {
    EXPECT_LT(last_mb, first_mb + 32.0);
  }
  report(std::to_string(sent_) + " scans, " + std::to_string(dropped) +
         " dropped, each counted; memory at most " + std::to_string(first_mb) +
         " MB after the first wave, " + std::to_string(last_mb) + " MB after the last");
}

}  // namespace
}  // namespace kidnapwatch::test
