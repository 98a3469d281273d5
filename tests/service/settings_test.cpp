// SPDX-License-Identifier: Apache-2.0
// Settings come from four places, in order, and say what is wrong with them.
#include "service/settings.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::service {
namespace {

class SettingsTest : public ::testing::Test {
 public:
  SettingsTest() {
    std::string name = (std::filesystem::temp_directory_path() / "settings-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    sources_.environment = [this](const std::string& name_of) -> std::optional<std::string> {
      const auto found = environment_.find(name_of);
      return found == environment_.end() ? std::nullopt : std::optional(found->second);
    };
  }
  ~SettingsTest() override { std::filesystem::remove_all(folder_); }

 protected:
  void write(const std::string& text) {
    sources_.file = folder_ / "kidnapwatch.toml";
    std::ofstream(*sources_.file) << text;
  }

  std::string complaint() {
    try {
      (void)load_settings(sources_);
    } catch (const core::BadInput& bad) {
      return bad.what();
    }
    return "none";
  }

  std::filesystem::path folder_;
  std::map<std::string, std::string> environment_;
  Sources sources_;
};

TEST_F(SettingsTest, DefaultsNeedNothing) {
  const auto loaded = load_settings(sources_);
  EXPECT_EQ(loaded.settings.http_port, 8080);
  EXPECT_EQ(loaded.origins.at("http.port"), "default");
}

TEST_F(SettingsTest, AFlagBeatsTheEnvironmentBeatsTheFile) {
  write("[http]\nport = 1001\nhost = \"0.0.0.0\"\n[mqtt]\nprefix = \"a/b\"\n");
  environment_ = {{"KIDNAPWATCH_HTTP_PORT", "1002"}, {"KIDNAPWATCH_HTTP_HOST", "::1"}};
  sources_.flags = {{"http.port", "1003"}};
  const auto loaded = load_settings(sources_);
  EXPECT_EQ(loaded.settings.http_port, 1003);
  EXPECT_EQ(loaded.settings.http_host, "::1");
  EXPECT_EQ(loaded.settings.mqtt_prefix, "a/b");
  EXPECT_EQ(loaded.origins.at("http.port"), "flag --http.port");
  EXPECT_EQ(loaded.origins.at("http.host"), "environment KIDNAPWATCH_HTTP_HOST");
  EXPECT_NE(loaded.origins.at("mqtt.prefix").find("kidnapwatch.toml:5"), std::string::npos);
}

TEST_F(SettingsTest, DetectionIsATableOfTheFile) {
  write("[detection]\nthreshold = 55.5\n[detection.calibration]\nfalse_alarm_rate = 0.002\n");
  const auto detection = load_settings(sources_).settings.detection;
  EXPECT_EQ(detection.threshold, 55.5);
  EXPECT_EQ(detection.calibration.false_alarm_rate, 0.002);
}

TEST_F(SettingsTest, NamesTheKeyThatIsWrong) {
  write("[http]\nprot = 80\n");
  EXPECT_NE(complaint().find("http.prot: is no setting"), std::string::npos) << complaint();
  write("[http]\nport = \"eighty\"\n");
  EXPECT_NE(complaint().find("http.port: must be a number"), std::string::npos) << complaint();
  write("[http]\nport = 65536\n");
  EXPECT_NE(complaint().find("http.port"), std::string::npos) << complaint();
  write("[service]\nlanes = 0\n");
  EXPECT_NE(complaint().find("service.lanes: must be from 1"), std::string::npos) << complaint();
  write("[mqtt]\nscores_per_s = 1001\n");
  EXPECT_NE(complaint().find("mqtt.scores_per_s: must be from 0"), std::string::npos);
  write("[detection]\nstale_after_s = -1\n");
  EXPECT_NE(complaint().find("detection.stale_after_s"), std::string::npos) << complaint();
  write("nonsense = 3\n");
  EXPECT_NE(complaint().find("nonsense: is no setting"), std::string::npos) << complaint();
}

TEST_F(SettingsTest, WhatIsCoarserIsKeptAtLeastAsLong) {
  write("[store]\nkeep_scores_days = 400\nkeep_minutes_days = 500\nkeep_incidents_days = 400\n");
  EXPECT_EQ(complaint(), "none");
  EXPECT_EQ(load_settings(sources_).settings.store_keep_minutes_days, 500U);
  write("[store]\nkeep_scores_days = 61\n");
  EXPECT_EQ(complaint(), "store.keep_minutes_days: must not be less than store.keep_scores_days");
  write("[store]\nkeep_hours_days = 59\n");
  EXPECT_EQ(complaint(), "store.keep_hours_days: must not be less than store.keep_minutes_days");
  write("[store]\nkeep_incidents_days = 29\n");
  EXPECT_EQ(complaint(), "store.keep_incidents_days: must not be less than store.keep_scores_days");
  write("[store]\nkeep_scores_days = 0\n");
  EXPECT_NE(complaint().find("store.keep_scores_days: must be from 1"), std::string::npos);
  write("[store]\nmax_mb = 99\n");
  EXPECT_NE(complaint().find("store.max_mb: must be from 100"), std::string::npos);
}

TEST_F(SettingsTest, NamesTheLineOfATomlError) {
  write("[http]\nport = = 3\n");
  EXPECT_NE(complaint().find("kidnapwatch.toml:2"), std::string::npos) << complaint();
}

TEST_F(SettingsTest, AMissingFileIsAnError) {
  sources_.file = folder_ / "absent.toml";
  EXPECT_NE(complaint().find("cannot read"), std::string::npos);
}

TEST_F(SettingsTest, SecretsComeFromFilesAndAreNeverShown) {
  std::ofstream(folder_ / "password") << "tell nobody\n";
  environment_ = {{"KIDNAPWATCH_MQTT_PASSWORD_FILE", folder_ / "password"}};
  auto loaded = load_settings(sources_);
  EXPECT_EQ(loaded.settings.mqtt_password, "tell nobody");
  for (const auto& setting : all_settings()) {
    EXPECT_EQ(setting.show(loaded.settings).find("tell nobody"), std::string::npos);
  }
  std::ofstream(folder_ / "mqtt.password") << "from systemd\n";
  environment_ = {{"CREDENTIALS_DIRECTORY", folder_}};
  EXPECT_EQ(load_settings(sources_).settings.mqtt_password, "from systemd");
}

}  // namespace
}  // namespace kidnapwatch::service
