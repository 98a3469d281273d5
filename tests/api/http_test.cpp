// SPDX-License-Identifier: Apache-2.0
// Targets, content negotiation and entity tags.
#include "api/http.hpp"

#include <random>

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::api {
namespace {

using Segments = std::vector<std::string>;
using Query = std::map<std::string, std::string>;

TEST(ParsedTarget, SplitsPathAndQuery) {
  const auto target = parsed_target("/api/v1/robots?state=open&robot=a%2Fb&flag&empty=");
  EXPECT_EQ(target.segments, (Segments{"api", "v1", "robots"}));
  EXPECT_EQ(target.query,
            (Query{{"state", "open"}, {"robot", "a/b"}, {"flag", ""}, {"empty", ""}}));
}

TEST(ParsedTarget, KeepsEmptySegments) {
  EXPECT_EQ(parsed_target("/").segments, Segments{});
  EXPECT_EQ(parsed_target("//").segments, (Segments{"", ""}));
  EXPECT_EQ(parsed_target("/a/").segments, (Segments{"a", ""}));
}

TEST(ParsedTarget, DecodesAfterItSplit) {
  EXPECT_EQ(parsed_target("/a%2fb/c").segments, (Segments{"a/b", "c"}));
  EXPECT_EQ(parsed_target("/?a%3Db=c%26d").query, (Query{{"a=b", "c&d"}}));
  EXPECT_EQ(parsed_target("/%00").segments, Segments{std::string(1, '\0')});
}

TEST(ParsedTarget, LeavesAPlusSignAlone) {
  EXPECT_EQ(parsed_target("/?from=00:00+02:00").query.at("from"), "00:00+02:00");
}

TEST(ParsedTarget, TakesTheAbsoluteFormOfProxies) {
  EXPECT_EQ(parsed_target("http://host:80/a?b=c").segments, Segments{"a"});
  EXPECT_EQ(parsed_target("HTTPS://host").segments, Segments{});
}

TEST(ParsedTarget, RefusesWhatIsNoPath) {
  for (const char* bad : {"", "*", "a", "?a=b", "host:80", "/a#b", "/%", "/%4", "/%zz", "/%4g",
                          "/?a=%", "/?%", "/?a=1&a=1", "/?a=1&%61=2"}) {
    EXPECT_THROW((void)parsed_target(bad), core::BadInput) << bad;
  }
}

/// Bytes that make trouble more often than others.
std::string garbage(std::mt19937& random) {
  static constexpr std::string_view kTrouble = "//??&&==%%%%++##0aFfzZ:.\\ ";
  std::string text = random() % 8 == 0 ? "" : "/";
  for (auto length = random() % 40; length > 0; --length) {
    text += random() % 4 == 0 ? static_cast<char>(random() % 256)
                              : kTrouble[random() % kTrouble.size()];
  }
  return text;
}

TEST(ParsedTarget, SurvivesGarbage) {
  std::mt19937 random(1);
  int accepted = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto text = garbage(random);
    try {
      const auto target = parsed_target(text);
      ++accepted;
      EXPECT_LE(target.segments.size() + target.query.size(), text.size()) << text;
    } catch (const core::BadInput&) {
    }
  }
  EXPECT_GT(accepted, 1000);  // or the property was tried on nothing
}

TEST(ParsedTarget, ReadsWhatWasPercentEncoded) {
  std::mt19937 random(2);
  for (int i = 0; i < 5'000; ++i) {
    const auto segment = "s" + garbage(random);
    const auto name = "n" + garbage(random);
    const auto value = garbage(random);
    const auto target = parsed_target("/" + percent_encoded(segment) + "?" + percent_encoded(name) +
                                      "=" + percent_encoded(value));
    EXPECT_EQ(target.segments, Segments{segment});
    EXPECT_EQ(target.query, (Query{{name, value}}));
  }
}

TEST(HeaderOf, IsFoundInAnyCase) {
  const Request request{"GET", "/", {{"content-TYPE", "text/csv"}, {"Content-Type", "b"}}, "", ""};
  EXPECT_EQ(header(request, "Content-Type"), "text/csv");
  EXPECT_EQ(header(request, "Accept"), "");
}

TEST(IsMediaType, IgnoresCaseAndParameters) {
  EXPECT_TRUE(is_media_type("application/json", "application/json"));
  EXPECT_TRUE(is_media_type("Application/JSON ; charset=utf-8", "application/json"));
  EXPECT_FALSE(is_media_type("", "application/json"));
  EXPECT_FALSE(is_media_type("application/json5", "application/json"));
  EXPECT_FALSE(is_media_type("text/plain; application/json", "application/json"));
}

TEST(Prefers, TakesTheHeavierType) {
  const auto csv = [](std::string_view accept) {
    return prefers(accept, "text/csv", "application/json");
  };
  EXPECT_TRUE(csv("text/csv"));
  EXPECT_TRUE(csv("TEXT/*"));
  EXPECT_TRUE(csv("application/json;q=0.5, text/csv;q=0.9"));
  EXPECT_TRUE(csv("*/*;q=0.1, text/csv"));
  EXPECT_FALSE(csv(""));
  EXPECT_FALSE(csv("*/*"));
  EXPECT_FALSE(csv("text/csv, application/json"));
  EXPECT_FALSE(csv("text/csv;q=0, */*"));
  EXPECT_FALSE(csv("text/csv;q=nonsense"));
  EXPECT_FALSE(csv(",,;;q=,/"));
}

TEST(HttpDate, IsTheExampleOfTheStandard) {
  EXPECT_EQ(http_date(std::chrono::system_clock::from_time_t(784'111'777)),
            "Sun, 06 Nov 1994 08:49:37 GMT");
}

TEST(Accepts, TakesTheCodingsThatAreNamed) {
  EXPECT_TRUE(accepts("gzip", "gzip"));
  EXPECT_TRUE(accepts("deflate, GZIP;q=0.5", "gzip"));
  EXPECT_FALSE(accepts("gzip;q=0", "gzip"));
  EXPECT_FALSE(accepts("", "gzip"));
}

TEST(ListsTag, FindsATagInAList) {
  EXPECT_TRUE(lists_tag(R"("1", "2")", R"("2")", false));
  EXPECT_TRUE(lists_tag("*", R"("2")", false));
  EXPECT_FALSE(lists_tag(R"("12")", R"("2")", false));
  EXPECT_FALSE(lists_tag("", R"("2")", false));
  EXPECT_TRUE(lists_tag(R"(W/"2")", R"("2")", true));
  EXPECT_FALSE(lists_tag(R"(W/"2")", R"("2")", false));
}

}  // namespace
}  // namespace kidnapwatch::api
