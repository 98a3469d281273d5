// SPDX-License-Identifier: Apache-2.0
// A client that follows the events through its own and the service's interruptions.
#include <csignal>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/e2e/stack.hpp"

namespace kidnapwatch::test {
namespace {

struct Heard {
  long id = 0;
  std::string type = {};
  Json alert = {};
};

/// A reader of Server-Sent Events: curl, which comes back with the last id that it saw.
class Follower {
 public:
  explicit Follower(const Stack& stack) : stack_(stack) { connect(); }

  void connect() {
    const std::string file = "events-" + std::to_string(++connections_);
    curl_ = std::make_unique<Process>(
        std::vector<std::string>{
            "curl", "-sN", "-H", "Last-Event-ID: " + std::to_string(last_id()),
            "http://127.0.0.1:" + std::to_string(stack_.http_port()) + "/api/v1/events"},
        folder_.path() / file, folder_.path() / "curl.log");
  }
  void disconnect() { curl_.reset(); }
  void await_end() { (void)curl_->wait(); }

  /// Whole events of all connections, in order.
  [[nodiscard]] std::vector<Heard> alerts() const {
    std::vector<Heard> all;
    for (int i = 1; i <= connections_; ++i) {
      std::istringstream lines(content_of(folder_.path() / ("events-" + std::to_string(i))));
      Heard next;
      for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("id: ")) next.id = std::stol(line.substr(4));
        if (line.starts_with("event: ")) next.type = line.substr(7);
        if (line.starts_with("data: ")) next.alert = Json::parse(line.substr(6), nullptr, false);
        if (line.empty() && next.type == "alert") all.push_back(next);
        if (line.empty()) next = {};
      }
    }
    return all;
  }

 private:
  [[nodiscard]] long last_id() const {
    const auto all = alerts();
    return all.empty() ? 0 : all.back().id;
  }

  const Stack& stack_;
  TemporaryFolder folder_;
  int connections_ = 0;
  std::unique_ptr<Process> curl_;
};

TEST(Events, AreHeardInOrderAndOnceThroughInterruptions) {
  Stack stack;
  stack.start_service();
  stack.await_ready();
  Follower follower(stack);
  const auto robots =
      stack.robots_in_background({"simulate", "--robots", "4", "--rate", "5", "--duration", "36000",
                                  "--kidnap-every", "15", "--speed", "10"});
  const auto heard_more = [&](std::size_t than) {
    return eventually([&] { return follower.alerts().size() > than; });
  };
  for (int i = 0; i < 4; ++i) {
    const auto before = follower.alerts().size();
    ASSERT_TRUE(heard_more(before));
    if (i % 2 == 0) {
      follower.disconnect();
      const auto missed = stack.get("/api/v1/incidents").at("incidents").size();
      EXPECT_TRUE(eventually(
          [&] { return stack.get("/api/v1/incidents").at("incidents").size() > missed; }));
    } else {
      stack.service->signal(SIGKILL);
      (void)stack.service->wait();
      follower.await_end();
      stack.start_service();
      stack.await_ready();
    }
    follower.connect();
  }
  robots->signal(SIGTERM);
  (void)robots->wait();

  const auto incidents = stack.get("/api/v1/incidents?limit=1000").at("incidents");
  std::size_t changes = 0;
  for (const auto& incident : incidents) changes += incident.at("seq").get<std::size_t>();
  EXPECT_TRUE(eventually([&] { return follower.alerts().size() >= changes; }));
  std::map<std::string, int> seqs;
  long last = 0;
  for (const auto& [id, type, alert] : follower.alerts()) {
    EXPECT_GT(id, last);
    last = id;
    EXPECT_EQ(alert.at("seq"), ++seqs[alert.at("incidentId").get<std::string>()]) << alert;
  }
  for (const auto& incident : incidents) {
    EXPECT_EQ(seqs[incident.at("id").get<std::string>()], incident.at("seq")) << incident;
  }
}

}  // namespace
}  // namespace kidnapwatch::test
