// SPDX-License-Identifier: Apache-2.0
// Every outcome has its name.
#include "core/outcome.hpp"

#include <set>

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

TEST(OutcomeName, IsTheEnumerators) {
  EXPECT_EQ(name(Outcome::scored), "scored");
  EXPECT_EQ(name(Outcome::first), "first");
  EXPECT_EQ(name(Outcome::not_comparable), "not_comparable");
  EXPECT_EQ(name(Outcome::repeated), "repeated");
  EXPECT_EQ(name(Outcome::out_of_order), "out_of_order");
  EXPECT_EQ(name(Outcome::malformed), "malformed");
  EXPECT_EQ(name(Outcome::missing_field), "missing_field");
  EXPECT_EQ(name(Outcome::wrong_type), "wrong_type");
  EXPECT_EQ(name(Outcome::no_beams), "no_beams");
  EXPECT_EQ(name(Outcome::too_many_beams), "too_many_beams");
  EXPECT_EQ(name(Outcome::bad_geometry), "bad_geometry");
  EXPECT_EQ(name(Outcome::too_large), "too_large");
  EXPECT_EQ(name(Outcome::unknown_topic), "unknown_topic");
  EXPECT_EQ(name(Outcome::bad_robot_id), "bad_robot_id");
  EXPECT_EQ(name(Outcome::too_many_robots), "too_many_robots");
  EXPECT_EQ(name(Outcome::overload), "overload");
  EXPECT_EQ(name(Outcome::failed), "failed");
}

TEST(OutcomeName, IsAnotherForEachOfThem) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kOutcomes; ++i) {
    names.insert(name(static_cast<Outcome>(i)));
  }
  EXPECT_EQ(names.size(), kOutcomes);
  EXPECT_FALSE(names.contains(""));
}

TEST(BadScan, CarriesTheOutcomeToCount) {
  const BadScan error(Outcome::no_beams, "ranges", "has no beams");
  EXPECT_EQ(error.outcome(), Outcome::no_beams);
  EXPECT_EQ(error.field(), "ranges");
  EXPECT_STREQ(error.what(), "ranges: has no beams");
}

}  // namespace
}  // namespace kidnapwatch::core
