// SPDX-License-Identifier: Apache-2.0
// JSON scans: what robots send, and every way to be wrong under its own outcome.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "adapters/codecs/scan_encode.hpp"
#include "tests/adapters/codecs/scans.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

// What rosbridge sends for a ROS 1 robot.
constexpr const char* kRos1 =
    R"({"header":{"seq":7,"stamp":{"secs":1700000000,"nsecs":123456789},"frame_id":"laser"},)"
    R"("angle_min":-1.5,"angle_max":1.5,"angle_increment":0.01,"time_increment":0.0,)"
    R"("scan_time":0.2,"range_min":0.05,"range_max":12.0,"ranges":[1.5,2,3e0],)"
    R"("intensities":[]})";

std::string with(std::string_view from, std::string_view to) { return replaced(kRos1, from, to); }
std::string with_ranges(std::string_view ranges) { return with("[1.5,2,3e0]", ranges); }

std::string refusal_with(std::string_view from, std::string_view to) {
  return refusal(with(from, to));
}

TEST(ScanJson, ReadsWhatRosbridgeWrites) {
  EXPECT_TRUE(same(decoded(kRos1), some_scan({1.5F, 2.0F, 3.0F})));
}

TEST(ScanJson, ReadsRos2Stamps) {
  EXPECT_EQ(decoded(with(R"("secs":1700000000,"nsecs")", R"("sec":-1,"nanosec")")).stamp,
            core::stamp_from_ns(-1'000'000'000 + 123'456'789));
}

TEST(ScanJson, ReadsOdometryBesideTheScan) {
  const auto odom = [](std::string_view text) {
    return decoded(with(R"("range_min")", std::string(text) + R"("range_min")")).odometry;
  };
  EXPECT_EQ(odom(R"("odom":{"x":1,"y":-2.5,"theta":0.5,"z":null},)"), (core::Pose{1, -2.5, 0.5}));
  EXPECT_EQ(odom(R"("odom":null,)"), std::nullopt);
  EXPECT_EQ(odom(""), std::nullopt);
}

TEST(ScanJson, TakesNullForNothingInRange) {
  EXPECT_TRUE(same_ranges(decoded(with_ranges("[null,2]")).ranges_m, {kInf, 2.0F}));
}

TEST(ScanJson, TakesNullForInvalidIfConfigured) {
  const auto scan = decoded(with_ranges("[null,2]"), "", {.null_range = NullRange::invalid});
  EXPECT_TRUE(same_ranges(scan.ranges_m, {kNaN, 2.0F}));
}

TEST(ScanJson, CountsNulls) {
  ScanDecoder decoder;
  core::Scan scan;
  decoder.decode(with_ranges("[null,2,null]"), "", scan);
  decoder.decode(with_ranges("[1,null]"), "", scan);
  EXPECT_EQ(decoder.nulls(), 3U);
}

TEST(ScanJson, ReadsBareAndQuotedNonfiniteNumbers) {
  const std::vector<float> expected = {kNaN, kInf, -kInf, 1.0F};
  for (const char* ranges : {"[NaN,Infinity,-Infinity,1]", "[nan, inf, -inf, 1]",
                             R"(["NaN","Infinity","-Infinity",1])"}) {
    EXPECT_TRUE(same_ranges(decoded(with_ranges(ranges)).ranges_m, expected)) << ranges;
  }
}

TEST(ScanJson, ReadsBareNonfiniteNumbersInFieldsItPassesOver) {
  const std::string text = with(R"("intensities":[])", R"("intensities":[NaN,-Infinity])");
  EXPECT_TRUE(same(decoded(text), some_scan({1.5F, 2.0F, 3.0F})));
}

TEST(ScanJson, ReadsEscapedKeysAndWhitespace) {
  EXPECT_TRUE(
      same(decoded("\xEF\xBB\xBF \r\n\t" + with("\"ranges\":", R"("r\u0061nges" : )") + "\n"),
           some_scan({1.5F, 2.0F, 3.0F})));
}

TEST(ScanJson, TakesTheLastOfARepeatedField) {
  const std::string text =
      with(R"("intensities":[])", R"("ranges":[9],"range_max":20,"odom":null)");
  core::Scan expected = some_scan({9.0F});
  expected.geometry.range_max_m = 20.0;
  EXPECT_TRUE(same(decoded(text), expected));
}

TEST(ScanJson, TakesNumbersBeyondAFloatForInfinite) {
  EXPECT_TRUE(
      same_ranges(decoded(with_ranges("[1e300,-1e300,1e-300]")).ranges_m, {kInf, -kInf, 0.0F}));
}

TEST(ScanJson, NamesMissingFields) {
  EXPECT_EQ(refusal("{}"), "missing_field header.stamp: is missing");
  for (const char* field : {"ranges", "angle_min", "angle_increment", "range_min", "range_max"}) {
    const std::string quoted = "\"" + std::string(field) + "\"";
    EXPECT_EQ(refusal_with(quoted, R"("other")"),
              "missing_field " + std::string(field) + ": is missing");
  }
  EXPECT_EQ(refusal_with("stamp", "time"), "missing_field header.stamp: is missing");
  EXPECT_EQ(refusal_with("nsecs", "n"), "missing_field header.stamp.nanosec: is missing");
  EXPECT_EQ(refusal_with("\"secs", "\"s"), "missing_field header.stamp.sec: is missing");
  EXPECT_EQ(refusal_with(R"("scan_time":0.2)", R"("odom":{"x":1,"y":2})"),
            "missing_field odom.theta: is missing");
}

TEST(ScanJson, NamesFieldsOfAnotherType) {
  EXPECT_EQ(refusal(with_ranges(R"("1.5,2,3")")), "wrong_type ranges: is not an array");
  EXPECT_EQ(refusal(with_ranges("null")), "wrong_type ranges: is not an array");
  EXPECT_EQ(refusal(with_ranges(R"([1,"2"])")), "wrong_type ranges: is not a number");
  EXPECT_EQ(refusal(with_ranges("[1,[2]]")), "wrong_type ranges: is not a number");
  EXPECT_EQ(refusal(with_ranges("[1,true]")), "wrong_type ranges: is not a number");
  EXPECT_EQ(refusal_with("12.0", R"("far")"), "wrong_type range_max: is not a number");
  EXPECT_EQ(refusal_with("12.0", "null"), "wrong_type range_max: is not a number");
  EXPECT_EQ(refusal_with("1700000000", "17.5"), "wrong_type header.stamp: is not a whole number");
  EXPECT_EQ(refusal_with("123456789", "1000000000"),
            "wrong_type header.stamp.nanosec: is not a number from 0 to 999999999");
  EXPECT_EQ(refusal_with("1700000000", "99999999999"),
            "wrong_type header.stamp.sec: is not a number of 32 bits");
  EXPECT_EQ(refusal(R"({"header":5})"), "wrong_type header: is not an object");
  EXPECT_EQ(refusal(R"({"header":{"stamp":5}})"), "wrong_type header.stamp: is not an object");
  EXPECT_EQ(refusal(R"({"odom":[1,2,3]})"), "wrong_type odom: is not an object");
  EXPECT_EQ(refusal(R"({"odom":{"x":NaN,"y":2,"theta":3}})"),
            "wrong_type odom: is not finite numbers");
}

TEST(ScanJson, NamesGeometryThatDescribesNoLidar) {
  const std::string bad = "bad_geometry";
  EXPECT_TRUE(refusal_with("0.01", "0").starts_with(bad));
  EXPECT_TRUE(refusal_with("0.01", "NaN").starts_with(bad));
  EXPECT_TRUE(refusal_with("0.01", "Infinity").starts_with(bad));
  EXPECT_TRUE(refusal_with("0.01", "4").starts_with(bad));
  EXPECT_TRUE(refusal_with("-1.5", "NaN").starts_with(bad));
  EXPECT_TRUE(refusal_with("12.0", "0.01").starts_with(bad));
  EXPECT_TRUE(refusal_with("12.0", "Infinity").starts_with(bad));
  EXPECT_TRUE(refusal_with("0.05", "-0.05").starts_with(bad));
}

TEST(ScanJson, NamesTooFewAndTooManyBeams) {
  EXPECT_TRUE(refusal(with_ranges("[]")).starts_with("no_beams"));
  std::string ranges = "[1";
  for (std::size_t i = 0; i < core::kMaxBeams; ++i) {
    ranges += ",1";
  }
  EXPECT_TRUE(refusal(with_ranges(ranges + "]")).starts_with("too_many_beams"));
}

TEST(ScanJson, RefusesWhatIsNoJson) {
  const std::string text = kRos1;
  for (const std::string& payload :
       {text.substr(0, text.size() - 1), text.substr(0, text.size() / 2), text + "x", text + text,
        with_ranges("[1,,2]"), with_ranges("[1 2]"), with_ranges("[1,1e999]"), with_ranges("[1,-]"),
        with_ranges("[01]"), with("laser", "la\xFFser"), with("laser", "la\"ser"), std::string("{"),
        std::string("{]"), std::string("{\"a\"}"), std::string("{\"ranges\":"), std::string("{NaN"),
        std::string("{\0}", 3)}) {
    EXPECT_TRUE(refusal(payload).starts_with("malformed")) << payload << refusal(payload);
  }
}

TEST(ScanJson, SurvivesDeepNesting) {
  const std::string deep(100'000, '[');
  EXPECT_TRUE(refusal(R"({"a":)" + deep).starts_with("malformed"));
  EXPECT_TRUE(refusal(R"({"ranges":)" + deep).starts_with("malformed"));
  const std::string closed = deep + std::string(100'000, ']');
  EXPECT_TRUE(same(decoded(with(R"("intensities":[])", R"("intensities":)" + closed)),
                   some_scan({1.5F, 2.0F, 3.0F})));
}

RC_GTEST_PROP(ScanJson, RefusesGarbageWithoutHarm, (const std::string& garbage)) {
  RC_ASSERT(refusal("{" + garbage) != "decoded");
}

RC_GTEST_PROP(ScanJson, SurvivesMutations, ()) {
  std::string text;
  append_json(text, arbitrary_scan(), NonFinite::bare);
  ScanDecoder decoder;
  core::Scan scan;
  const std::string hostile = mutated(text);
  try {
    decoder.decode(hostile, kJsonContentType, scan);
    core::check(scan);
  } catch (const core::BadScan&) {
  }
  decoder.decode(text, kJsonContentType, scan);  // what came before does no harm
  RC_ASSERT(scan.ranges_m.size() > 0U);
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
