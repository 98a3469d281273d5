// SPDX-License-Identifier: Apache-2.0
// CBOR scans: as another library writes them, as typed arrays, and every way to be wrong.
#include <algorithm>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "adapters/codecs/json.hpp"
#include "adapters/codecs/scan_encode.hpp"
#include "tests/adapters/codecs/scans.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

using namespace std::string_literals;

Json message() {
  return {{"header", {{"stamp", {{"sec", 1700000000}, {"nanosec", 123456789}}}, {"seq", 7}}},
          {"angle_min", -1.5},
          {"angle_increment", 0.01},
          {"range_min", 0.05},
          {"range_max", 12},
          {"intensities", Json::array({1, 2, 3})},
          {"ranges", {1.5, 2, 0.1F}}};
}

std::string cbor(const Json& json) {
  std::string bytes;
  Json::to_cbor(json, bytes);
  return bytes;
}

std::string cbor(const core::Scan& scan) {
  std::string bytes;
  append_cbor(bytes, scan);
  return bytes;
}

/// The message with its ranges, the last of its fields, given as bytes.
std::string with_ranges(const std::string& ranges) {
  Json json = message();
  json["ranges"] = "R";
  return replaced(cbor(json), "\x61R", ranges);
}

std::string refusal_without(const char* field) {
  Json json = message();
  json.erase(field);
  return refusal(cbor(json));
}

std::string refusal_with(const char* field, const Json& value) {
  Json json = message();
  json[field] = value;
  return refusal(cbor(json));
}

std::vector<float> ranges_of(const std::string& bytes) { return decoded(bytes).ranges_m; }

TEST(ScanCbor, ReadsWhatAnotherLibraryWrites) {
  EXPECT_TRUE(same(decoded(cbor(message())), some_scan({1.5F, 2.0F, 0.1F})));
}

