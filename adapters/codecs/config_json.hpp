// SPDX-License-Identifier: Apache-2.0
// The configuration of detection as JSON: the members of core's structs under their own names.
#pragma once

#include "adapters/codecs/json.hpp"
#include "core/session.hpp"

namespace kidnapwatch::adapters::codecs {

/// Every member; `threshold` is null where it is calibrated.
[[nodiscard]] Json json(const core::DetectionConfig& config);

/// `base` with the members that `object` has. Throws BadInput naming the member ("calibration.
/// window_pairs") that is unknown or of the wrong type; whether values are in range is for
/// core::check to say.
[[nodiscard]] core::DetectionConfig detection_config(const Json& object,
                                                     const core::DetectionConfig& base = {});

/// For every member of `effective`, by its path ("calibration.window_pairs"), the level that it
/// comes from: "robot" or "fleet" where these set it, else "default".
[[nodiscard]] Json config_origins(const core::DetectionConfig& effective, const Json& fleet,
                                  const Json& robot);

}  // namespace kidnapwatch::adapters::codecs
