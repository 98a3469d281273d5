// SPDX-License-Identifier: Apache-2.0
// `evaluate logs` as its users call it, on simulated runs in two folders.
#include "service/evaluate/logs.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>
#include <unistd.h>

#include "adapters/codecs/json.hpp"
#include "core/sim/drive.hpp"

namespace kidnapwatch::service {
namespace {

using adapters::codecs::Json;

class EvaluateLogs : public ::testing::Test {
 public:
  ~EvaluateLogs() override { std::filesystem::remove_all(directory_); }

 protected:
  EvaluateLogs() {
    std::string path = (std::filesystem::temp_directory_path() / "kidnapwatch-XXXXXX").string();
    EXPECT_NE(mkdtemp(path.data()), nullptr);
    directory_ = path;
  }

  void record(const std::string& folder, unsigned seed, int scans) const {
    constexpr std::size_t kBeams = 120;
    const core::sim::World world = core::sim::room_world();
    core::sim::Drive drive(world, {.beams = kBeams, .range_max_m = 8.0}, seed, {});
    std::filesystem::create_directories(directory_ / "logs" / folder);
    std::ofstream text(directory_ / "logs" / folder / (folder + ".scan"));
    text << "# " << folder << " 0 " << core::sim::Fan(kBeams).increment_rad << " 120 8\n";
    for (int i = 0; i < scans; ++i) {
      const core::RecordedScan recorded = drive.next(0.2);
      const core::Pose& odometry = *recorded.scan.odometry;
      text << 0.2 * i << ' ' << odometry.x_m << ' ' << odometry.y_m << ' ' << odometry.theta_rad
           << " nan nan nan";
      for (const float range_m : recorded.scan.ranges_m) text << ' ' << range_m;
      text << '\n';
    }
  }

  int evaluate(std::vector<std::string> arguments) const {
    CLI::App app;
    Command chosen;
    add_evaluate_logs(app, chosen);
    arguments.insert(arguments.begin(),
                     {"logs", directory_ / "logs", "--out", directory_ / "report", "--episodes",
                      "1", "--rehearsal-episodes", "1", "--detector", "motion_consistency"});
    std::ranges::reverse(arguments);  // as CLI11 takes them
    app.parse(arguments);
    std::ostringstream printed;
    auto* stdout_buffer = std::cout.rdbuf(printed.rdbuf());
    const int result = chosen();
    std::cout.rdbuf(stdout_buffer);
    return result;
  }

  [[nodiscard]] std::string written(const std::string& name) const {
    std::ifstream file(directory_ / "report" / name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  [[nodiscard]] Json results() const {
    return adapters::codecs::parsed(written("results.json"), "results.json");
  }

  std::filesystem::path directory_;
};

TEST_F(EvaluateLogs, ChoosesForAFolderWithoutLookingAtIt) {
  record("left", 1, 260);
  record("right", 2, 260);
  ASSERT_EQ(evaluate({"--leave-one-out"}), kOk);
  const Json before = results();
  ASSERT_EQ(before["logs"].size(), 2U);
  record("left", 3, 320);  // other data of the folder that is left out
  ASSERT_EQ(evaluate({"--leave-one-out"}), kOk);
  const Json after = results();
  EXPECT_EQ(before["logs"][0]["folder"], "left");
  EXPECT_EQ(after["logs"][0]["tuning"], before["logs"][0]["tuning"]);
  EXPECT_EQ(after["logs"][0]["fleetThreshold"], before["logs"][0]["fleetThreshold"]);
  EXPECT_NE(after["logs"][0]["scans"], before["logs"][0]["scans"]);
}

TEST_F(EvaluateLogs, WritesAPageWithFiguresAndEveryLog) {
  record("left", 1, 260);
  ASSERT_EQ(evaluate({}), kOk);
  const std::string page = written("report.html");
  for (const char* part : {"<svg", "Kidnappings found", "look alike", "as shipped", "left"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(results()["logs"][0]["tuning"], "as shipped");
}

TEST_F(EvaluateLogs, TellsOfALogThatItCannotRead) {
  record("left", 1, 260);
  std::ofstream(directory_ / "logs" / "broken.scan") << "not a log\n";
  ASSERT_EQ(evaluate({"--leave-one-out"}), kOk);
  EXPECT_TRUE(results()["logs"][0].contains("error"));
  EXPECT_NE(written("report.html").find("broken.scan"), std::string::npos);
}

}  // namespace
}  // namespace kidnapwatch::service
