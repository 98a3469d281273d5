// SPDX-License-Identifier: Apache-2.0
// Routes: robots, and how their scores went.
#pragma once

#include "api/call.hpp"

namespace kidnapwatch::api {

[[nodiscard]] Response get_robots(const Call& call);
[[nodiscard]] Response get_robot(const Call& call);
/// JSON, or CSV where the client prefers it.
/// The last two good scans.
[[nodiscard]] Response get_scans(const Call& call);
[[nodiscard]] Response get_scores(const Call& call);

}  // namespace kidnapwatch::api
