// SPDX-License-Identifier: Apache-2.0
// openapi.yaml against the route table, against core's defaults, and against real answers.
#include <set>

#include "adapters/codecs/config_json.hpp"
#include "api/descriptions.hpp"
#include "memory_ports.hpp"
#include "schema.hpp"

namespace kidnapwatch::api {
namespace {

const Json& document() {
  static const Json parsed = adapters::codecs::parsed(openapi_json(), "openapi");
  return parsed;
}

const Json& response_schema(const std::string& path, int status, const std::string& type) {
  const auto& response =
      resolved(document(), document()["paths"][path]["get"]["responses"][std::to_string(status)]);
  return response["content"][type]["schema"];
}

std::set<std::string> words(std::string_view text) {
  std::set<std::string> result;
  while (!text.empty()) {
    result.emplace(take_until(text, ' '));
  }
  return result;
}

std::set<std::string> query_parameters(const Json& operation) {
  std::set<std::string> names;
  for (const auto& one : operation.value("parameters", Json::array())) {
    const auto& parameter = resolved(document(), one);
    if (parameter["in"] == "query") {
      names.insert(parameter["name"]);
    }
  }
  return names;
}

std::string lower(std::string_view method) {
  std::string result;
  for (const char c : method) {
    result += static_cast<char>(c | 0x20);
  }
  return result;
}

TEST(Openapi, DescribesEveryRouteWithItsParameters) {
  for (const auto& route : routes()) {
    const auto& paths = document()["paths"];
    const std::string path(route.pattern);
    ASSERT_TRUE(paths.contains(path)) << path;
    ASSERT_TRUE(paths[path].contains(lower(route.method))) << route.method << " " << path;
    EXPECT_EQ(query_parameters(paths[path][lower(route.method)]), words(route.parameters)) << path;
  }
}

TEST(Openapi, DescribesNoRouteThatThereIsNot) {
  std::set<std::pair<std::string, std::string>> known;
  for (const auto& route : routes()) {
    known.emplace(route.pattern, lower(route.method));
  }
  for (const auto& [path, item] : document()["paths"].items()) {
    for (const auto& [method, operation] : item.items()) {
      EXPECT_TRUE(method == "parameters" || known.contains({path, method}))
          << method << " " << path;
    }
  }
}

TEST(Openapi, SaysWhereATokenIsNeeded) {
  for (const auto& route : routes()) {
    const auto& operation = document()["paths"][std::string(route.pattern)][lower(route.method)];
    EXPECT_EQ(operation.contains("security"), !route.needs) << route.pattern;
    EXPECT_EQ(operation["responses"].contains("401"), route.needs.has_value()) << route.pattern;
    EXPECT_EQ(operation["responses"].contains("403"), route.needs > Role::viewer) << route.pattern;
  }
}

/// Calls `visit` with everything in `json`, itself included.
void everywhere(const Json& json, const auto& visit) {
  visit(json);
  if (json.is_structured()) {
    for (const auto& inner : json) {
      everywhere(inner, visit);
    }
  }
}

TEST(Openapi, RefersOnlyToWhatItHas) {
  int references = 0;
  everywhere(document(), [&](const Json& json) {
    if (json.is_object() && json.contains("$ref")) {
      ++references;
      EXPECT_NO_THROW((void)resolved(document(), json)) << json["$ref"];
    }
  });
  EXPECT_GT(references, 10);
}

TEST(Openapi, HasExamplesThatFitTheirSchemas) {
  int examples = 0;
  everywhere(document(), [&](const Json& json) {
    if (json.is_object() && json.contains("schema") && json.contains("example")) {
      ++examples;
      EXPECT_EQ(misfit(document(), json["schema"], json["example"]), "") << json["example"];
    }
  });
  EXPECT_GT(examples, 5);
}

/// What a schema says of a value if every member takes its default.
Json defaults(const Json& schema) {
  if (!schema.contains("properties")) {
    return schema["default"];
  }
  Json object = Json::object();
  for (const auto& [name, member] : schema["properties"].items()) {
    object[name] = defaults(member);
  }
  return object;
}

TEST(Openapi, TellsTheDefaultsThatAreInForce) {
  EXPECT_EQ(defaults(document()["components"]["schemas"]["DetectionConfig"]),
            adapters::codecs::json(core::DetectionConfig{}));
}

class OpenapiAnswersTest : public ApiTest {
 protected:
  OpenapiAnswersTest() {
    core::RobotStatus robot;
    robot.id = "r1";
    fleet.robots_now = {robot, robot};
    fleet.robots_now[1].id = "r2";
    fleet.robots_now[1].score = core::Score{};
    fleet.robots_now[1].threshold = 1.0;
    fleet.robots_now[1].incident_id = "i1";
    core::Incident incident;
    incident.id = "i2";
    incident.robot = "r1";
    incident.seq = 1;
    history.all_incidents = {incident, incident};
    history.all_incidents[1].id = "i1";
    history.all_incidents[1].resolved_at = at_s(3);
    history.all_incidents[1].acknowledged_by = "ann";
    history.all_incidents[1].resolved_by = "bob";
    history.all_incidents[1].shelved_until = at_s(2);
    history.all_incidents[1].label = core::IncidentLabel::test;
    history.all_incidents[1].comment = "tried";
    core::Evidence evidence;
    evidence.scans.before.ranges_m = {1.0F, std::numeric_limits<float>::infinity()};
    evidence.scans.after.odometry = core::Pose{};
    evidence.scores.resize(2);
    history.all_evidence.emplace_back("i1", evidence);
    history.all_scores = {{"r1", core::Score{}}, {"r1", core::Score{}}};
    history.all_scores[1].second.stamp = at_s(90);
    history.all_scores[1].second.threshold = 3.0;
    history.all_scores[1].second.motion = core::MotionScore{.threshold = 4.5};
    history.all_configs.resize(2);
    history.all_configs[0].version = 2;
    history.all_configs[0].robot = "r1";
    history.all_configs[1].version = 1;
  }

