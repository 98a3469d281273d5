// SPDX-License-Identifier: Apache-2.0
// Values of core as rows, and back.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/incident.hpp"
#include "core/session.hpp"
#include "storage/records.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// In the order that score_from reads them.
inline constexpr std::string_view kScoreColumns =
    "stamp, reference, cost, cost_per_beam, standardized, threshold, state, others, motion";

/// The score in columns `first`... of the current row.
[[nodiscard]] core::Score score_from(const Statement& row, int first);

/// Which of its parts a stored motion score has.
[[nodiscard]] std::uint8_t motion_flags(const std::optional<core::MotionScore>& motion);
/// The parts that `flags` names, all 0. Throws StorageError for what is none.
[[nodiscard]] std::optional<core::MotionScore> motion_with(std::uint8_t flags);

/// The detector of this number. Throws StorageError where there is none.
[[nodiscard]] core::DetectorId known_detector(std::uint8_t number);

/// In the order that incident_from reads them.
inline constexpr std::string_view kIncidentColumns =
    "id, robot, seq, kind, state, opened_at, resolved_at, scan_stamp, before_stamp, after_stamp, "
    "detector, score, threshold, config_version, cause, acknowledged_by, resolved_by, "
    "shelved_until, label, "
    "comment";

/// The incident in the current row.
[[nodiscard]] core::Incident incident_from(const Statement& row);

/// In the order that scan_from reads them.
inline constexpr std::string_view kScanColumns =
    "stamp, angle_min, angle_increment, range_min, range_max, odometry_x, odometry_y, "
    "odometry_theta, ranges";

/// The scan in the current row.
[[nodiscard]] core::Scan scan_from(const Statement& row);

/// What a blob of float32, little-endian, holds.
[[nodiscard]] std::vector<float> floats(std::span<const std::byte> bytes);

/// The statement with these values: score as ?3..., of a robot's row.
void bind_score(Statement& insert, std::int64_t robot, core::Stamp arrival,
                const core::Score& score);
/// The statement with the columns of kIncidentColumns as ?1...
void bind_incident(Statement& upsert, const core::Incident& incident);
/// The statement with ?1 incident, ?2 whether it is the scan after the jump, then kScanColumns.
void bind_scan(Statement& insert, const std::string& incident_id, bool is_after,
               const core::Scan& scan);

}  // namespace kidnapwatch::storage
