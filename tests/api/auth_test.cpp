// SPDX-License-Identifier: Apache-2.0
// Tokens: how they are made, kept and known again.
#include "api/auth.hpp"

#include <set>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::api {
namespace {

using adapters::codecs::Json;
using adapters::codecs::text;

const core::Stamp kNow = core::stamp_from_ns(1'790'000'000'000'000'000);

std::string field_of_refused(const Json& json) {
  try {
    (void)tokens(json);
  } catch (const core::BadInput& error) {
    return error.field();
  }
  return "none";
}

TEST(Auth, ASecretIsKnownByItsHashAlone) {
  const auto made = new_token({.name = "dashboard", .role = Role::viewer}, kNow);
  EXPECT_EQ(made.secret.size(), 3 + 64U);
  EXPECT_EQ(text(json(std::vector{made.token})).find(made.secret.substr(3)), std::string::npos);
  const auto caller = caller_of(std::vector{made.token}, made.secret);
  ASSERT_TRUE(caller);
  EXPECT_EQ(caller->name, "dashboard");
  EXPECT_EQ(caller->role, Role::viewer);
}

TEST(Auth, KnowsTheHashOfAWellKnownSecret) {
  const Token token{.id = "1",
                    .caller = {.name = "a"},
                    .created = kNow,
                    .sha256 = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"};
  EXPECT_TRUE(caller_of(std::vector{token}, "abc"));  // FIPS 180-4's example
  EXPECT_FALSE(caller_of(std::vector{token}, "abd"));
  EXPECT_FALSE(caller_of(std::vector{token}, ""));
}

TEST(Auth, NoTwoSecretsAreAlike) {
  std::set<std::string> secrets;
  std::set<std::string> ids;
  for (int i = 0; i < 100; ++i) {
    const auto made = new_token({.name = "a"}, kNow);
    secrets.insert(made.secret);
    ids.insert(made.token.id);
  }
  EXPECT_EQ(secrets.size(), 100U);
  EXPECT_EQ(ids.size(), 100U);
}

TEST(Auth, TokensComeBackFromJson) {
  const auto made =
      new_token({.name = "night shift", .role = Role::operator_, .robots = {"r1", "r2"}}, kNow);
  const auto back = tokens(json(std::vector{made.token}));
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(text(json(back)), text(json(std::vector{made.token})));
  EXPECT_EQ(caller_of(back, made.secret)->robots, (std::vector<std::string>{"r1", "r2"}));
}

TEST(Auth, RefusesWhatIsNoListOfTokensAndNamesTheField) {
  const auto one = json(std::vector{new_token({.name = "a", .robots = {"r1"}}, kNow).token});
  EXPECT_EQ(field_of_refused(Json::array()), "tokens");
  EXPECT_EQ(field_of_refused({{"tokens", 1}}), "tokens");
  EXPECT_EQ(field_of_refused({{"tokens", {1}}}), "tokens");
  for (const char* member : {"id", "name", "role", "created", "sha256"}) {
    for (const Json& value : {Json(), Json(1), Json(Json::array())}) {
      Json broken = one;
      broken["tokens"][0][member] = value;
      EXPECT_EQ(field_of_refused(broken), member);
    }
  }
  Json broken = one;
  broken["tokens"][0]["robots"] = {"no robot"};
  EXPECT_EQ(field_of_refused(broken), "robot");
  broken["tokens"][0]["robots"] = 7;
  EXPECT_EQ(field_of_refused(broken), "robots");
  broken = one;
  broken["tokens"][0]["sha256"] = "abc";
  EXPECT_EQ(field_of_refused(broken), "sha256");
  broken = one;
  broken["tokens"][0]["role"] = "root";
  EXPECT_EQ(field_of_refused(broken), "role");
}

TEST(Auth, RefusesNamesAndRobotsThatCannotBe) {
  for (const std::string& bad : {std::string(), std::string(65, 'a'), std::string("a\nb")}) {
    EXPECT_THROW((void)new_token({.name = bad}, kNow), core::BadInput);
  }
  EXPECT_THROW((void)new_token({.name = "a", .robots = {"a/b"}}, kNow), core::BadInput);
}

TEST(Auth, SeesAllRobotsOrItsOwn) {
  EXPECT_TRUE(Caller{}.may_see("r1"));
  const Caller one{.name = "", .robots = {"r1"}};
  EXPECT_TRUE(one.may_see("r1"));
  EXPECT_FALSE(one.may_see("r2"));
}

}  // namespace
}  // namespace kidnapwatch::api
