// SPDX-License-Identifier: Apache-2.0
// Who is let in, how often, and what is there for whom.
#include "api/guard.hpp"

#include <cmath>

#include "memory_ports.hpp"

namespace kidnapwatch::api {
namespace {

class GuardTest : public ApiTest {
 protected:
  GuardTest() {
    for (const char* id : {"r1", "r2"}) {
      core::RobotStatus robot;
      robot.id = id;
      fleet.robots_now.push_back(robot);
      const std::string incident = std::string("incident-of-") + id;
      history.all_incidents.push_back({.id = incident, .robot = id, .seq = 1});
      history.all_evidence.push_back({incident, {}});
    }
    let_in({});
  }

  /// Only callers of these names, whose secrets are their names.
  void let_in(std::vector<Caller> callers, const RateLimitConfig& limit = {.per_s = 0.0}) {
    guard = std::make_unique<Guard>(
        [callers = std::move(callers)](std::string_view secret) -> std::optional<Caller> {
          const auto found = std::ranges::find(callers, secret, &Caller::name);
          return found == callers.end() ? std::nullopt : std::optional(*found);
        },
        limit, [this] { return now_s; });
  }

  Response get_as(const std::string& secret, const std::string& target) {
    return get(target, {{"Authorization", "Bearer " + secret}});
  }

  double now_s = 0.0;
};

TEST_F(GuardTest, AsksForATokenAndSaysHow) {
  for (const auto& route : routes()) {
    if (!route.needs) continue;
    const auto response = call({std::string(route.method),
                                std::string(route.pattern),
                                {{"Content-Type", "application/json"}},
                                "{}",
                                "10.0.0.7"});
    EXPECT_EQ(response.status, 401) << route.pattern;
    EXPECT_EQ(header_of(response, "WWW-Authenticate"), "Bearer");
  }
}

TEST_F(GuardTest, ShowsHealthAndDescriptionToAnybody) {
  for (const char* target : {"/healthz", "/readyz", "/api/v1/openapi.json", "/"}) {
    EXPECT_NE(get(target).status, 401) << target;
  }
}

TEST_F(GuardTest, RefusesAWrongToken) {
  let_in({{.name = "right"}});
  EXPECT_EQ(get_as("right", "/api/v1/robots").status, 200);
  const auto response = get_as("wrong", "/api/v1/robots");
  EXPECT_EQ(response.status, 401);
  EXPECT_EQ(header_of(response, "WWW-Authenticate"), R"(Bearer error="invalid_token")");
  for (const char* value : {"right", "Basic right", "Bearer", "Bearer ", "Bearer  right"}) {
    EXPECT_EQ(get("/api/v1/robots", {{"Authorization", value}}).status, 401) << value;
  }
  EXPECT_EQ(get("/api/v1/robots", {{"authorization", "bearer right"}}).status, 200);
}

TEST_F(GuardTest, LetsOnlyAnAdminConfigure) {
  let_in({{.name = "viewer", .role = Role::viewer},
          {.name = "operator", .role = Role::operator_},
          {.name = "admin", .role = Role::admin},
          {.name = "partial", .role = Role::admin, .robots = {"r1"}}});
  const auto put_as = [&](const std::string& who) {
    return put("/api/v1/config", "{}", {{"Authorization", "Bearer " + who}}).status;
  };
  EXPECT_EQ(put_as("viewer"), 403);
  EXPECT_EQ(put_as("operator"), 403);
  EXPECT_EQ(put_as("partial"), 403);
  EXPECT_EQ(put_as("admin"), 200);
  EXPECT_EQ(fleet.config("").effective.author, "admin");
}

TEST_F(GuardTest, HidesTheRobotsOfOthers) {
  let_in({{.name = "one", .role = Role::viewer, .robots = {"r2"}}});
  const auto robots = body(get_as("one", "/api/v1/robots"))["robots"];
  ASSERT_EQ(robots.size(), 1U);
  EXPECT_EQ(robots[0]["id"], "r2");
  for (const char* path : {"/api/v1/robots/r", "/api/v1/incidents/incident-of-r"}) {
    EXPECT_EQ(get_as("one", std::string(path) + "1").status, 404);
    EXPECT_EQ(get_as("one", std::string(path) + "2").status, 200);
  }
  EXPECT_EQ(get_as("one", "/api/v1/robots/r1/scores").status, 404);
  EXPECT_EQ(get_as("one", "/api/v1/incidents/incident-of-r1/evidence").status, 404);
  EXPECT_EQ(get_as("one", "/api/v1/incidents/incident-of-r2/evidence").status, 200);
}

TEST_F(GuardTest, FillsPagesWithWhatTheCallerMaySee) {
  history.all_incidents.clear();
  for (int i = 99; i >= 10; --i) {
    history.all_incidents.push_back(
        {.id = std::to_string(i), .robot = i % 10 == 0 ? "r2" : "r1", .seq = 1});
  }
  let_in({{.name = "one", .role = Role::viewer, .robots = {"r2"}}});
  auto page = body(get_as("one", "/api/v1/incidents?limit=4"));
  ASSERT_EQ(page["incidents"].size(), 4U);
  EXPECT_EQ(page["incidents"][3]["id"], "60");
  page = body(get_as("one", page["next"]));
  EXPECT_EQ(page["incidents"][0]["id"], "50");
  EXPECT_EQ(page["incidents"][3]["id"], "20");
  page = body(get_as("one", page["next"]));
  EXPECT_EQ(page["incidents"].size(), 1U);
  EXPECT_FALSE(page.contains("next"));
}

TEST_F(GuardTest, SlowsEachClientDownByItself) {
  let_in({{.name = "a"}, {.name = "b"}}, {.per_s = 2.0, .burst = 3.0});
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(get_as("a", "/api/v1/robots").status, 200);
  }
  const auto refused = get_as("a", "/api/v1/robots");
  EXPECT_EQ(refused.status, 429);
  EXPECT_EQ(header_of(refused, "Retry-After"), "1");
  EXPECT_EQ(get_as("b", "/api/v1/robots").status, 200);
  now_s = 0.5;
  EXPECT_EQ(get_as("a", "/api/v1/robots").status, 200);
  EXPECT_EQ(get_as("a", "/api/v1/robots").status, 429);
}

TEST_F(GuardTest, SlowsGuessingDown) {
  let_in({{.name = "a"}}, {.per_s = 1.0, .burst = 5.0});
  int asked = 0;
  while (get_as("guess-" + std::to_string(asked), "/api/v1/robots").status == 401) ++asked;
  EXPECT_EQ(asked, 5);
}

TEST(RateLimit, RemembersOnlySoManyClients) {
  RateLimit limit({.per_s = 1.0, .burst = 1.0, .max_clients = 100});
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(limit.wait_s(std::to_string(i), 0.0), 0.0);
  }
  EXPECT_GT(limit.wait_s("999", 0.0), 0.0);
}

}  // namespace
}  // namespace kidnapwatch::api
