// SPDX-License-Identifier: Apache-2.0
// Tokens as an operator handles them, while the service runs.
#include <gtest/gtest.h>

#include "tests/e2e/stack.hpp"

namespace kidnapwatch::test {
namespace {

TEST(Tokens, AreMadeUsedAndRevokedWithoutARestart) {
  Stack stack;
  const std::string file = stack.database().string() + "-tokens.json";
  const auto token = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {KW_PROGRAM, "token"});
    words.insert(words.end(), {"--http-tokens-file", file});
    std::string text = output_of(words);
    if (!text.empty()) text.pop_back();  // the end of the line
    return text;
  };
  stack.start_service({"--http-auth", "tokens", "--http-tokens-file", file});
  stack.await_ready();
  EXPECT_EQ(stack.status_of("/api/v1/robots"), 401);

  const std::string secret = token({"create", "--name", "dashboard"});
  EXPECT_EQ(stack.status_of("/api/v1/robots", secret), 200);
  EXPECT_EQ(stack.status_of("/api/v1/robots", secret + "0"), 401);
  const std::string listed = token({"list"});
  EXPECT_NE(listed.find("viewer  dashboard"), std::string::npos) << listed;
  EXPECT_EQ(listed.find(secret), std::string::npos);

  token({"revoke", listed.substr(0, listed.find(' '))});
  EXPECT_EQ(stack.status_of("/api/v1/robots", secret), 401);
  EXPECT_EQ(stack.service_log().find(secret), std::string::npos);
}

}  // namespace
}  // namespace kidnapwatch::test
