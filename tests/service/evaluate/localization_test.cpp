// SPDX-License-Identifier: Apache-2.0
// `evaluate localization` as its users call it: a simulated run, and its map from a file or a run.
#include "service/evaluate/localization.hpp"

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
#include "core/bad_input.hpp"
#include "core/sim/drive.hpp"
#include "tests/core/baselines/floors.hpp"

namespace kidnapwatch::service {
namespace {

namespace baselines = core::baselines;
namespace sim = core::sim;

/// Standard output, for as long as this lives.
struct Captured {
  Captured() : stdout_buffer(std::cout.rdbuf(text.rdbuf())) {}
  ~Captured() { std::cout.rdbuf(stdout_buffer); }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  std::ostringstream text;
  std::streambuf* stdout_buffer;
};

class EvaluateLocalization : public ::testing::Test {
 public:
  ~EvaluateLocalization() override { std::filesystem::remove_all(directory_); }

 protected:
  EvaluateLocalization() {
    std::string path = (std::filesystem::temp_directory_path() / "kidnapwatch-XXXXXX").string();
    EXPECT_NE(mkdtemp(path.data()), nullptr);
    directory_ = path;
  }

  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name, std::ios::binary) << text;
    return (directory_ / name).string();
  }

  /// A tour of the furnished room.
  [[nodiscard]] std::string run(const std::string& name, bool with_true_poses, int scans) const {
    const sim::World world = sim::room_world();
    sim::Drive drive(world, {}, 5, {});
    std::ostringstream text;
    text << "# " << name << " 0 " << drive_increment() << " 360 3.5\n";
    for (int i = 0; i < scans; ++i) {
      const core::RecordedScan recorded = drive.next(0.2);
      const core::Pose& odometry = *recorded.scan.odometry;
      const core::Pose& truth = *recorded.true_pose;
      text << 0.2 * i << ' ' << odometry.x_m << ' ' << odometry.y_m << ' ' << odometry.theta_rad;
      if (with_true_poses) {
        text << ' ' << truth.x_m << ' ' << truth.y_m << ' ' << truth.theta_rad;
      } else {
        text << " nan nan nan";
      }
      for (const float range_m : recorded.scan.ranges_m) text << ' ' << range_m;
      text << '\n';
    }
    return file(name + ".scan", text.str());
  }

  [[nodiscard]] std::string floor() const {
    const baselines::GridMap map = baselines::floor_of(sim::room_world());
    std::string image = "P5\n" + std::to_string(map.layout.columns) + ' ' +
                        std::to_string(map.layout.rows) + "\n255\n";
    for (long row = map.layout.rows - 1; row >= 0; --row) {
      for (long column = 0; column < map.layout.columns; ++column) {
        const baselines::Cell cell = map.at(column, row);
        image += cell == baselines::Cell::occupied ? '\0'
                 : cell == baselines::Cell::free   ? '\xfe'
                                                   : '\xcd';
      }
    }
    static_cast<void>(file("floor.pgm", image));
    std::ostringstream yaml;
    yaml << "image: floor.pgm\nresolution: 0.05\norigin: [" << map.layout.origin_x_m << ", "
         << map.layout.origin_y_m << ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n";
    return file("floor.yaml", yaml.str());
  }

  /// What the command prints.
  static adapters::codecs::Json follow(std::vector<std::string> arguments) {
    CLI::App app;
    Command chosen;
    add_evaluate(app, chosen);
    arguments.insert(arguments.begin(), {"evaluate", "localization"});
    std::ranges::reverse(arguments);  // as CLI11 takes them
    app.parse(arguments);
    const Captured printed;
    EXPECT_EQ(chosen(), kOk);
    return adapters::codecs::parsed(printed.text.view(), "stdout");
  }

 private:
  static double drive_increment() { return sim::Fan(360).increment_rad; }

  std::filesystem::path directory_;
};

TEST_F(EvaluateLocalization, FollowsARunInTheMapOfAFile) {
  const auto printed = follow({run("room", true, 60), "--map", floor()});
  EXPECT_EQ(printed["run"], "room");
  EXPECT_EQ(printed["scans"], 60);
  EXPECT_LT(printed["position_error_median_m"].get<double>(), 0.1);
  EXPECT_GT(printed["max_current_weight_median"].get<double>(), 0.9);
}

TEST_F(EvaluateLocalization, MakesTheMapFromAnotherRun) {
  const auto printed =
      follow({run("room", true, 60), "--map-from", run("mapped", true, 200), "--seed", "2"});
  EXPECT_LT(printed["position_error_median_m"].get<double>(), 0.1);
}

TEST_F(EvaluateLocalization, DoesWithoutTruePoses) {
  const auto printed = follow({run("room", false, 60), "--map-from", run("mapped", false, 120),
                               "--relocalization", "global"});
  EXPECT_FALSE(printed.contains("position_error_median_m"));
  EXPECT_EQ(printed["last_pose"].size(), 3U);
}

TEST_F(EvaluateLocalization, StartsWhereItIsTold) {
  const auto printed =
      follow({run("room", true, 1), "--map", floor(), "--start", "6:3:90", "--particles", "10"});
  EXPECT_NEAR(printed["last_pose"][0].get<double>(), 6.0, 0.5);
  EXPECT_NEAR(printed["last_pose"][1].get<double>(), 3.0, 0.5);
  EXPECT_NEAR(printed["last_pose"][2].get<double>(), 90.0, 15.0);
}

TEST_F(EvaluateLocalization, RefusesWhatItCannotUse) {
  const std::string log = run("room", true, 3);
  EXPECT_THROW(follow({log}), core::BadInput);
  EXPECT_THROW(follow({log, "--map", floor(), "--map-from", log}), core::BadInput);
  EXPECT_THROW(follow({log, "--map", floor(), "--lidar", "1:2"}), core::BadInput);
  EXPECT_THROW(follow({log, "--map", log}), core::BadInput);
  EXPECT_THROW(follow({log, "--map", floor(), "--model", "sonar"}), CLI::ValidationError);
}

}  // namespace
}  // namespace kidnapwatch::service
