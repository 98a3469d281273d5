// SPDX-License-Identifier: Apache-2.0
// What would have alarmed, which threshold meets a rate, and what labels say.
#include "api/tuning.hpp"

#include "api/descriptions.hpp"
#include "core/calibration.hpp"
#include "memory_ports.hpp"
#include "schema.hpp"

namespace kidnapwatch::api {
namespace {

class TuningTest : public ApiTest {
 protected:
  TuningTest() {
    fleet.robots_now.resize(2);
    fleet.robots_now[0].id = "r1";
    fleet.robots_now[1].id = "r2";
    (void)fleet.put_config("", {{"resolve_after_s", 10}}, 0, "ann");
  }

  /// 5 scores a second, of QS-2DDTW.
  void drive(const std::string& robot, const std::vector<double>& costs) {
    for (const double cost : costs) {
      core::Score score;
      score.reference = stamp_;
      stamp_ += std::chrono::milliseconds(200);
      score.stamp = stamp_;
      score.dissimilarity.cost = cost;
      score.state = core::RobotState::normal;
      history.all_scores.emplace_back(robot, score);
    }
  }
  void add_incident(const std::string& robot, double score,
                    std::optional<core::IncidentLabel> label = {}) {
    core::Incident incident;
    incident.id = std::to_string(1000 - history.all_incidents.size());  // newest first
    incident.robot = robot;
    incident.seq = 1;
    incident.detector = "qs2ddtw";
    incident.score = score;
    incident.label = label;
    incident.before_stamp = stamp_ - std::chrono::milliseconds(400);
    incident.after_stamp = stamp_ - std::chrono::milliseconds(200);
    incident.scan_stamp = stamp_;
    history.all_incidents.push_back(incident);
  }
  std::string refused(const std::string& target, const std::string& json) {
    const auto response = post(target, json);
    EXPECT_EQ(response.status, 400) << json;
    return body(response).value("field", "none");
  }

