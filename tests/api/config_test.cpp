// SPDX-License-Identifier: Apache-2.0
// The configuration over REST.
#include "api/config.hpp"

#include "memory_ports.hpp"

namespace kidnapwatch::api {
namespace {

constexpr const char* kConfig = "/api/v1/config";

class ConfigTest : public ApiTest {
 protected:
  std::string refused_field(const std::string& text) {
    const auto response = put(kConfig, text);
    EXPECT_EQ(response.status, 400) << text;
    EXPECT_EQ(fleet.config().version, 0) << text;
    return body(response).value("field", "none");
  }
};

TEST_F(ConfigTest, IsReadWithItsVersionAsTag) {
  const auto response = get(kConfig);
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(header_of(response, "ETag"), R"("0")");
  EXPECT_EQ(body(response)["dissimilarity"]["gate"], "paper");
  EXPECT_TRUE(body(response)["threshold"].is_null());
}

TEST_F(ConfigTest, IsNotSentAgainToWhomHasIt) {
  const auto response = get(kConfig, {{"If-None-Match", R"("7", W/"0")"}});
  EXPECT_EQ(response.status, 304);
  EXPECT_TRUE(response.body.empty());
  EXPECT_EQ(get(kConfig, {{"If-None-Match", R"("7")"}}).status, 200);
}

TEST_F(ConfigTest, IsReplacedByWhatWasReadAndChanged) {
  auto config = body(get(kConfig));
  config["threshold"] = 250.0;
  const auto response = put(kConfig, text(config), {{"If-Match", R"("0")"}});
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(header_of(response, "ETag"), R"("1")");
  EXPECT_EQ(body(response), config);
  EXPECT_EQ(fleet.config().config.threshold, 250.0);
  EXPECT_EQ(fleet.config().author, "10.0.0.7");
}

TEST_F(ConfigTest, TakesTheDefaultWhereAMemberIsAbsent) {
  EXPECT_EQ(put(kConfig, R"({"stale_after_s":9})").status, 200);
  EXPECT_EQ(put(kConfig, R"({"resync_scans":9})").status, 200);
  EXPECT_EQ(fleet.config().config.stale_after_s, core::DetectionConfig{}.stale_after_s);
  EXPECT_EQ(fleet.config().config.resync_scans, 9U);
}

TEST_F(ConfigTest, RefusesAVersionThatIsNotTheCurrentOne) {
  put(kConfig, "{}");
  for (const char* tag : {R"("0")", R"("2")", R"(W/"1")", "1", "garbage"}) {
    const auto response = put(kConfig, "{}", {{"If-Match", tag}});
    EXPECT_EQ(response.status, 412) << tag;
    EXPECT_EQ(header_of(response, "ETag"), R"("1")");
  }
  EXPECT_EQ(fleet.config().version, 1);
  EXPECT_EQ(put(kConfig, "{}", {{"If-Match", R"("0", "1")"}}).status, 200);
  EXPECT_EQ(put(kConfig, "{}", {{"If-Match", "*"}}).status, 200);
}

TEST_F(ConfigTest, TellsWhoLosesTheRace) {
  fleet.overtaken = true;
  const auto response = put(kConfig, "{}", {{"If-Match", R"("0")"}});
  EXPECT_EQ(response.status, 412);
  EXPECT_EQ(header_of(response, "ETag"), R"("1")");
}

TEST_F(ConfigTest, NamesTheMemberAndItsRange) {
  const auto response = put(kConfig, R"({"calibration":{"false_alarm_rate":0.5}})");
  EXPECT_EQ(response.status, 400);
  EXPECT_EQ(text(body(response)),
            R"({"type":"about:blank","title":"Bad Request","status":400,)"
            R"("detail":"calibration.false_alarm_rate: must be above 0 and below 0.05",)"
            R"("field":"calibration.false_alarm_rate"})");
}

TEST_F(ConfigTest, RefusesWhatIsNoConfiguration) {
  EXPECT_EQ(refused_field(""), "body");
  EXPECT_EQ(refused_field("{"), "body");
  EXPECT_EQ(refused_field("[]"), "body");
  EXPECT_EQ(refused_field(R"({"threshold":1,"threshold":2})"), "body");
  EXPECT_EQ(refused_field(R"({"tresholdd":1})"), "tresholdd");
  EXPECT_EQ(refused_field(R"({"threshold":0})"), "threshold");
  EXPECT_EQ(refused_field(R"({"resync_scans":1.5})"), "resync_scans");
  EXPECT_EQ(refused_field(R"({"dissimilarity":{"significance":1}})"), "dissimilarity.significance");
}

}  // namespace
}  // namespace kidnapwatch::api
