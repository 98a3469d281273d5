// SPDX-License-Identifier: Apache-2.0
// Routes: incidents, and what they were concluded from.
#pragma once

#include "api/call.hpp"

namespace kidnapwatch::api {

[[nodiscard]] Response get_incidents(const Call& call);
[[nodiscard]] Response get_incident(const Call& call);
/// With what the detectors see between the two scans, by the configuration of today.
[[nodiscard]] Response get_evidence(const Call& call);
/// Who did what to it, oldest first.
[[nodiscard]] Response get_incident_history(const Call& call);

/// The last segment of the path is the action.
[[nodiscard]] Response post_incident(const Call& call);

}  // namespace kidnapwatch::api