  core::Stamp stamp_ = at_s(1000);
  const std::string preview = "/api/v1/thresholds:preview";
  const std::string calibrate = "/api/v1/thresholds:calibrate";
  const std::string roc = "/api/v1/evaluation/roc";
};

TEST_F(TuningTest, TellsWhatWouldBeKeptLostAndRaised) {
  drive("r1", {5, 5, 100, 5});
  add_incident("r1", 100.0, core::IncidentLabel::kidnapping);
  drive("r1", std::vector<double>(100, 5.0));
  drive("r1", {70, 5});
  add_incident("r1", 70.0, core::IncidentLabel::false_alarm);
  drive("r2", std::vector<double>(94, 5.0));
  const Json high = body(post(preview, R"({"detector":"qs2ddtw","threshold":80})"));
  EXPECT_EQ(high.at("scores"), 200);
  EXPECT_NEAR(high.at("observedHours").get<double>(), 40.0 / 3600.0, 1e-9);
  EXPECT_EQ(high.at("kept"), 1);
  EXPECT_EQ(high.at("lost"), 1);
  EXPECT_EQ(high.at("raised"), 0);
  EXPECT_EQ(high.at("lostIncidents").at(0).at("score"), 70.0);
  EXPECT_NEAR(high.at("falseAlarmsPerDay").at("now").get<double>(), 86400.0 / 40.0, 1e-6);
  EXPECT_EQ(high.at("falseAlarmsPerDay").at("then"), 0.0);
  EXPECT_EQ(high.at("values"), (Json{{"threshold", 80.0}}));
  drive("r2", {60, 5});
  const Json low = body(post(preview, R"({"detector":"qs2ddtw","threshold":50,"robot":"r2"})"));
  EXPECT_EQ(low.at("kept"), 0);
  EXPECT_EQ(low.at("raised"), 1);
  EXPECT_EQ(low.at("raisedIncidents").at(0).at("robotId"), "r2");
  EXPECT_EQ(low.at("raisedIncidents").at(0).at("score"), 60.0);
}

TEST_F(TuningTest, TellsOfTheRangeThatIsAskedFor) {
  drive("r1", {5, 100, 5});
  drive("r1", std::vector<double>(100, 5.0));
  const Json later = body(post(preview, R"({"detector":"qs2ddtw","threshold":50,)"
                                        R"("from":"1970-01-01T00:16:50Z"})"));
  EXPECT_EQ(later.at("raised"), 0);
  EXPECT_LT(later.at("scores"), 60);
}

TEST_F(TuningTest, RefusesWhatIsNoPreview) {
  EXPECT_EQ(refused(preview, "[]"), "body");
  EXPECT_EQ(refused(preview, "{}"), "threshold");
  EXPECT_EQ(refused(preview, R"({"threshold":"high"})"), "threshold");
  EXPECT_EQ(refused(preview, R"({"threshold":0})"), "threshold");
  EXPECT_EQ(refused(preview, R"({"threshold":5,"detector":"ndt_qe"})"), "detector");
  EXPECT_EQ(refused(preview, R"({"threshold":5,"detector":5})"), "detector");
  EXPECT_EQ(refused(preview, R"({"threshold":5,"from":"yesterday"})"), "from");
  EXPECT_EQ(refused(preview, R"({"threshold":5,"tresholdd":5})"), "tresholdd");
  EXPECT_EQ(refused(preview, R"({"threshold":5,"from":"2026-01-02T00:00:00Z",)"
                             R"("to":"2026-01-01T00:00:00Z"})"),
            "to");
  EXPECT_EQ(post(preview, R"({"threshold":5,"robot":"r3"})").status, 404);
}

TEST_F(TuningTest, CalibratesToARate) {
  std::vector<double> costs;
  costs.reserve(500);
  for (int i = 0; i < 500; ++i) costs.push_back(10.0 + i % 50);
  drive("r1", costs);
  const auto response = post(calibrate, R"({"detector":"qs2ddtw","falseAlarmRate":0.01})");
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(body(response).at("threshold"), core::exponential_tail_threshold(costs, 0.01));
  EXPECT_EQ(body(response).at("scores"), 500);
  EXPECT_NEAR(body(response).at("abovePerDay").get<double>(), 0.01 * 5 * 86400, 1e-6);
  EXPECT_EQ(body(response).at("values").at("threshold"), body(response).at("threshold"));
  EXPECT_EQ(post(calibrate, R"({"detector":"qs2ddtw","falseAlarmRate":0.01,"robot":"r2"})").status,
            409);  // too few scores
}

TEST_F(TuningTest, CalibratesToTheLeastRateThereIs) {
  std::vector<double> costs(500, 10.0);
  costs.back() = 20.0;
  drive("r1", costs);
  const auto response = post(calibrate, R"({"detector":"qs2ddtw","falseAlarmRate":1e-320})");
  EXPECT_EQ(response.status, 200);
  EXPECT_TRUE(body(response).at("threshold").is_number()) << response.body;
}

TEST_F(TuningTest, CalibratesMotionByItsConfirmedScores) {
  drive("r1", std::vector<double>(200, 1.0));
  for (std::size_t i = 0; i < history.all_scores.size(); ++i) {
    history.all_scores[i].second.motion =
        core::MotionScore{.score = 0.0, .confirmed = static_cast<double>(i % 20)};
  }
  const Json found = body(post(calibrate, R"({"falseAlarmRate":0.001})"));
  EXPECT_EQ(found.at("detector"), "motion_consistency");
  EXPECT_EQ(found.at("values").at("motion").at("threshold_min"), found.at("threshold"));
}

TEST_F(TuningTest, RefusesWhatIsNoCalibration) {
  EXPECT_EQ(refused(calibrate, "{}"), "falseAlarmRate");
  EXPECT_EQ(refused(calibrate, R"({"falseAlarmRate":0.05})"), "falseAlarmRate");
  EXPECT_EQ(refused(calibrate, R"({"falseAlarmRate":0})"), "falseAlarmRate");
  EXPECT_EQ(refused(calibrate, R"({"falseAlarmRate":0.01,"threshold":5})"), "threshold");
}

TEST_F(TuningTest, SuggestsAThresholdFromLabels) {
  using enum core::IncidentLabel;
  for (const double score : {60.0, 70.0, 90.0}) add_incident("r1", score, false_alarm);
  for (const double score : {80.0, 100.0, 120.0, 140.0}) add_incident("r2", score, kidnapping);
  add_incident("r1", 500.0);
  add_incident("r1", 500.0, test);
  const Json found = body(get(roc + "?detector=qs2ddtw"));
  EXPECT_EQ(found.at("kidnappings"), 4);
  EXPECT_EQ(found.at("falseAlarms"), 3);
  EXPECT_NEAR(found.at("area").at("value").get<double>(), 11.0 / 12.0, 1e-12);
  EXPECT_LT(found.at("area").at("low"), found.at("area").at("value"));
  EXPECT_FALSE(found.at("points").at(0).contains("threshold"));
  const Json& suggestion = found.at("suggestion");
  EXPECT_NEAR(suggestion.at("threshold").get<double>(), 100.0, 1e-9);
  EXPECT_LT(suggestion.at("threshold"), 100.0);  // what is at 100 alarms
  EXPECT_EQ(suggestion.at("found").at("count"), 3);
  EXPECT_EQ(suggestion.at("falseAlarms").at("count"), 0);
  EXPECT_GT(suggestion.at("falseAlarms").at("high"), 0.3);  // three say little
}

TEST_F(TuningTest, SuggestsNothingWhereFalseAlarmsScoreHigher) {
  add_incident("r1", 60.0, core::IncidentLabel::kidnapping);
  add_incident("r1", 90.0, core::IncidentLabel::false_alarm);
  const Json found = body(get(roc + "?detector=qs2ddtw"));
  EXPECT_EQ(found.at("area").at("value"), 0.0);
  EXPECT_FALSE(found.contains("suggestion")) << found.dump();
}

TEST_F(TuningTest, NeedsLabelsOfBothKinds) {
  add_incident("r1", 60.0, core::IncidentLabel::kidnapping);
  EXPECT_EQ(get(roc + "?detector=qs2ddtw").status, 409);
  EXPECT_EQ(get(roc).status, 409);
  EXPECT_EQ(get(roc + "?robot=r3").status, 404);
  EXPECT_EQ(body(get(roc + "?detector=ndt_qe")).at("field"), "detector");
  EXPECT_EQ(body(get(roc + "?from=x")).at("field"), "from");
}

TEST_F(TuningTest, AnswersAsItsDescriptionSays) {
  const Json document = adapters::codecs::parsed(openapi_json(), "openapi");
  const auto misfit_of = [&](const std::string& path, const char* method, const Response& answer) {
    EXPECT_EQ(answer.status, 200) << answer.body;
    const auto& content = document["paths"][path][method]["responses"]["200"]["content"];
    return misfit(document, content["application/json"]["schema"], body(answer));
  };
  drive("r1", {5, 100, 5});
  drive("r2", std::vector<double>(200, 5.0));
  add_incident("r2", 80.0, core::IncidentLabel::kidnapping);
  EXPECT_EQ(misfit_of(preview, "post", post(preview, R"({"threshold":50,"detector":"qs2ddtw"})")),
            "");
  EXPECT_EQ(misfit_of(calibrate, "post",
                      post(calibrate, R"({"falseAlarmRate":0.01,"detector":"qs2ddtw"})")),
            "");
  add_incident("r1", 70.0, core::IncidentLabel::false_alarm);
  EXPECT_EQ(misfit_of(roc, "get", get(roc + "?detector=qs2ddtw")), "");
}

TEST_F(TuningTest, TakesAnOperatorAndShowsOnlyItsRobots) {
  Role role = Role::viewer;
  guard = std::make_unique<Guard>(
      [&](std::string_view) { return Caller{.name = "x", .role = role, .robots = {"r2"}}; },
      RateLimitConfig{.per_s = 0.0}, [] { return 0.0; });
  drive("r1", {5, 100, 5});
  const std::vector<Header> token{{"Authorization", "Bearer x"},
                                  {"Content-Type", "application/json"}};
  const auto ask = [&](const std::string& target, const std::string& json) {
    return call({"POST", target, token, json, ""});
  };
  EXPECT_EQ(ask(preview, R"({"threshold":5})").status, 403);
  EXPECT_EQ(ask(calibrate, R"({"falseAlarmRate":0.01})").status, 403);
  role = Role::operator_;
  EXPECT_EQ(body(ask(preview, R"({"threshold":5,"detector":"qs2ddtw"})")).at("scores"), 0);
  EXPECT_EQ(ask(preview, R"({"threshold":5,"robot":"r1"})").status, 404);
  EXPECT_EQ(call({"GET", roc + "?robot=r1", token, "", ""}).status, 404);
}

}  // namespace
}  // namespace kidnapwatch::api
