// SPDX-License-Identifier: Apache-2.0
// What the service says over MQTT, in JSON: alerts, states, scores, its own status.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/incident.hpp"
#include "core/status.hpp"

namespace kidnapwatch::adapters::codecs {

/// The member `schema` of each message, and the MQTT 5 user property of the same name.
inline constexpr std::string_view kAlertSchema = "kidnapwatch/alert/1";
inline constexpr std::string_view kStateSchema = "kidnapwatch/state/1";
inline constexpr std::string_view kScoreSchema = "kidnapwatch/score/1";
inline constexpr std::string_view kServiceStatusSchema = "kidnapwatch/service-status/1";

/// The incident's full state after the change. No member is ever null.
[[nodiscard]] std::string alert_message(const core::Alert& alert);

/// The robot's state, its threshold and its open incident where it has them.
[[nodiscard]] std::string state_message(const core::RobotStatus& robot, core::Stamp now);

[[nodiscard]] std::string score_message(std::string_view robot, const core::Score& score);

/// `status`: online, stopped or offline; with the names of what is degraded.
[[nodiscard]] std::string service_status_message(std::string_view status, std::string_view version,
                                                 core::Stamp started,
                                                 std::span<const core::Degradation> degraded = {});

}  // namespace kidnapwatch::adapters::codecs
