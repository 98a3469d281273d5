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
    EXPECT_EQ(fleet.config("").effective.version, 0) << text;
    return body(response).value("field", "none");
  }
};

TEST_F(ConfigTest, IsReadWithItsVersionAsTag) {
  const auto response = get(kConfig);
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(header_of(response, "ETag"), R"("0")");
  EXPECT_EQ(body(response)["effective"]["dissimilarity"]["gate"], "paper");
  EXPECT_TRUE(body(response)["effective"]["threshold"].is_null());
  EXPECT_EQ(body(response)["origins"]["threshold"], "default");
  EXPECT_EQ(body(response)["values"], Json::object());
}

TEST_F(ConfigTest, IsNotSentAgainToWhomHasIt) {
  const auto response = get(kConfig, {{"If-None-Match", R"("7", W/"0")"}});
  EXPECT_EQ(response.status, 304);
  EXPECT_TRUE(response.body.empty());
  EXPECT_EQ(get(kConfig, {{"If-None-Match", R"("7")"}}).status, 200);
}

TEST_F(ConfigTest, IsReplacedByWhatWasReadAndChanged) {
  auto config = body(get(kConfig))["effective"];
  config["threshold"] = 250.0;
  const auto response = put(kConfig, text(config), {{"If-Match", R"("0")"}});
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(header_of(response, "ETag"), R"("1")");
  EXPECT_EQ(body(response)["effective"], config);
  EXPECT_EQ(body(response)["values"], config);
  EXPECT_EQ(fleet.config("").effective.config.threshold, 250.0);
  EXPECT_EQ(fleet.config("").effective.author, "10.0.0.7");
}

TEST_F(ConfigTest, TakesTheDefaultWhereAMemberIsAbsent) {
  EXPECT_EQ(put(kConfig, R"({"stale_after_s":9})").status, 200);
  EXPECT_EQ(put(kConfig, R"({"resync_scans":9})").status, 200);
  EXPECT_EQ(fleet.config("").effective.config.stale_after_s, core::DetectionConfig{}.stale_after_s);
  EXPECT_EQ(fleet.config("").effective.config.resync_scans, 9U);
}

