// SPDX-License-Identifier: Apache-2.0
// What the service knows of its robots and of itself, as JSON.
#pragma once

#include "adapters/codecs/json.hpp"
#include "core/status.hpp"

namespace kidnapwatch::adapters::codecs {

[[nodiscard]] Json json(const core::RobotStatus& robot);

/// What changes from scan to scan, in few words: for those who watch a thousand robots.
[[nodiscard]] Json brief_json(const core::RobotStatus& robot);

[[nodiscard]] Json json(const core::ServiceStatus& service);

}  // namespace kidnapwatch::adapters::codecs
