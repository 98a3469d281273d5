// SPDX-License-Identifier: Apache-2.0
// The configuration as JSON, both ways.
#include "adapters/codecs/config_json.hpp"

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

constexpr const char* kDefaults =
    R"({"alarm":"motion_consistency",)"
    R"("dissimilarity":{"dimension":"points","gate":"paper","variance_test":"bartlett",)"
    R"("significance":0.05,"invalid":"drop","precision":"f32"},)"
    R"("motion":{"threshold_min":6.0,"sensor":{"x_m":0.0,"y_m":0.0,"theta_rad":0.0}},)"
    R"("calibration":{"false_alarm_rate":0.001,"warmup_pairs":100,"window_pairs":1000},)"
    R"("threshold":null,"detectors":[],"stale_after_s":5.0,"resolve_after_s":30.0,)"
    R"("resync_scans":20})";

core::DetectionConfig read(const char* text) { return detection_config(parsed(text, "body")); }

/// The field that reading `text` complains of.
std::string complaint(const char* text) {
  try {
    (void)read(text);
  } catch (const core::BadInput& error) {
    return error.field();
  }
  return "none";
}

TEST(ConfigJson, SpellsEveryMemberAsTheStructDoes) {
  EXPECT_EQ(text(json(core::DetectionConfig{})), kDefaults);
}

TEST(ConfigJson, ReadsWhatItWrote) {
  core::DetectionConfig config;
  config.dissimilarity = {core::Dimension::ranges, core::Gate::always,
                          core::VarianceTest::brown_forsythe, 0.01, core::InvalidPolicy::clamp};
  config.calibration = {0.002, 50, 500};
  config.alarm = core::AlarmBy::both;
  config.motion.threshold_min = 7.0;
  config.motion.sensor = {0.2, -0.1, 3.0};
  config.threshold = 12.5;
  config.detectors = {"ndt_qe", "me"};
  config.stale_after_s = 2.0;
  config.resolve_after_s = 60.0;
  config.resync_scans = 5;
  EXPECT_EQ(detection_config(parsed(text(json(config)), "body")), config);
}

TEST(ConfigJson, TakesTheBaseWhereAMemberIsAbsent) {
  core::DetectionConfig base;
  base.stale_after_s = 9.0;
  base.threshold = 3.0;
  const auto merged =
      detection_config(parsed(R"({"calibration":{"warmup_pairs":40}})", "body"), base);
  EXPECT_EQ(merged.stale_after_s, 9.0);
  EXPECT_EQ(merged.threshold, 3.0);
  EXPECT_EQ(merged.calibration.warmup_pairs, 40U);
  EXPECT_EQ(merged.calibration.window_pairs, 1000U);
}

TEST(ConfigJson, ReadsAThresholdOfNullAsCalibrated) {
  core::DetectionConfig base;
  base.threshold = 3.0;
  EXPECT_EQ(detection_config(parsed(R"({"threshold":null})", "body"), base).threshold,
            std::nullopt);
  EXPECT_EQ(read(R"({"threshold":7})").threshold, 7.0);
}

TEST(ConfigJson, NamesTheMemberThatIsUnknown) {
  EXPECT_EQ(complaint(R"({"treshold":1})"), "treshold");
  EXPECT_EQ(complaint(R"({"dissimilarity":{"gates":"paper"}})"), "dissimilarity.gates");
}

TEST(ConfigJson, NamesTheMemberOfTheWrongType) {
  EXPECT_EQ(complaint("[]"), "body");
  EXPECT_EQ(complaint("null"), "body");
  EXPECT_EQ(complaint(R"({"dissimilarity":null})"), "dissimilarity");
  EXPECT_EQ(complaint(R"({"dissimilarity":{"gate":1}})"), "dissimilarity.gate");
  EXPECT_EQ(complaint(R"({"dissimilarity":{"gate":"Paper"}})"), "dissimilarity.gate");
  EXPECT_EQ(complaint(R"({"dissimilarity":{"significance":"0.05"}})"),
            "dissimilarity.significance");
  EXPECT_EQ(complaint(R"({"calibration":{"warmup_pairs":-1}})"), "calibration.warmup_pairs");
  EXPECT_EQ(complaint(R"({"calibration":{"warmup_pairs":40.0}})"), "calibration.warmup_pairs");
  EXPECT_EQ(complaint(R"({"calibration":{"warmup_pairs":1e300}})"), "calibration.warmup_pairs");
  EXPECT_EQ(complaint(R"({"threshold":true})"), "threshold");
  EXPECT_EQ(complaint(R"({"detectors":"ndt_qe"})"), "detectors");
  EXPECT_EQ(complaint(R"({"detectors":[7]})"), "detectors");
  EXPECT_EQ(complaint(R"({"stale_after_s":null})"), "stale_after_s");
}

TEST(ConfigJson, SaysWhichNamesAreAllowed) {
  try {
    (void)read(R"({"dissimilarity":{"gate":"open"}})");
    FAIL() << "no exception";
  } catch (const core::BadInput& error) {
    EXPECT_STREQ(error.what(),
                 "dissimilarity.gate: must be one of paper, homogeneous, never, always");
  }
}

TEST(ConfigOrigins, NameTheLevelThatSetsAMember) {
  const auto fleet = parsed(R"({"threshold":60,"calibration":{"window_pairs":500}})", "fleet");
  const auto robot = parsed(R"({"threshold":null,"motion":{"sensor":{"x_m":1}}})", "robot");
  const Json origins = config_origins({}, fleet, robot);
  EXPECT_EQ(origins.at("threshold"), "robot");
  EXPECT_EQ(origins.at("calibration.window_pairs"), "fleet");
  EXPECT_EQ(origins.at("calibration.warmup_pairs"), "default");
  EXPECT_EQ(origins.at("motion.sensor.x_m"), "robot");
  EXPECT_EQ(origins.at("motion.sensor.y_m"), "default");
  EXPECT_EQ(origins.at("detectors"), "default");
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
