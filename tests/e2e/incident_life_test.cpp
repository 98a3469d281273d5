// SPDX-License-Identifier: Apache-2.0
// What operators do to an incident, as subscribers hear it and the store keeps it.
#include <csignal>

#include <gtest/gtest.h>

#include "tests/e2e/stack.hpp"

namespace kidnapwatch::test {
namespace {

TEST(IncidentLife, IsHeardInOrderAndKept) {
  Stack stack;
  stack.subscribe("kidnapwatch/v1/+/alert");
  stack.start_service();
  stack.await_ready();
  (void)stack.robots({"simulate", "--robots", "1", "--rate", "5", "--duration", "60",
                      "--kidnap-every", "50", "--speed", "10"});
  const std::string all = "/api/v1/incidents";
  ASSERT_TRUE(eventually([&] { return stack.get(all).at("incidents").size() == 1; }));
  const std::string incident =
      all + "/" + stack.get(all).at("incidents").at(0).at("id").get<std::string>();

  EXPECT_EQ(stack.post(incident + "/ack", "{}").at("state"), "acknowledged");
  EXPECT_TRUE(stack.post(incident + "/shelve", R"({"seconds":3600})").contains("shelvedUntil"));
  EXPECT_EQ(stack.post(incident + "/shelve", "{}").at("field"), "seconds");
  EXPECT_EQ(stack.post(incident + "/resolve", R"({"comment":"put back"})").at("state"), "resolved");
  EXPECT_EQ(stack.post(incident + "/ack", "{}").at("status"), 409);
  EXPECT_EQ(stack.post(incident + "/label", R"({"label":"test"})").at("label"), "test");

  const auto told = [&] {
    std::string types;
    for (const auto& message : stack.received()) {
      const Json alert = Json::parse(message.payload, nullptr, false);
      if (alert.is_object()) {
        types += alert.at("type").get<std::string>() + std::to_string(alert.at("seq").get<int>());
      }
    }
    return types;
  };
  EXPECT_TRUE(eventually([&] {
    return told().ends_with("acknowledged2shelved3resolved4updated5");
  })) << told();
  stack.service->signal(SIGKILL);
  (void)stack.service->wait();
  stack.start_service();
  stack.await_ready();
  const Json kept = stack.get(incident);
  EXPECT_EQ(kept.at("label"), "test");
  EXPECT_EQ(kept.at("comment"), "put back");
  EXPECT_EQ(kept.at("seq"), 5);
}

}  // namespace
}  // namespace kidnapwatch::test