TEST(ScanCbor, ReadsOdometryAndRos1Stamps) {
  Json json = message();
  json["header"]["stamp"] = {{"secs", 5}, {"nsecs", 6}, {"other", nullptr}};
  json["odom"] = {{"x", 1}, {"y", -2.5}, {"theta", 0.5}, {"frame", "odom"}};
  const core::Scan scan = decoded(cbor(json));
  EXPECT_EQ(scan.stamp, core::stamp_from_ns(5'000'000'006));
  EXPECT_EQ(scan.odometry, (core::Pose{1.0, -2.5, 0.5}));
  json["odom"] = nullptr;
  EXPECT_EQ(decoded(cbor(json)).odometry, std::nullopt);
}

TEST(ScanCbor, ReadsTypedArraysOfEveryFloat) {
  const std::vector<float> expected = {1.0F, -2.0F};
  EXPECT_EQ(ranges_of(with_ranges("\xD8\x50\x44\x3C\x00\xC0\x00"s)), expected);  // 80: f16 BE
  EXPECT_EQ(ranges_of(with_ranges("\xD8\x54\x44\x00\x3C\x00\xC0"s)), expected);  // 84: f16 LE
  EXPECT_EQ(ranges_of(with_ranges("\xD8\x51\x48\x3F\x80\x00\x00\xC0\x00\x00\x00"s)), expected);
  EXPECT_EQ(ranges_of(with_ranges("\xD8\x55\x48\x00\x00\x80\x3F\x00\x00\x00\xC0"s)), expected);
  EXPECT_EQ(ranges_of(with_ranges("\xD8\x52\x50\x3F\xF0\x00\x00\x00\x00\x00\x00"
                                  "\xC0\x00\x00\x00\x00\x00\x00\x00"s)),
            expected);
  EXPECT_EQ(ranges_of(with_ranges("\xD8\x56\x50\x00\x00\x00\x00\x00\x00\xF0\x3F"
                                  "\x00\x00\x00\x00\x00\x00\x00\xC0"s)),
            expected);
}

TEST(ScanCbor, ReadsArraysOfIndefiniteLengthAndMixedNumbers) {
  EXPECT_TRUE(same_ranges(
      ranges_of(with_ranges("\x9F\x01\xF9\x3E\x00\xFA\x7F\x80\x00\x00\xF6\xF7\x20\xFF"s)),
      {1.0F, 1.5F, kInf, kInf, kInf, -1.0F}));
}

TEST(ScanCbor, CountsNulls) {
  ScanDecoder decoder({.null_range = NullRange::invalid});
  core::Scan scan;
  decoder.decode(with_ranges("\x83\xF6\x01\xF7"s), kCborContentType, scan);
  EXPECT_TRUE(same_ranges(scan.ranges_m, {kNaN, 1.0F, kNaN}));
  EXPECT_EQ(decoder.nulls(), 2U);
}

TEST(ScanCbor, PassesOverTagsThatSayNothing) {
  EXPECT_EQ(ranges_of("\xD9\xD9\xF7" + with_ranges("\xD8\x29\x82\x01\x02"s)),
            (std::vector<float>{1.0F, 2.0F}));
}

TEST(ScanCbor, NamesMissingFields) {
  EXPECT_EQ(refusal_without("header"), "missing_field header.stamp: is missing");
  for (const char* field : {"ranges", "angle_min", "angle_increment", "range_min", "range_max"}) {
    EXPECT_EQ(refusal_without(field), "missing_field "s + field + ": is missing");
  }
  EXPECT_EQ(refusal_with("header", {{"stamp", {{"sec", 1}}}}),
            "missing_field header.stamp.nanosec: is missing");
}

TEST(ScanCbor, NamesFieldsOfAnotherType) {
  EXPECT_EQ(refusal_with("ranges", "1,2"), "wrong_type ranges: is not an array");
  EXPECT_EQ(refusal_with("ranges", nullptr), "wrong_type ranges: is not an array");
  EXPECT_EQ(refusal_with("ranges", {1, "2"}), "wrong_type ranges: is not a number");
  EXPECT_EQ(refusal_with("range_max", "far"), "wrong_type range_max: is not a number");
  EXPECT_EQ(refusal_with("header", 5), "wrong_type header: is not a map");
  EXPECT_EQ(refusal_with("header", {{"stamp", 1.5}}), "wrong_type header.stamp: is not a map");
  EXPECT_EQ(refusal_with("header", {{"stamp", {{"sec", 1.5}}}}),
            "wrong_type header.stamp: is not a whole number of 32 bits");
  EXPECT_EQ(refusal_with("header", {{"stamp", {{"sec", 1ULL << 63}}}}),
            "wrong_type header.stamp: is not a whole number of 32 bits");
  EXPECT_EQ(refusal_with("odom", 5), "wrong_type odom: is not a map");
  EXPECT_EQ(refusal(with_ranges("\xD8\x55\x82\x01\x02"s)),
            "wrong_type ranges: is not a typed array in one byte string");
  EXPECT_EQ(refusal("\x81\x01", "application/cbor"), "malformed payload: is not a map");
}

TEST(ScanCbor, NamesGeometryAndBeamsThatAreWrong) {
  EXPECT_TRUE(refusal_with("angle_increment", 0).starts_with("bad_geometry"));
  EXPECT_TRUE(refusal_with("range_max", kInf).starts_with("bad_geometry"));
  EXPECT_TRUE(refusal_with("ranges", Json::array()).starts_with("no_beams"));
  EXPECT_TRUE(refusal(with_ranges("\xD8\x55\x40"s)).starts_with("no_beams"));
  EXPECT_TRUE(refusal_with("ranges", std::vector<int>(core::kMaxBeams + 1, 1))
                  .starts_with("too_many_beams"));
  const std::string floats(4 * (core::kMaxBeams + 1), '\0');
  EXPECT_TRUE(
      refusal(with_ranges("\xD8\x55\x5A\x00\x04\x00\x04"s + floats)).starts_with("too_many_beams"));
}

TEST(ScanCbor, RefusesWhatIsNotWellFormed) {
  const std::string bytes = cbor(message());
  for (std::size_t length = 1; length < bytes.size(); ++length) {
    EXPECT_TRUE(refusal(bytes.substr(0, length)).starts_with("malformed")) << length;
  }
  EXPECT_TRUE(refusal(bytes + "\x00"s).starts_with("malformed"));
  EXPECT_TRUE(refusal(with_ranges("\xD8\x55\x43\x01\x02\x03")).starts_with("malformed"));
  EXPECT_TRUE(
      refusal(with_ranges("\x9B\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x01")).starts_with("malformed"));
}

RC_GTEST_PROP(ScanCbor, ReadsBackWhatWasEncoded, ()) {
  const core::Scan scan = arbitrary_scan();
  RC_ASSERT(same(decoded(cbor(scan)), scan));
}

RC_GTEST_PROP(ScanCbor, IsReadByAnotherLibrary, ()) {
  const core::Scan scan = arbitrary_scan();
  const Json read = Json::from_cbor(cbor(scan), true, true, Json::cbor_tag_handler_t::store);
  RC_ASSERT(read["angle_min"].get<double>() == scan.geometry.angle_min_rad);
  RC_ASSERT(read["ranges"].get_binary().subtype() == 85U);
  RC_ASSERT(read["ranges"].get_binary().size() == 4 * scan.ranges_m.size());
  RC_ASSERT(read.contains("odom") == scan.odometry.has_value());
}

RC_GTEST_PROP(ScanCbor, AgreesWithAnotherLibraryOnNumbers, (const std::vector<double>& numbers)) {
  Json json = message();
  json["ranges"] = numbers;
  std::vector<float> expected(numbers.size());
  std::ranges::transform(numbers, expected.begin(), to_float);
  RC_PRE(!numbers.empty() && numbers.size() < 600);
  RC_ASSERT(same_ranges(ranges_of(cbor(json)), expected));
}

RC_GTEST_PROP(ScanCbor, SurvivesMutations, ()) {
  (void)refusal(mutated(cbor(arbitrary_scan())), kCborContentType);
}

RC_GTEST_PROP(ScanCbor, SurvivesGarbage, (const std::string& garbage)) {
  RC_ASSERT(refusal("\xBF" + garbage, kCborContentType) != "decoded");
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
