// SPDX-License-Identifier: Apache-2.0
// Robots and their scores over REST.
#include "api/robots.hpp"

#include "memory_ports.hpp"

namespace kidnapwatch::api {
namespace {

class RobotsTest : public ApiTest {
 protected:
  RobotsTest() {
    for (const char* id : {"r1", "r2"}) {
      fleet.robots_now.emplace_back().id = id;
    }
    for (int second = 0; second < 5; ++second) {
      core::Score score;
      score.stamp = at_s(second);
      score.dissimilarity.cost = second;
      history.all_scores.emplace_back("r1", score);
      history.all_scores.emplace_back("gone", score);
    }
  }

  std::vector<double> scores(const std::string& target) {
    std::vector<double> costs;
    const auto page = body(get(target));
    for (const auto& score : page["scores"]) {
      costs.push_back(score["score"]);
    }
    return costs;
  }
};

TEST_F(RobotsTest, AreListedInTheFleetsOrder) {
  const auto robots = body(get("/api/v1/robots"))["robots"];
  ASSERT_EQ(robots.size(), 2U);
  EXPECT_EQ(robots[0]["id"], "r1");
  EXPECT_EQ(robots[1]["id"], "r2");
}

TEST_F(RobotsTest, AreAnEmptyListBeforeTheFirstOneCame) {
  fleet.robots_now.clear();
  EXPECT_EQ(get("/api/v1/robots").body, R"({"robots":[]})");
}

TEST_F(RobotsTest, AreFoundById) {
  EXPECT_EQ(body(get("/api/v1/robots/r2"))["id"], "r2");
  EXPECT_EQ(body(get("/api/v1/robots/%72%32"))["id"], "r2");
  EXPECT_EQ(get("/api/v1/robots/r3").status, 404);
}

TEST_F(RobotsTest, TellTheirScoresOldestFirst) {
  EXPECT_EQ(scores("/api/v1/robots/r1/scores"), (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(scores("/api/v1/robots/r2/scores"), std::vector<double>{});
}

TEST_F(RobotsTest, TellScoresOfATimeRange) {
  EXPECT_EQ(scores("/api/v1/robots/r1/scores?from=1970-01-01T00:00:01Z&to=1970-01-01T00:00:03Z"),
            (std::vector<double>{1, 2}));
  EXPECT_EQ(scores("/api/v1/robots/r1/scores?from=1970-01-01T02:00:04+02:00"),
            std::vector<double>{4});
}

TEST_F(RobotsTest, TellScoresPageByPage) {
  std::string next = "/api/v1/robots/r1/scores?limit=2&to=1970-01-01T00:00:04.5Z";
  std::vector<std::vector<double>> pages;
  while (!next.empty()) {
    pages.push_back(scores(next));
    next = body(get(next)).value("next", "");
  }
  EXPECT_EQ(pages, (std::vector<std::vector<double>>{{0, 1}, {2, 3}, {4}}));
}

TEST_F(RobotsTest, TellScoresOfARobotThatOnlyHistoryKnows) {
  EXPECT_EQ(scores("/api/v1/robots/gone/scores").size(), 5U);
  EXPECT_EQ(get("/api/v1/robots/never/scores").status, 404);
}

TEST_F(RobotsTest, TellScoresAsCsvToWhomPrefersIt) {
  const auto response = get("/api/v1/robots/r1/scores?limit=1", {{"Accept", "text/csv"}});
  EXPECT_EQ(response.content_type, "text/csv; charset=utf-8; header=present");
  EXPECT_EQ(response.body,
            "time,referenceTime,score,scorePerBeam,standardized,threshold,state\r\n"
            "1970-01-01T00:00:00.000000000Z,1970-01-01T00:00:00.000000000Z,0,0,false,,unknown\r\n");
  EXPECT_EQ(header_of(response, "Vary"), "Accept");
  EXPECT_EQ(header_of(response, "Link"),
            "</api/v1/robots/r1/scores?from=1970-01-01T00:00:01.000000000Z&limit=1>; rel=\"next\"");
}

TEST_F(RobotsTest, TellScoresByTheMinute) {
  const Json body_ = body(get("/api/v1/robots/r1/scores?resolution=2"));
  ASSERT_EQ(body_.at("buckets").size(), 3U);
  EXPECT_EQ(body_.at("buckets").at(1).dump(),
            R"({"time":"1970-01-01T00:00:02.000000000Z","seconds":2,"scores":2,)"
            R"("score":{"min":2.0,"max":3.0,"mean":2.5},)"
            R"("scorePerBeam":{"min":0.0,"max":0.0,"mean":0.0},"state":"unknown"})");
  const auto page = get("/api/v1/robots/r1/scores?resolution=2&limit=2");
  EXPECT_EQ(body(page).at("buckets").size(), 2U);
  EXPECT_EQ(body(page).at("next"),
            "/api/v1/robots/r1/scores?from=1970-01-01T00:00:04.000000000Z&limit=2&resolution=2");
  EXPECT_EQ(get("/api/v1/robots/never/scores?resolution=2").status, 404);
}

TEST_F(RobotsTest, TellWhichBucketsAreCoarserThanAskedFor) {
  EXPECT_EQ(body(get("/api/v1/robots/r1/scores?resolution=2")).at("resolution"), 2);
  core::ScoreBucket minute{.from = core::Stamp(std::chrono::minutes(-1)),
                           .width = std::chrono::minutes(1)};
  minute.add(history.all_scores.front().second);
  history.rolled_up = {minute};
  const Json body_ = body(get("/api/v1/robots/r1/scores?resolution=2&limit=2"));
  EXPECT_EQ(body_.at("resolution"), 60);
  EXPECT_EQ(body_.at("buckets").at(0).at("seconds"), 60);
  EXPECT_EQ(body_.at("buckets").at(1).at("seconds"), 2);
  EXPECT_FALSE(body(get("/api/v1/robots/r1/scores")).contains("resolution"));
}

TEST_F(RobotsTest, TellBucketsAsCsvToWhomPrefersIt) {
  const auto response = get("/api/v1/robots/r1/scores?resolution=60", {{"Accept", "text/csv"}});
  EXPECT_EQ(response.content_type, "text/csv; charset=utf-8; header=present");
  EXPECT_EQ(response.body,
            "time,seconds,scores,scoreMin,scoreMax,scoreMean,scorePerBeamMin,scorePerBeamMax,"
            "scorePerBeamMean,motionMin,motionMax,motionMean,motionConfirmedMin,"
            "motionConfirmedMax,motionConfirmedMean,carryMin,carryMax,carryMean,threshold,"
            "motionThreshold,state\r\n"
            "1970-01-01T00:00:00.000000000Z,60,5,0,4,2,0,0,0,,,,,,,,,,,,unknown\r\n");
}

TEST_F(RobotsTest, RefuseAResolutionThatIsNone) {
  for (const char* resolution : {"", "0", "-1", "1.5", "1m", "86401", "99999999999"}) {
    const auto response = get(std::string("/api/v1/robots/r1/scores?resolution=") + resolution);
    EXPECT_EQ(response.status, 400) << resolution;
    EXPECT_EQ(body(response).value("field", "none"), "resolution");
  }
}

TEST_F(RobotsTest, RefuseARangeThatIsNone) {
  const auto field = [&](const std::string& query) {
    const auto response = get("/api/v1/robots/r1/scores?" + query);
    EXPECT_EQ(response.status, 400) << query;
    return body(response).value("field", "none");
  };
  EXPECT_EQ(field("from=yesterday"), "from");
  EXPECT_EQ(field("from="), "from");
  EXPECT_EQ(field("to=0"), "to");
  EXPECT_EQ(field("from=2026-01-02T00:00:00Z&to=2026-01-01T00:00:00Z"), "to");
  for (const char* limit : {"", "0", "-1", "1001", "ten", "1e2", "5 ", "99999999999999999999"}) {
    EXPECT_EQ(field(std::string("limit=") + limit), "limit");
  }
}

TEST_F(RobotsTest, ShowTheirLastScans) {
  fleet.scans_now.resize(2);
  fleet.scans_now[1].ranges_m = {2.0F};
  EXPECT_EQ(body(get("/api/v1/robots/r1/scans"))["after"]["ranges"], Json::array({2.0}));
  fleet.scans_now.clear();
  EXPECT_EQ(get("/api/v1/robots/r1/scans").body, "{}");
  fleet.busy = true;
  EXPECT_EQ(get("/api/v1/robots/r1/scans").status, 503);
  EXPECT_EQ(get("/api/v1/robots/nobody/scans").status, 404);
}

}  // namespace
}  // namespace kidnapwatch::api
