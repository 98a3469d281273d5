// SPDX-License-Identifier: Apache-2.0
// Bare NaN and infinities: found where they are numbers, left alone where they are text.
#include "adapters/codecs/nonfinite.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kidnapwatch::adapters::codecs {
namespace {

std::string quoted(std::string_view text) {
  std::string out = "left over";
  quote_nonfinite(text, out);
  return out;
}

TEST(Nonfinite, KnowsTheSpellingsOfManyLanguages) {
  for (const char* text : {"NaN", "nan", "NAN", "-nan", "+NaN"}) {
    ASSERT_TRUE(nonfinite(text)) << text;
    EXPECT_TRUE(std::isnan(*nonfinite(text))) << text;
  }
  for (const char* text : {"Infinity", "inf", "Inf", "+Infinity", "+inf"}) {
    EXPECT_EQ(nonfinite(text), std::numeric_limits<double>::infinity()) << text;
  }
  EXPECT_EQ(nonfinite("-Infinity"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(nonfinite("-inf"), -std::numeric_limits<double>::infinity());
}

TEST(Nonfinite, KnowsNothingElse) {
  for (const char* text :
       {"", "-", "null", "1", "na", "nano", "infinite", "--inf", "NaN ", "1nan"}) {
    EXPECT_FALSE(nonfinite(text)) << text;
  }
}

TEST(QuoteNonfinite, PutsBareOnesInQuotes) {
  EXPECT_EQ(quoted(R"({"a":[1,NaN,-Infinity, inf],"b":null})"),
            R"({"a":[1,"NaN","-Infinity", "inf"],"b":null})");
}

TEST(QuoteNonfinite, LeavesTextAlone) {
  const std::string text = R"({"NaN":"inf \" NaN","b":nano,"c":1e5,"d":-7})";
  std::string out;
  EXPECT_FALSE(quote_nonfinite(text, out));
  EXPECT_EQ(out, text);
}

TEST(QuoteNonfinite, EndsWithStringsThatNeverEnd) {
  EXPECT_EQ(quoted(R"(NaN "NaN)"), R"("NaN" "NaN)");
  EXPECT_EQ(quoted("\"\\"), "\"\\");
}

RC_GTEST_PROP(QuoteNonfinite, OnlyEverAddsQuotes, (const std::string& text)) {
  std::string out;
  const bool found = quote_nonfinite(text, out);
  RC_ASSERT((found ? out.size() > text.size() : out == text));
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