  /// What is wrong with the answer to GET `target`, as `path` describes it.
  std::string misfit_of(const std::string& path, const std::string& target) {
    const auto response = get(target);
    const auto& schema = response_schema(path, response.status, response.content_type);
    return misfit(document(), schema, body(response));
  }
};

TEST_F(OpenapiAnswersTest, FitTheirSchemas) {
  for (const auto& [path, target] : std::vector<std::pair<std::string, std::string>>{
           {"/api/v1/robots", "/api/v1/robots"},
           {"/api/v1/robots/{id}", "/api/v1/robots/r1"},
           {"/api/v1/robots/{id}", "/api/v1/robots/r2"},
           {"/api/v1/robots/{id}", "/api/v1/robots/r3"},
           {"/api/v1/robots/{id}/scores", "/api/v1/robots/r1/scores"},
           {"/api/v1/robots/{id}/scores", "/api/v1/robots/r1/scores?limit=1"},
           {"/api/v1/robots/{id}/scores", "/api/v1/robots/r1/scores?limit=x"},
           {"/api/v1/robots/{id}/scores", "/api/v1/robots/r1/scores?resolution=60"},
           {"/api/v1/robots/{id}/scores", "/api/v1/robots/r1/scores?resolution=60&limit=1"},
           {"/api/v1/robots/{id}/config", "/api/v1/robots/r1/config"},
           {"/api/v1/robots/{id}/config", "/api/v1/robots/r3/config"},
           {"/api/v1/config/history", "/api/v1/config/history"},
           {"/api/v1/config/history", "/api/v1/config/history?limit=1"},
           {"/api/v1/config/history", "/api/v1/config/history?cursor=x"},
           {"/api/v1/incidents", "/api/v1/incidents"},
           {"/api/v1/incidents", "/api/v1/incidents?limit=1"},
           {"/api/v1/incidents/{id}", "/api/v1/incidents/i1"},
           {"/api/v1/incidents/{id}", "/api/v1/incidents/i3"},
           {"/api/v1/incidents/{id}/evidence", "/api/v1/incidents/i1/evidence"},
           {"/api/v1/config", "/api/v1/config"},
           {"/api/v1/evaluation/roc", "/api/v1/evaluation/roc"},
           {"/api/v1/me", "/api/v1/me"},
           {"/api/v1/service", "/api/v1/service"},
           {"/api/v1/openapi.json", "/api/v1/openapi.json"},
           {"/api/v1/asyncapi.json", "/api/v1/asyncapi.json"},
           {"/healthz", "/healthz"},
           {"/readyz", "/readyz"}}) {
    EXPECT_EQ(misfit_of(path, target), "") << target;
  }
}

TEST_F(OpenapiAnswersTest, AreToldFromWrongOnes) {
  const auto& robot = document()["components"]["schemas"]["Robot"];
  auto wrong = body(get("/api/v1/robots/r1"));
  ASSERT_EQ(misfit(document(), robot, wrong), "");
  wrong["state"] = "lost";
  EXPECT_NE(misfit(document(), robot, wrong), "");
  wrong = body(get("/api/v1/robots/r1"));
  wrong["scans"].erase("failed");
  EXPECT_NE(misfit(document(), robot, wrong), "");
  wrong = body(get("/api/v1/robots/r1"));
  wrong["colour"] = "red";
  EXPECT_NE(misfit(document(), robot, wrong), "");
}

}  // namespace
}  // namespace kidnapwatch::api
