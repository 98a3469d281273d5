// SPDX-License-Identifier: Apache-2.0
// The routes that help to choose a threshold, from what was stored.
#pragma once

#include "api/call.hpp"

namespace kidnapwatch::api {

[[nodiscard]] Response preview_threshold(const Call& call);
[[nodiscard]] Response calibrate_threshold(const Call& call);
[[nodiscard]] Response get_roc(const Call& call);

}  // namespace kidnapwatch::api
