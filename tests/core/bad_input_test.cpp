// SPDX-License-Identifier: Apache-2.0
// Unusable input names its field.
#include "core/bad_input.hpp"

#include <gtest/gtest.h>

namespace kidnapwatch::core {
namespace {

TEST(BadInput, SaysFieldAndReason) {
  const BadInput error("range_max", "must be finite");
  EXPECT_STREQ(error.what(), "range_max: must be finite");
  EXPECT_EQ(error.field(), "range_max");
}

}  // namespace
}  // namespace kidnapwatch::core
