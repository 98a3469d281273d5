// SPDX-License-Identifier: Apache-2.0
// Routes: the configuration of detection, versioned.
#pragma once

#include "api/call.hpp"

namespace kidnapwatch::api {

/// 304 if the client has that version already.
[[nodiscard]] Response get_config(const Call& call);
/// Replaces it whole; 412 if If-Match names another version than the current one.
[[nodiscard]] Response put_config(const Call& call);

}  // namespace kidnapwatch::api
