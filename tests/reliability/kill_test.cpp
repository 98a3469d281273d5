// SPDX-License-Identifier: Apache-2.0
// kill -9 at any step: what was stored is whole, all of it is delivered, and what is lost is told.
#include <algorithm>
#include <random>
#include <thread>

#include "storage/archive.hpp"
#include "tests/reliability/promise.hpp"
#include "tests/reliability/scale.hpp"

namespace kidnapwatch::test {
namespace {

class Kill : public Promise {
 protected:
  /// 500 scans a second, each robot kidnapped every 2.5 s.
  void drive() {
    robots_ = stack_.robots_in_background({"simulate", "--robots", "10", "--rate", "5", "--speed",
                                           "10", "--duration", "36000", "--kidnap-every", "25",
                                           "--beams", "90"});
  }
  [[nodiscard]] std::int64_t stored_scores() const {
    const storage::Archive archive(stack_.database());
    std::size_t scores = 0;
    for (const auto& robot : rows("SELECT name FROM robot")) {
      scores += archive.scores(robot, core::Stamp::min(), core::Stamp::max(), 10'000'000).size();
    }
    return static_cast<std::int64_t>(scores);
  }

  std::unique_ptr<Process> robots_;
};

TEST_F(Kill, IncidentAlertAndAuditStayOneAndAllIsDelivered) {
  const int kills = at_scale(5, 200);
  std::mt19937 chance(1);
  std::uniform_int_distribution<int> pause_ms(0, 700);
  stack_.subscribe("kidnapwatch/v1/+/alert");
  start_service();
  drive();
  ASSERT_TRUE(eventually([&] { return number("SELECT count(*) FROM incident") > 0; },
                         std::chrono::seconds(60)));
  for (int kill = 0; kill < kills; ++kill) {
    std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms(chance)));  // any step
    kill_service();
    ASSERT_EQ(number("SELECT count(*) FROM pragma_integrity_check WHERE integrity_check = 'ok'"),
              1);
    ASSERT_EQ(number("SELECT sum(seq) FROM incident"),
              number("SELECT count(*) FROM audit WHERE action LIKE 'incident.%'"));
    start_service();
  }
  robots_->signal(SIGTERM);
  (void)robots_->wait();
  EXPECT_TRUE(eventually([&] { return all_delivered(); }));
  const auto arrived = received("incidentId");
  int missing = 0;
  const auto incidents = rows("SELECT id FROM incident");
  for (const auto& id : incidents) missing += arrived.contains(id) ? 0 : 1;
  EXPECT_EQ(missing, 0);
  report(std::to_string(kills) + " kills, " + std::to_string(incidents.size()) +
         " incidents with " + std::to_string(number("SELECT sum(seq) FROM incident")) +
         " changes, " + std::to_string(missing) + " of them not received; " +
         std::to_string(arrived.size() - incidents.size()) + " received but not stored");
}

TEST_F(Kill, AtMostOneCommitWindowOfScoresIsLostAndTheGapIsTold) {
  const int kills = at_scale(2, 20);
  start_service();
  drive();
  std::int64_t most_lost = 0;
  std::int64_t stored_before = 0;
  for (int kill = 0; kill < kills; ++kill) {
    const auto known = [&] { return stack_.counted("scored"); };
    ASSERT_TRUE(eventually([&] { return known() > 400; }));
    const auto scored = static_cast<std::int64_t>(known());
    kill_service();
    const auto stored = stored_scores();
    most_lost = std::max(most_lost, scored - (stored - stored_before));
    stored_before = stored;
    start_service();
    EXPECT_TRUE(eventually([&] { return number("SELECT count(*) FROM gap") == kill + 1; }));
  }
  EXPECT_LE(most_lost, 100);  // 200 ms: a window of 50 ms, a commit, and a slow machine
  EXPECT_EQ(number("SELECT count(*) FROM gap WHERE reason = 'crash' AND until > since"), kills);
  report(std::to_string(kills) + " kills at 500 scans/s: at most " + std::to_string(most_lost) +
         " scores lost; a gap for each");
}

}  // namespace
}  // namespace kidnapwatch::test
