// SPDX-License-Identifier: Apache-2.0
// Tokens in a file that several processes use.
#include "service/token_file.hpp"

#include <cstdlib>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::service {
namespace {

namespace fs = std::filesystem;

class TokenFileTest : public testing::Test {
 protected:
  void TearDown() override { fs::remove_all(folder_); }

  static api::NewToken made(const std::string& name) {
    return api::new_token({.name = name}, core::stamp_from_ns(1));
  }

  static fs::path new_folder() {
    std::string name = fs::temp_directory_path() / "kidnapwatch-XXXXXX";
    return ::mkdtemp(name.data());
  }

  fs::path folder_ = new_folder();
  fs::path path_ = folder_ / "below" / "tokens.json";
};

TEST_F(TokenFileTest, HoldsNothingWhereThereIsNoFile) {
  TokenFile file(path_);
  EXPECT_TRUE(file.tokens().empty());
  EXPECT_FALSE(file.caller("kw_0"));
  EXPECT_FALSE(file.revoke("1"));
}

TEST_F(TokenFileTest, ChangesOfAnotherProcessAreInForceAtOnce) {
  TokenFile here(path_);
  const TokenFile there(path_);
  for (int i = 0; i < 20; ++i) {
    const auto token = made("t" + std::to_string(i));
    here.add(token.token);
    ASSERT_TRUE(there.caller(token.secret)) << i;
    ASSERT_TRUE(here.revoke(token.token.id));
    ASSERT_FALSE(there.caller(token.secret)) << i;
  }
}

TEST_F(TokenFileTest, IsForItsOwnerAlone) {
  TokenFile(path_).add(made("a").token);
  EXPECT_EQ(fs::status(path_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(TokenFileTest, LosesNoneOfManyAtOnce) {
  TokenFile(path_).add(made("first").token);
  {
    std::vector<std::jthread> writers;
    writers.reserve(8);
    for (int i = 0; i < 8; ++i) {
      writers.emplace_back([this] {
        for (int j = 0; j < 5; ++j) TokenFile(path_).add(made("many").token);
      });
    }
  }
  EXPECT_EQ(TokenFile(path_).tokens().size(), 41U);
}

TEST_F(TokenFileTest, ABrokenFileLetsNobodyInAndIsNamed) {
  TokenFile file(path_);
  const auto token = made("a");
  file.add(token.token);
  ASSERT_TRUE(file.caller(token.secret));
  std::ofstream(path_) << "{";
  for (int i = 0; i < 2; ++i) {
    try {
      (void)file.caller(token.secret);
      FAIL() << "let in";
    } catch (const core::BadInput& error) {
      EXPECT_NE(error.field().find(path_.string()), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace kidnapwatch::service
