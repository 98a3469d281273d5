// SPDX-License-Identifier: Apache-2.0
// JSON: what is refused on the way in, and what never comes out.
#include "adapters/codecs/json.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

TEST(Json, RefusesWhatIsNotOneDocument) {
  for (const char* bad : {"", "{", "{} {}", "nan", "{'a':1}", "{\"a\":01}", "[1,]", "1e999",
                          "\"\xff\"", "\xef\xbb\xbf{}garbage"}) {
    EXPECT_THROW((void)parsed(bad, "body"), core::BadInput) << bad;
  }
}

TEST(Json, RefusesAMemberNamedTwice) {
  EXPECT_THROW((void)parsed(R"({"a":1,"a":2})", "body"), core::BadInput);
  EXPECT_THROW((void)parsed(R"({"b":[{"a":1,"a":1}]})", "body"), core::BadInput);
  EXPECT_NO_THROW((void)parsed(R"({"a":{"a":1},"b":{"a":1}})", "body"));
}

TEST(Json, NamesTheFieldThatIsNotJson) {
  try {
    (void)parsed("{", "body");
    FAIL() << "no exception";
  } catch (const core::BadInput& error) {
    EXPECT_EQ(error.field(), "body");
  }
}

TEST(Json, SurvivesDeepNesting) {
  EXPECT_THROW((void)parsed(std::string(65536, '['), "body"), core::BadInput);
  const std::string deep = std::string(30000, '[') + std::string(30000, ']');
  EXPECT_TRUE(parsed(deep, "body").is_array());
}

TEST(Json, LeavesOutWhatIsAbsentOrNotFinite) {
  Json object = Json::object();
  set(object, "absent", std::optional<double>());
  set(object, "nan", std::numeric_limits<double>::quiet_NaN());
  set(object, "inf", std::optional<double>(std::numeric_limits<double>::infinity()));
  set(object, "zero", 0.0);
  set(object, "some", std::optional<std::string>("text"));
  EXPECT_EQ(text(object), R"({"zero":0.0,"some":"text"})");
}

TEST(Json, PrintsBytesThatAreNotUtf8AsReplacements) {
  EXPECT_EQ(text(Json("a\xff"
                      "b")),
            "\"a\xef\xbf\xbd"
            "b\"");
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
