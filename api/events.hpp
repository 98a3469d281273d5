// SPDX-License-Identifier: Apache-2.0
// Route: events as they come, as Server-Sent Events.
#pragma once

#include "api/call.hpp"

namespace kidnapwatch::api {

/// Alerts in the order of their numbers, from the one after Last-Event-ID, else from now on: none
/// is left out and none repeated, however often a client comes back. Beside them the robots, when
/// they change.
[[nodiscard]] Response get_events(const Call& call);

}  // namespace kidnapwatch::api
