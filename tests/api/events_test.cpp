// SPDX-License-Identifier: Apache-2.0
// Server-Sent Events: nothing left out, nothing repeated, nothing shown to whom it does not
// concern.
#include "api/events.hpp"

#include "memory_ports.hpp"

namespace kidnapwatch::api {
namespace {

class EventsTest : public ApiTest {
 protected:
  EventsTest() {
    for (int i = 1; i <= 3; ++i) tell(i, i % 2 == 0 ? "even" : "odd");
  }

  void tell(std::int64_t number, const std::string& robot) {
    history.all_alerts.push_back({number, robot, R"({"seq":)" + std::to_string(number) + "}"});
  }

  std::shared_ptr<Feed> follow(const std::string& last_id, const std::string& query = "") {
    std::vector<Header> headers;
    if (!last_id.empty()) headers.push_back({"Last-Event-ID", last_id});
    const auto response = get("/api/v1/events" + query, std::move(headers));
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.content_type, "text/event-stream");
    return response.feed;
  }

  /// Of a feed that has not been asked yet.
  static std::string beginning(Feed& feed) { return feed.next().value_or("ended"); }

  static std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
  }

  void add_robot(const std::string& id, core::RobotState state = core::RobotState::normal) {
    core::RobotStatus robot;
    robot.id = id;
    robot.state = state;
    fleet.robots_now.push_back(robot);
  }
};

TEST_F(EventsTest, BeginNowUnlessTheClientHasSeenSome) {
  const auto feed = follow("");
  EXPECT_EQ(beginning(*feed), "retry: 1000\n\nid: 3\nevent: robots\ndata: {\"robots\":[]}\n\n");
  EXPECT_EQ(feed->next(), "");
  tell(4, "even");
  EXPECT_EQ(feed->next(), "id: 4\nevent: alert\ndata: {\"seq\":4}\n\n");
  EXPECT_EQ(feed->next(), "");
}

TEST_F(EventsTest, GoOnAfterTheLastOneThatWasSeen) {
  const auto text = beginning(*follow("1"));
  EXPECT_EQ(count(text, "event: alert"), 2U);
  EXPECT_LT(text.find("id: 2\n"), text.find("id: 3\n"));
  EXPECT_EQ(text.find("event: gap"), std::string::npos);
}

TEST_F(EventsTest, ThatAreManyComeInParts) {
  for (int i = 4; i <= 250; ++i) tell(i, "odd");
  const auto feed = follow("0");
  EXPECT_EQ(count(beginning(*feed), "event: alert"), 100U);
  EXPECT_EQ(count(*feed->next(), "event: alert"), 100U);
  EXPECT_EQ(count(*feed->next(), "event: alert"), 50U);
}

TEST_F(EventsTest, ThatAreGoneAreTold) {
  history.all_alerts.erase(history.all_alerts.begin(), history.all_alerts.begin() + 2);
  EXPECT_NE(beginning(*follow("1")).find("event: gap\ndata: {\"since\":1}"), std::string::npos);
  EXPECT_EQ(beginning(*follow("2")).find("event: gap"), std::string::npos);
  EXPECT_NE(beginning(*follow("9")).find("id: 3\nevent: gap"), std::string::npos);  // another store
  history.all_alerts.clear();
  history.last_alert = 3;
  EXPECT_EQ(beginning(*follow("3")).find("event: gap"), std::string::npos);
  EXPECT_NE(beginning(*follow("2")).find("event: gap"), std::string::npos);
}

TEST_F(EventsTest, AreThoseOfOneRobotIfWanted) {
  add_robot("even");
  add_robot("odd");
  const auto text = beginning(*follow("0", "?robot=even"));
  EXPECT_EQ(count(text, "event: alert"), 1U);
  EXPECT_NE(text.find("id: 2\nevent: alert"), std::string::npos);
  EXPECT_NE(text.find("id: 3\nevent: robots"), std::string::npos);  // alert 3 is no concern of it
  EXPECT_EQ(text.find(R"("id":"odd")"), std::string::npos);
}

TEST_F(EventsTest, TellOfRobotsThatChangedOnceASecond) {
  add_robot("r1");
  add_robot("r2");
  const auto feed = follow("");
  EXPECT_EQ(count(beginning(*feed), R"("id":"r)"), 2U);
  fleet.robots_now[1].state = core::RobotState::suspect;
  now_s = 0.9;
  EXPECT_EQ(feed->next(), "");
  now_s = 1.0;
  const auto text = feed->next();
  EXPECT_EQ(count(*text, R"("id":"r)"), 1U);
  EXPECT_NE(text->find(R"("state":"suspect")"), std::string::npos);
  now_s = 2.0;
  EXPECT_EQ(feed->next(), "");
}

TEST_F(EventsTest, GiveASignOfLife) {
  const auto feed = follow("");
  (void)beginning(*feed);
  now_s = 14.0;
  EXPECT_EQ(feed->next(), "");
  now_s = 15.0;
  EXPECT_EQ(feed->next(), ":\n\n");
  now_s = 16.0;
  EXPECT_EQ(feed->next(), "");
}

TEST_F(EventsTest, WhatIsNoIdIsRefused) {
  for (const auto* id : {"x", "-1", "1x", "99999999999999999999"}) {
    const auto response = get("/api/v1/events", {{"Last-Event-ID", id}});
    EXPECT_EQ(response.status, 400);
    EXPECT_EQ(body(response)["field"], "Last-Event-ID");
  }
}

class TokenEventsTest : public EventsTest {
 protected:
  TokenEventsTest() {
    guard = std::make_unique<Guard>(
        [this](std::string_view secret) {
          return secret == "s" ? caller : std::optional<Caller>();
        },
        RateLimitConfig{.per_s = 0.0}, [] { return 0.0; });
    add_robot("even");
    add_robot("odd");
  }

  Response ask(const std::string& query = "") {
    return get("/api/v1/events" + query, {{"Authorization", "Bearer s"}, {"Last-Event-ID", "0"}});
  }

  std::optional<Caller> caller = Caller{.name = "t", .role = Role::viewer, .robots = {"even"}};
};

TEST_F(TokenEventsTest, ShowNothingOfRobotsThatTheTokenIsNotFor) {
  const auto text = beginning(*ask().feed);
  EXPECT_EQ(count(text, "event: alert"), 1U);
  EXPECT_EQ(text.find("odd"), std::string::npos);
  EXPECT_EQ(ask("?robot=odd").status, 404);
}

TEST_F(TokenEventsTest, EndWhenTheTokenIsRevoked) {
  const auto feed = ask().feed;
  (void)beginning(*feed);
  tell(4, "even");
  EXPECT_NE(feed->next(), "");
  caller.reset();
  tell(6, "even");
  EXPECT_EQ(feed->next(), std::nullopt);
}

TEST_F(TokenEventsTest, EndWithinASecondWhereNothingIsToBeTold) {
  const auto feed = ask().feed;
  (void)beginning(*feed);
  caller.reset();
  now_s = 0.9;
  EXPECT_EQ(feed->next(), "");
  now_s = 1.0;
  EXPECT_EQ(feed->next(), std::nullopt);
}

TEST_F(TokenEventsTest, EndWhenTheTokenMeansSomethingElse) {
  const auto feed = ask().feed;
  (void)beginning(*feed);
  caller->robots = {"odd"};
  tell(4, "even");
  EXPECT_EQ(feed->next(), std::nullopt);
}

}  // namespace
}  // namespace kidnapwatch::api
