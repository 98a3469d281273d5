// SPDX-License-Identifier: Apache-2.0
// CBOR's items, after the examples in RFC 8949, appendix A.
#include "adapters/codecs/cbor_reader.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core/outcome.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

using namespace std::string_literals;

std::optional<double> number_in(const std::string& bytes) {
  CborReader reader(bytes);
  return number(reader.head());
}

/// Whether one item fills `bytes` exactly.
bool is_one_item(const std::string& bytes) {
  CborReader reader(bytes);
  try {
    reader.skip(reader.head());
  } catch (const core::BadScan& bad) {
    EXPECT_EQ(bad.outcome(), core::Outcome::malformed);
    return false;
  }
  return reader.at_end();
}

TEST(CborReader, ReadsTheNumbersOfTheRfc) {
  EXPECT_EQ(number_in("\x00"s), 0.0);
  EXPECT_EQ(number_in("\x17"), 23.0);
  EXPECT_EQ(number_in("\x18\x18"), 24.0);
  EXPECT_EQ(number_in("\x19\x03\xE8"), 1000.0);
  EXPECT_EQ(number_in("\x1A\x00\x0F\x42\x40"s), 1000000.0);
  EXPECT_EQ(number_in("\x1B\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF"), 18446744073709551615.0);
  EXPECT_EQ(number_in("\x20"), -1.0);
  EXPECT_EQ(number_in("\x39\x03\xE7"), -1000.0);
  EXPECT_EQ(number_in("\xF9\x3C\x00"s), 1.0);
  EXPECT_EQ(number_in("\xF9\x3E\x00"s), 1.5);
  EXPECT_EQ(number_in("\xF9\x7B\xFF"), 65504.0);
  EXPECT_EQ(number_in("\xF9\x00\x01"s), 5.960464477539063e-8);
  EXPECT_EQ(number_in("\xF9\x04\x00"s), 0.00006103515625);
  EXPECT_EQ(number_in("\xF9\xC4\x00"s), -4.0);
  EXPECT_EQ(number_in("\xF9\x7C\x00"s), INFINITY);
  EXPECT_EQ(number_in("\xF9\xFC\x00"s), -INFINITY);
  EXPECT_TRUE(std::isnan(*number_in("\xF9\x7E\x00"s)));
  EXPECT_EQ(number_in("\xFA\x47\xC3\x50\x00"s), 100000.0);
  EXPECT_EQ(number_in("\xFB\xC0\x10\x66\x66\x66\x66\x66\x66"), -4.1);
}

TEST(CborReader, TellsNumbersFromOtherTypes) {
  for (const auto& bytes : {"\x40"s, "\x60"s, "\x80"s, "\xA0"s, "\xC0\x00"s, "\xF4"s, "\xF6"s}) {
    EXPECT_EQ(number_in(bytes), std::nullopt);
  }
}

TEST(CborReader, PassesOverAnyItem) {
  for (const auto& bytes :
       {"\x00"s, "\x43\x01\x02\x03"s, "\x62hi"s, "\x82\x01\x02"s, "\xA1\x61k\x81\x00"s,
        "\xC1\x1A\x51\x4B\x67\xB0"s, "\xF6"s, "\xF8\xFF"s, "\x9F\x01\x82\x02\x03\xFF"s,
        "\xBF\x61k\x9F\xFF\xFF"s, "\x5F\x42\x01\x02\x41\x03\xFF"s, "\x7F\x61x\x61y\xFF"s}) {
    EXPECT_TRUE(is_one_item(bytes)) << testing::PrintToString(bytes);
  }
}

TEST(CborReader, RefusesWhatIsNotWellFormed) {
  for (const auto& bytes :
       {""s, "\x18"s, "\x1C"s, "\x1F"s, "\x3F"s, "\xDF\x00"s, "\xFF"s, "\x41"s, "\x82\x01"s,
        "\xA1\x00"s, "\x9F\x01"s, "\xBF\x01\xFF"s, "\x5F\x61x\xFF"s, "\x5F\x5F\xFF\xFF"s,
        "\x5B\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x00"s, "\x9B\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x00"s}) {
    EXPECT_FALSE(is_one_item(bytes)) << testing::PrintToString(bytes);
  }
}

TEST(CborReader, RefusesDeepNesting) {
  EXPECT_TRUE(is_one_item(std::string(30, '\x81') + "\x00"s));
  EXPECT_FALSE(is_one_item(std::string(100, '\x81') + "\x00"s));
  EXPECT_FALSE(is_one_item(std::string(1'000'000, '\x9F')));
  EXPECT_FALSE(is_one_item(std::string(1'000'000, '\xC1')));
}

TEST(CborReader, PassesOverKeysThatAreNoText) {
  const std::string map = "\xA4\x01\x02\x61k\x03\x7F\x61x\xFF\x04\x81\x00\x05"s;
  CborReader reader(map);
  std::string keys;
  reader.for_each_entry(reader.head(), [&](std::string_view key) {
    keys += key;
    EXPECT_EQ(number(reader.head()), 3.0);
  });
  EXPECT_EQ(keys, "k");
  EXPECT_TRUE(reader.at_end());
}

RC_GTEST_PROP(CborReader, SurvivesAnything, (const std::string& bytes)) {
  (void)is_one_item(bytes);
}

}  // namespace
}  // namespace kidnapwatch::adapters::codecs
