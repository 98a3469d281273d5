// SPDX-License-Identifier: Apache-2.0
// Incidents and their evidence over REST.
#include "api/incidents.hpp"

#include "memory_ports.hpp"

namespace kidnapwatch::api {
namespace {

class IncidentsTest : public ApiTest {
 protected:
  IncidentsTest() {
    for (int i = 9; i >= 0; --i) {  // newest first
      core::Incident one;
      one.id = "0190-" + std::to_string(i);
      one.robot = i % 2 == 0 ? "even" : "odd";
      one.state = i < 5 ? core::IncidentState::resolved : core::IncidentState::open;
      one.kind = i == 7 ? core::IncidentKind::carry : core::IncidentKind::teleport;
      one.opened_at = at_s(i);
      history.all_incidents.push_back(one);
    }
  }

  static std::string ids_on(const Json& page) {
    std::string result;
    for (const auto& one : page["incidents"]) {
      result += one["id"].get<std::string>().back();
    }
    return result;
  }

  std::string ids(const std::string& query) {
    return ids_on(body(get("/api/v1/incidents" + query)));
  }

  std::string refused_field(const std::string& query) {
    const auto response = get("/api/v1/incidents?" + query);
    EXPECT_EQ(response.status, 400) << query;
    return body(response).value("field", "none");
  }
};

TEST_F(IncidentsTest, AreListedNewestFirst) { EXPECT_EQ(ids(""), "9876543210"); }

TEST_F(IncidentsTest, AreFilteredByAllThatIsAsked) {
  EXPECT_EQ(ids("?robot=odd"), "97531");
  EXPECT_EQ(ids("?state=resolved"), "43210");
  EXPECT_EQ(ids("?kind=carry"), "7");
  EXPECT_EQ(ids("?from=1970-01-01T00:00:03Z&to=1970-01-01T00:00:05Z"), "43");
  EXPECT_EQ(ids("?robot=even&state=open&kind=teleport&from=1970-01-01T00:00:07Z"), "8");
  EXPECT_EQ(ids("?robot=nobody"), "");
}

TEST_F(IncidentsTest, ComeAsCsvIfWanted) {
  const auto response = get("/api/v1/incidents?limit=2", {{"Accept", "text/csv"}});
  EXPECT_EQ(response.content_type, "text/csv; charset=utf-8; header=present");
  EXPECT_NE(response.body.find("\r\n0190-8,even,"), std::string::npos);
  EXPECT_EQ(response.body.find("0190-7"), std::string::npos);
  EXPECT_EQ(header_of(response, "Vary"), "Accept");
  EXPECT_NE(header_of(response, "Link").find("cursor=0190-8"), std::string::npos);
}

TEST_F(IncidentsTest, AreFilteredByLabel) {
  history.all_incidents[2].label = core::IncidentLabel::false_alarm;
  EXPECT_EQ(ids("?label=false_alarm"), "7");
  EXPECT_EQ(refused_field("label=ghost"), "label");
}

TEST_F(IncidentsTest, AreChangedInTheCallersName) {
  fleet.changed = history.all_incidents[0];
  fleet.changed->acknowledged_by = "ann";
  const auto response = post("/api/v1/incidents/0190-9/ack", R"({"comment":"on my way"})");
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(body(response)["acknowledgedBy"], "ann");
  ASSERT_EQ(fleet.commands.size(), 1U);
  EXPECT_EQ(fleet.commands[0].first, "0190-9");
  EXPECT_EQ(fleet.commands[0].second.action, core::IncidentAction::ack);
  EXPECT_EQ(fleet.commands[0].second.comment, "on my way");
  EXPECT_FALSE(fleet.commands[0].second.author.empty());
  EXPECT_EQ(post("/api/v1/incidents/0190-9/resolve", "").status, 200);  // no body is no comment
}

TEST_F(IncidentsTest, AreNotChangedWhereThatMakesNoSense) {
  EXPECT_EQ(post("/api/v1/incidents/none/ack", "{}").status, 404);
  EXPECT_EQ(body(post("/api/v1/incidents/0190-9/shelve", "{}"))["field"], "seconds");
  EXPECT_EQ(body(post("/api/v1/incidents/0190-9/label", R"({"label":1})"))["field"], "label");
  EXPECT_EQ(post("/api/v1/incidents/0190-9/ack", "{").status, 400);
  EXPECT_TRUE(fleet.commands.empty());
  EXPECT_EQ(post("/api/v1/incidents/0190-1/ack", "{}").status, 409);  // is resolved
  fleet.busy = true;
  EXPECT_EQ(post("/api/v1/incidents/0190-9/ack", "{}").status, 503);
}

TEST_F(IncidentsTest, ArePagedByACursorThatKeepsTheFilter) {
  std::string next = "/api/v1/incidents?robot=odd&limit=2";
  std::string pages;
  while (!next.empty()) {
    const auto response = get(next);
    const auto page = body(response);
    pages += ids_on(page) + "|";
    next = page.value("next", "");
    EXPECT_EQ(header_of(response, "Link"), next.empty() ? "" : "<" + next + ">; rel=\"next\"");
  }
  EXPECT_EQ(pages, "97|53|1|");
}

TEST_F(IncidentsTest, HaveNoNextPageAfterAFullLastOne) {
  EXPECT_FALSE(body(get("/api/v1/incidents?limit=10")).contains("next"));
  EXPECT_TRUE(body(get("/api/v1/incidents?limit=9")).contains("next"));
}

TEST_F(IncidentsTest, RefuseAFilterThatIsNone) {
  EXPECT_EQ(refused_field("state=closed"), "state");
  EXPECT_EQ(refused_field("kind=abduction"), "kind");
  EXPECT_EQ(refused_field("from=1"), "from");
  EXPECT_EQ(refused_field("limit=1001"), "limit");
  EXPECT_EQ(refused_field("cursor="), "cursor");
  EXPECT_EQ(refused_field("cursor='%20OR%201=1"), "cursor");
}

TEST_F(IncidentsTest, AreFoundById) {
  EXPECT_EQ(body(get("/api/v1/incidents/0190-3"))["id"], "0190-3");
  EXPECT_EQ(get("/api/v1/incidents/0191").status, 404);
}

TEST_F(IncidentsTest, ShowWhatTheyWereConcludedFrom) {
  core::Evidence evidence;
  evidence.scans.before.ranges_m = {1.0F};
  evidence.scans.after.ranges_m = {2.0F};
  evidence.scores.resize(3);
  history.all_evidence.emplace_back("0190-3", evidence);
  const auto shown = body(get("/api/v1/incidents/0190-3/evidence"));
  EXPECT_EQ(shown["before"]["ranges"], Json::array({1.0}));
  EXPECT_EQ(shown["after"]["ranges"], Json::array({2.0}));
  EXPECT_EQ(shown["scores"].size(), 3U);
  EXPECT_EQ(get("/api/v1/incidents/0190-4/evidence").status, 404);
}

TEST_F(IncidentsTest, ShowWhatTheDetectorsSawWhereBothScansCanBeCompared) {
  core::Evidence evidence;
  evidence.scans.before.geometry = {0.0, 0.1, 0.1, 10.0};
  evidence.scans.before.ranges_m.assign(60, 2.0F);
  evidence.scans.after = evidence.scans.before;
  history.all_evidence.emplace_back("0190-3", evidence);
  const auto shown = body(get("/api/v1/incidents/0190-3/evidence"));
  EXPECT_EQ(shown["warping"]["steps"].size(), 60U);
  EXPECT_EQ(shown["warping"]["cost"], 0.0);
  EXPECT_TRUE(shown["motion"]["violating"]["before"].empty());
}

TEST_F(IncidentsTest, TellWhoDidWhat) {
  history.all_alerts = {
      {1, "odd", R"({"incidentId":"0190-3","type":"opened","author":"kidnapwatch","seq":1})"},
      {2, "odd", R"({"incidentId":"0190-1","type":"opened","author":"kidnapwatch","seq":1})"},
      {3, "odd", R"({"incidentId":"0190-3","type":"acknowledged","author":"ada","seq":2})"}};
  const auto shown = body(get("/api/v1/incidents/0190-3/history"))["history"];
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(shown[1], (Json{{"author", "ada"}, {"action", "acknowledged"}, {"seq", 2}}));
  EXPECT_EQ(get("/api/v1/incidents/0191/history").status, 404);
}

}  // namespace
}  // namespace kidnapwatch::api
