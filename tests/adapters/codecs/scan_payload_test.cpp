// SPDX-License-Identifier: Apache-2.0
// Dialects told apart, and memory that is used again.
#include "adapters/codecs/scan_payload.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "adapters/codecs/scan_encode.hpp"
#include "tests/adapters/codecs/scans.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

std::string json(const core::Scan& scan) {
  std::string out;
  append_json(out, scan);
  return out;
}

TEST(Dialect, IsToldByContentType) {
  EXPECT_EQ(dialect_of_content_type("application/json"), Dialect::json);
  EXPECT_EQ(dialect_of_content_type("Application/JSON; charset=utf-8"), Dialect::json);
  EXPECT_EQ(dialect_of_content_type("application/cbor"), Dialect::cbor);
  EXPECT_EQ(dialect_of_content_type("application/octet-stream"), Dialect::automatic);
  EXPECT_EQ(dialect_of_content_type("application/jsonx"), Dialect::automatic);
  EXPECT_EQ(dialect_of_content_type(""), Dialect::automatic);
}

TEST(Dialect, IsToldByTheFirstBytes) {
  EXPECT_EQ(dialect_of_payload(" \r\n\t{"), Dialect::json);
  EXPECT_EQ(dialect_of_payload("\xEF\xBB\xBF{"), Dialect::json);
  EXPECT_EQ(dialect_of_payload("\xA1"), Dialect::cbor);
  EXPECT_EQ(dialect_of_payload("\xBF"), Dialect::cbor);
  EXPECT_EQ(dialect_of_payload("\xD9\xD9\xF7\xA1"), Dialect::cbor);
}

TEST(Dialect, RefusesWhatLooksLikeNone) {
  for (const char* payload : {"", " ", "[1]", "hello", "<scan/>", "\xC0", "null"}) {
    EXPECT_TRUE(refusal(payload).starts_with("malformed payload:")) << payload;
  }
}

TEST(Dialect, OfTheContentTypeGoesFirst) {
  EXPECT_TRUE(refusal("\xA1", "application/json").starts_with("malformed"));
  const ScanPayloadConfig cbor{.dialect = Dialect::cbor};
  EXPECT_EQ(refusal(json(some_scan({1.0F})), "application/json", cbor), "decoded");
}

TEST(Dialect, OfTheConfigurationGoesBeforeTheFirstBytes) {
  const ScanPayloadConfig cbor{.dialect = Dialect::cbor};
  EXPECT_TRUE(refusal(json(some_scan({1.0F})), "", cbor).starts_with("malformed"));
}

TEST(ScanDecoder, RefusesPayloadsAboveTheLimit) {
  const std::string text = json(some_scan({1.0F}));
  EXPECT_EQ(refusal(text, "", {.max_payload_bytes = text.size()}), "decoded");
  EXPECT_TRUE(refusal(text, "", {.max_payload_bytes = text.size() - 1}).starts_with("too_large"));
}

TEST(ScanDecoder, ReusesTheMemoryOfTheScan) {
  ScanDecoder decoder;
  core::Scan scan;
  decoder.decode(json(some_scan(std::vector<float>(360, 1.0F))), "", scan);
  const float* memory = scan.ranges_m.data();
  decoder.decode(json(some_scan(std::vector<float>(300, 2.0F))), "", scan);
  EXPECT_EQ(scan.ranges_m.data(), memory);
  EXPECT_EQ(scan.ranges_m, std::vector<float>(300, 2.0F));
}

TEST(ScanDecoder, LeavesNothingOfTheScanBefore) {
  ScanDecoder decoder;
  core::Scan scan = some_scan({1.0F, 2.0F});
  scan.odometry = core::Pose{1.0, 2.0, 3.0};
  decoder.decode(json(some_scan({5.0F})), "", scan);
  EXPECT_TRUE(same(scan, some_scan({5.0F})));
}

RC_GTEST_PROP(ScanDecoder, SurvivesGarbage, (const std::string& garbage)) {
  RC_ASSERT(refusal(garbage) != "decoded");
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
