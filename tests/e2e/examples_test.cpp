// SPDX-License-Identifier: Apache-2.0
// deploy/examples and deploy/grafana, as their users run them.
#include <fstream>
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "tests/e2e/packages.hpp"
#include "tests/e2e/stack.hpp"
#include "tests/e2e/tls_broker.hpp"

namespace kidnapwatch::test {
namespace {

const std::string kExamples = KW_DEPLOY "/examples/";

/// A pipe with a name, from which a program of the test reads.
std::string pipe_in(const TemporaryFolder& folder) {
  auto name = (folder.path() / "pipe").string();
  (void)output_of({"mkfifo", name});
  return name;
}

std::size_t count_of(const std::string& word, const std::string& text) {
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(Examples, AControllerStopsItsRobotAndSaysWhenItKnowsItsPlace) {
  if (!has_paho()) GTEST_SKIP() << "python3-paho-mqtt is not installed";
  const TlsBroker broker({"sim-0001"});
  Stack stack;
  stack.broker_url = broker.service_url();
  stack.start_service(broker.service_flags());
  stack.await_ready();
  const TemporaryFolder folder;
  const auto input = pipe_in(folder);
  const auto out = folder.path() / "out";
  Process controller(
      {"sh", "-c",
       "exec " + kExamples + "controller.py --robot sim-0001 --port " +
           std::to_string(broker.robots_port) + " --ca " + broker.file("operators-ca.crt") +
           " --cert " + broker.file("sim-0001.crt") + " --key " + broker.file("sim-0001.key") +
           " < " + input},
      out, folder.path() / "log");
  const auto says = [&](const std::string& what) {
    return eventually([&] { return content_of(out).find(what) != std::string::npos; });
  };
  std::ofstream localization(input);
  ASSERT_TRUE(says("listening")) << content_of(folder.path() / "log");
  (void)output_of({KW_PROGRAM, "simulate", "--robots", "1", "--rate", "5", "--duration", "30",
                   "--kidnap-every", "25", "--speed", "10", "--broker", broker.plain_url()});
  ASSERT_TRUE(says("STOP: ")) << content_of(out);
  EXPECT_TRUE(says("state kidnapped"));
  localization << "here I am\n" << std::flush;
  EXPECT_TRUE(says("relocalized: done")) << content_of(out);
  EXPECT_TRUE(says("GO: resolved by robot:sim-0001"));
  localization << "and again\n" << std::flush;
  EXPECT_TRUE(says("relocalized: no_incident no incident of this robot is open"));
  EXPECT_EQ(count_of("STOP", content_of(out)), 1U) << content_of(out);
  localization << "quit\n" << std::flush;
  EXPECT_EQ(controller.wait(), 0) << content_of(folder.path() / "log");
}

/// A service, a robot, an open incident.
class ExamplesWithIncidents : public ::testing::Test {
 protected:
  void SetUp() override {
    stack_.subscribe("kidnapwatch/v1/+/alert");
    stack_.start_service();
    stack_.await_ready();
    (void)stack_.robots({"simulate", "--robots", "1", "--rate", "5", "--duration", "30",
                         "--kidnap-every", "25", "--speed", "10"});
    ASSERT_TRUE(
        eventually([&] { return stack_.get("/api/v1/incidents").at("incidents").size() == 1; }));
  }
  [[nodiscard]] std::string url() const {
    return "http://127.0.0.1:" + std::to_string(stack_.http_port());
  }

  Stack stack_;
};

TEST_F(ExamplesWithIncidents, TheQueriesOfADashboardAreAnswered) {
  const auto said = output_of({kExamples + "dashboard-queries.sh", url()});
  for (const char* wanted :
       {R"({"status":"ready","reasons":[]})", "\nsim-0001\t",
        R"({"before":360,"after":360,"scores":)", "\tkidnapwatch\topened\t",
        "\ntime,seconds,scores,scoreMin,", R"("origins":{)", R"({"scored":)"}) {
    EXPECT_NE(said.find(wanted), std::string::npos) << wanted << " is not in\n" << said;
  }
  EXPECT_NE(said.find("1 sim-0001\topen\n"), std::string::npos) << said;
}

class Alertmanager : public ExamplesWithIncidents {
 protected:
  void SetUp() override {
    if (!has_program("prometheus-alertmanager")) {
      GTEST_SKIP() << "prometheus-alertmanager is not installed";
    }
    ExamplesWithIncidents::SetUp();
    std::ofstream(folder_.path() / "config.yml") << "route: {receiver: nobody}\n"
                                                    "receivers: [{name: nobody}]\n";
    const std::string address = "127.0.0.1:" + std::to_string(free_port());
    at_ = "http://" + address;
    alertmanager_ = std::make_unique<Process>(
        std::vector<std::string>{"prometheus-alertmanager",
                                 "--config.file=" + (folder_.path() / "config.yml").string(),
                                 "--storage.path=" + (folder_.path() / "data").string(),
                                 "--web.listen-address=" + address, "--cluster.listen-address="},
        folder_.path() / "am.out", folder_.path() / "am.log");
    const auto input = pipe_in(folder_);
    pusher_ = std::make_unique<Process>(
        std::vector<std::string>{
            "sh", "-c",
            "exec " + kExamples + "alertmanager-push " + at_ + " --link " + url() + " < " + input},
        folder_.path() / "push.out", folder_.path() / "push.log");
    pipe_.open(input);
  }

  /// Passes on what mosquitto_sub has printed since the last call.
  void pass_on() {
    const auto all = stack_.received();
    for (; passed_on_ < all.size(); ++passed_on_) {
      if (all[passed_on_].payload != "ping") pipe_ << all[passed_on_].payload << "\n";
    }
    pipe_.flush();
  }
  /// The firing ones, by severity.
  [[nodiscard]] std::multiset<std::string> firing() const {
    std::multiset<std::string> severities;
    for (const auto& one : alerts()) severities.insert(one.at("labels").at("severity"));
    return severities;
  }
  [[nodiscard]] Json alerts() const {
    const auto text = output_of({"sh", "-c", "curl -s " + at_ + "/api/v2/alerts || echo '[]'"});
    return Json::parse(text);
  }
  [[nodiscard]] bool comes_to(const std::multiset<std::string>& severities) {
    return eventually([&] {
      pass_on();
      return firing() == severities;
    });
  }

  TemporaryFolder folder_;
  std::string at_;
  std::unique_ptr<Process> alertmanager_;
  std::unique_ptr<Process> pusher_;
  std::ofstream pipe_;
  std::size_t passed_on_ = 0;
};

TEST_F(Alertmanager, IsToldOfIncidentsUntilTheyAreResolved) {
  ASSERT_TRUE(comes_to({"critical"})) << content_of(folder_.path() / "push.log");
  const auto incident = stack_.get("/api/v1/incidents").at("incidents").at(0);
  const auto path = "/api/v1/incidents/" + incident.at("id").get<std::string>();
  for (const auto& one : alerts()) {
    if (one.at("labels").at("incident") != incident.at("id")) continue;
    EXPECT_EQ(one.at("labels").at("robot"), incident.at("robotId"));
    EXPECT_EQ(one.at("startsAt").get<std::string>().substr(0, 19),
              incident.at("openedAt").get<std::string>().substr(0, 19));
    EXPECT_EQ(one.at("generatorURL"), url() + path);
    EXPECT_NE(one.at("annotations").at("summary").get<std::string>().find(": "), std::string::npos);
  }
  (void)stack_.post(path + "/shelve", R"({"seconds":600})");
  EXPECT_TRUE(comes_to({"info"})) << alerts().dump(1);
  (void)stack_.post(path + "/resolve", "{}");
  EXPECT_TRUE(comes_to({})) << alerts().dump(1);
  pipe_.close();
  EXPECT_EQ(pusher_->wait(), 0);
}

TEST(Grafana, AsksForMetricsThatThereAre) {
  Stack stack;
  stack.start_service();
  stack.await_ready();
  const std::string metrics = stack.get_text("/metrics");
  const auto dashboard = Json::parse(content_of(KW_DEPLOY "/grafana/kidnapwatch.json"));
  std::set<std::string> asked;
  const std::regex name("kidnapwatch_[a-z_]+");
  for (const auto& panel : dashboard.at("panels")) {
    for (const auto& target : panel.at("targets")) {
      const auto query = target.at("expr").get<std::string>();
      for (std::sregex_iterator found(query.begin(), query.end(), name), end; found != end; ++found)
        asked.insert(found->str());
    }
  }
  for (const auto& one : asked) {
    EXPECT_TRUE(std::regex_search(metrics, std::regex("\n" + one + "[{ ]"))) << one;
  }
  std::set<std::string> families;
  const std::regex family("# TYPE (kidnapwatch_[a-z_]+) ");
  for (std::sregex_iterator found(metrics.begin(), metrics.end(), family), end; found != end;
       ++found) {
    families.insert((*found)[1]);
  }
  for (const auto& one : families) {  // none is left out
    EXPECT_TRUE(asked.lower_bound(one) != asked.end() && asked.lower_bound(one)->starts_with(one))
        << one;
  }
}

}  // namespace
}  // namespace kidnapwatch::test
