// SPDX-License-Identifier: Apache-2.0
// What was stored, as JSON and CSV: scores, incidents, evidence.
//
// Names ending in "At" are times by the service's clock, names ending in "Time" (and a score's
// "time") by the robot's; both are RFC 3339. `stamp` is always {sec, nanosec}, as in ROS.
#pragma once

#include <span>
#include <string>

#include "adapters/codecs/json.hpp"
#include "core/incident.hpp"
#include "core/score_buckets.hpp"
#include "core/sight.hpp"

namespace kidnapwatch::adapters::codecs {

[[nodiscard]] Json json(const core::MotionScore& motion);
[[nodiscard]] Json json(const core::Score& score);

[[nodiscard]] Json json(const core::Incident& incident);
/// What people did about it; members without anything to say are left out.
void set_care(Json& object, const core::Incident& incident);

/// What an alert tells of the change that it stands for: when, who, what. `alert_message` is one of
/// alert_message().
[[nodiscard]] Json change_json(const std::string& alert_message);

/// As text, like all that has scans: {"before", "after"}, or less where there are fewer than two.
[[nodiscard]] std::string scans_json(std::span<const core::Scan> scans);

/// As text: both scans as sensor_msgs/LaserScan, with null for a beam that is NaN or infinite, the
/// scores, and what the detectors saw between the scans.
[[nodiscard]] std::string evidence_json(const core::Evidence& evidence, const core::Sight& sight);

/// RFC 4180, a header line with the names of json(Score) first. An absent threshold is empty.
[[nodiscard]] std::string scores_csv(std::span<const core::Score> scores);

/// {min, max, mean} of each kind of score that there was.
/// RFC 4180, with a header line: the members of json(incident); what is absent is an empty cell.
[[nodiscard]] std::string incidents_csv(std::span<const core::Incident> incidents);

[[nodiscard]] Json json(const core::ScoreBucket& bucket);
/// As scores_csv, with columns scoreMin, scoreMax, scoreMean and so on; empty where there was none.
[[nodiscard]] std::string score_buckets_csv(std::span<const core::ScoreBucket> buckets);

}  // namespace kidnapwatch::adapters::codecs
