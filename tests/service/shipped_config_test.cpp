// SPDX-License-Identifier: Apache-2.0
// The configuration that is shipped says what the defaults are.
#include <gtest/gtest.h>

#include "service/settings.hpp"

namespace kidnapwatch::service {
namespace {

TEST(ShippedConfig, NamesEverySettingThatHasNoSecretWithItsDefault) {
  const Sources file{.file = KW_SHIPPED_CONFIG,
                     .environment = [](const std::string&) { return std::nullopt; },
                     .flags = {}};
  const auto shipped = load_settings(file);
  const Settings defaults;
  for (const auto& setting : all_settings()) {
    EXPECT_EQ(setting.show(shipped.settings), setting.show(defaults)) << setting.key;
    EXPECT_EQ(shipped.origins.at(setting.key) == "default", setting.secret) << setting.key;
  }
}

}  // namespace
}  // namespace kidnapwatch::service
