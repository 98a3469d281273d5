// SPDX-License-Identifier: Apache-2.0
// The routes of the configuration of detection: the fleet's, each robot's, and their history.
#pragma once

#include "api/call.hpp"

namespace kidnapwatch::api {

// Of the robot {id}, or of the fleet where the path has none.
[[nodiscard]] Response get_config(const Call& call);
[[nodiscard]] Response put_config(const Call& call);
[[nodiscard]] Response patch_config(const Call& call);
[[nodiscard]] Response delete_config(const Call& call);

[[nodiscard]] Response get_config_history(const Call& call);
/// {id} is the version whose values are to be in force again.
[[nodiscard]] Response restore_config(const Call& call);

}  // namespace kidnapwatch::api