TEST_F(ConfigTest, RefusesAVersionThatIsNotTheCurrentOne) {
  put(kConfig, "{}");
  for (const char* tag : {R"("0")", R"("2")", R"(W/"1")", "1", "garbage"}) {
    const auto response = put(kConfig, "{}", {{"If-Match", tag}});
    EXPECT_EQ(response.status, 412) << tag;
    EXPECT_EQ(header_of(response, "ETag"), R"("1")");
  }
  EXPECT_EQ(fleet.config("").effective.version, 1);
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

class RobotConfigTest : public ApiTest {
 protected:
  RobotConfigTest() {
    fleet.robots_now.resize(2);
    fleet.robots_now[0].id = "r1";
    fleet.robots_now[1].id = "r2";
  }
  void only_for(const std::string& robot) {
    guard = std::make_unique<Guard>(
        [robot](std::string_view) {
          return Caller{.name = "limited", .role = Role::admin, .robots = {robot}};
        },
        RateLimitConfig{.per_s = 0.0}, [] { return 0.0; });
  }
  const std::vector<Header> token{{"Authorization", "Bearer x"},
                                  {"Content-Type", "application/json"}};
  const std::string r1 = "/api/v1/robots/r1/config";
};

TEST_F(RobotConfigTest, InheritsWhatItDoesNotSet) {
  (void)put(kConfig, R"({"threshold":60,"resync_scans":9})");
  const auto response = put(r1, R"({"threshold":null})");
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(header_of(response, "ETag"), R"("2")");
  const Json shown = body(get(r1));
  EXPECT_EQ(shown["robotId"], "r1");
  EXPECT_EQ(shown["values"], (Json{{"threshold", nullptr}}));
  EXPECT_TRUE(shown["effective"]["threshold"].is_null());
  EXPECT_EQ(shown["origins"]["threshold"], "robot");
  EXPECT_EQ(shown["origins"]["resync_scans"], "fleet");
  EXPECT_EQ(body(get("/api/v1/robots/r2/config"))["effective"]["threshold"], 60.0);
}

TEST_F(RobotConfigTest, IsPatchedMemberByMember) {
  (void)put(r1, R"({"threshold":70,"calibration":{"window_pairs":500,"warmup_pairs":50}})");
  const auto patched =
      patch(r1, R"({"threshold":null,"calibration":{"window_pairs":600}})",
            {{"Content-Type", "application/merge-patch+json"}, {"If-Match", R"("1")"}});
  EXPECT_EQ(text(body(patched)["values"]),
            R"({"calibration":{"window_pairs":600,"warmup_pairs":50}})");
  EXPECT_EQ(patch(r1, "[]").status, 400);
  EXPECT_EQ(patch(r1, "{}", {}).status, 415);
  EXPECT_EQ(body(patch(r1, R"({"resync_scans":1})"))["field"], "resync_scans");
}

TEST_F(RobotConfigTest, IsDeletedToInherit) {
  (void)put(r1, R"({"threshold":70})");
  EXPECT_EQ(remove(r1, {{"If-Match", R"("0")"}}).status, 412);
  const auto response = remove(r1);
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(body(response)["values"], Json::object());
  EXPECT_EQ(body(response)["origins"]["threshold"], "default");
  EXPECT_EQ(remove(kConfig).status, 200);
}

TEST_F(RobotConfigTest, WithoutIfMatchNobodysChangeIsLost) {
  fleet.overtaken = true;
  EXPECT_EQ(patch(r1, R"({"threshold":70})").status, 200);
  EXPECT_EQ(fleet.levels.size(), 2U);
  fleet.overtaken = true;
  EXPECT_EQ(patch(r1, "{}", {{"Content-Type", "application/json"}, {"If-Match", R"("2")"}}).status,
            412);
}

TEST_F(RobotConfigTest, IsThereForRobotsThatAreThere) {
  EXPECT_EQ(get("/api/v1/robots/r3/config").status, 404);
  EXPECT_EQ(put("/api/v1/robots/r3/config", "{}").status, 404);
  EXPECT_EQ(remove("/api/v1/robots/r3/config").status, 404);
  EXPECT_TRUE(fleet.levels.empty());
}

TEST_F(RobotConfigTest, IsForTheTokensOfItsRobot) {
  only_for("r1");
  EXPECT_EQ(call({"PUT", r1, token, "{}", ""}).status, 200);
  EXPECT_EQ(call({"PUT", "/api/v1/robots/r2/config", token, "{}", ""}).status, 404);
  EXPECT_EQ(call({"GET", "/api/v1/robots/r2/config", token, "", ""}).status, 404);
  for (const char* method : {"PUT", "PATCH", "DELETE"}) {
    EXPECT_EQ(call({method, kConfig, token, "{}", ""}).status, 403) << method;
  }
}

TEST_F(RobotConfigTest, TakesAnAdmin) {
  guard = std::make_unique<Guard>(
      [](std::string_view) { return Caller{.name = "op", .role = Role::operator_, .robots = {}}; },
      RateLimitConfig{.per_s = 0.0}, [] { return 0.0; });
  EXPECT_EQ(call({"GET", r1, token, "", ""}).status, 200);
  EXPECT_EQ(call({"GET", "/api/v1/config/history", token, "", ""}).status, 200);
  for (const char* method : {"PUT", "PATCH", "DELETE"}) {
    EXPECT_EQ(call({method, r1, token, "{}", ""}).status, 403) << method;
  }
  EXPECT_EQ(call({"POST", "/api/v1/config/history/1/restore", token, "{}", ""}).status, 403);
}

class ConfigHistoryTest : public RobotConfigTest {
 protected:
  ConfigHistoryTest() {
    history.all_configs = {
        {.version = 3, .since = at_s(3), .author = "bob", .robot = "r2", .values = Json::object()},
        {.version = 2,
         .since = at_s(2),
         .author = "ann",
         .robot = "r1",
         .values = {{"threshold", 70}}},
        {.version = 1,
         .since = at_s(1),
         .author = "ann",
         .robot = "",
         .values = {{"threshold", 60}}}};
  }
  [[nodiscard]] std::string versions(const std::string& target) {
    std::string all;
    const Json page = body(call({"GET", target, token, "", ""}));
    for (const auto& change : page.at("changes")) {
      all += change.at("version").dump();
    }
    return all;
  }
  const std::string history_ = "/api/v1/config/history";
};

TEST_F(ConfigHistoryTest, ListsChangesNewestFirst) {
  EXPECT_EQ(versions(history_), "321");
  EXPECT_EQ(versions(history_ + "?robot=r1"), "2");
  EXPECT_EQ(versions(history_ + "?robot="), "1");
  const Json first = body(get(history_ + "?limit=2"));
  EXPECT_EQ(first.at("next"), history_ + "?cursor=2&limit=2");
  EXPECT_EQ(versions(first.at("next")), "1");
  EXPECT_EQ(text(first.at("changes").at(1)),
            R"({"version":2,"since":"1970-01-01T00:00:02.000000000Z","author":"ann",)"
            R"("robotId":"r1","values":{"threshold":70}})");
  EXPECT_EQ(body(get(history_ + "?cursor=x")).at("field"), "cursor");
  EXPECT_EQ(body(get(history_ + "?limit=0")).at("field"), "limit");
}

TEST_F(ConfigHistoryTest, IsRestoredToItsLevel) {
  const auto response = post(history_ + "/2/restore", "{}");
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(body(response).at("robotId"), "r1");
  EXPECT_EQ(fleet.config("r1").effective.config.threshold, 70.0);
  EXPECT_EQ(post(history_ + "/1/restore", "{}", {{"If-Match", R"("9")"}}).status, 412);
  EXPECT_EQ(post(history_ + "/4/restore", "{}").status, 404);
  EXPECT_EQ(body(post(history_ + "/x/restore", "{}")).at("field"), "version");
}

TEST_F(ConfigHistoryTest, ShowsOthersRobotsToNobody) {
  only_for("r1");
  EXPECT_EQ(versions(history_), "21");
  EXPECT_EQ(versions(history_ + "?robot=r2"), "");
  EXPECT_EQ(call({"POST", history_ + "/3/restore", token, "{}", ""}).status, 404);
  EXPECT_EQ(call({"POST", history_ + "/1/restore", token, "{}", ""}).status, 403);
}

}  // namespace
}  // namespace kidnapwatch::api
