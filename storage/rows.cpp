// SPDX-License-Identifier: Apache-2.0
// Values of core as rows, and back.
#include "storage/rows.hpp"

#include <bit>
#include <cstring>

#include "storage/bytes.hpp"

namespace kidnapwatch::storage {
namespace {

static_assert(std::endian::native == std::endian::little, "float blobs are little-endian");

std::optional<core::Pose> pose_from(const Statement& row, int first) {
  if (row.is_null(first)) return std::nullopt;
  return core::Pose{row.real(first), row.real(first + 1), row.real(first + 2)};
}

/// A byte for the detector, then its score, for each.
std::vector<std::byte> bytes_of(const std::vector<core::DetectorScore>& others) {
  ByteWriter out;
  for (const auto& [detector, score] : others) {
    out.put(detector);
    out.put(score);
  }
  return {out.bytes().begin(), out.bytes().end()};
}

std::vector<core::DetectorScore> others_from(std::span<const std::byte> bytes) {
  std::vector<core::DetectorScore> others;
  for (ByteReader in(bytes); !in.at_end();) {
    const auto detector = known_detector(in.get<std::uint8_t>());
    others.push_back({detector, in.get<float>()});
  }
  return others;
}

/// The flags, then a float for each part that there is.
std::vector<std::byte> bytes_of(const std::optional<core::MotionScore>& motion) {
  ByteWriter out;
  out.put(motion_flags(motion));
  if (motion) {
    for (const auto& part : {std::optional(motion->score), std::optional(motion->carry),
                             motion->confirmed, motion->threshold}) {
      if (part) out.put(static_cast<float>(*part));
    }
  }
  return {out.bytes().begin(), out.bytes().end()};
}

std::optional<core::MotionScore> motion_from(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  auto motion = motion_with(in.get<std::uint8_t>());
  if (!motion) return motion;
  const auto next = [&] { return static_cast<double>(in.get<float>()); };
  motion->score = next();
  motion->carry = next();
  if (motion->confirmed) motion->confirmed = next();
  if (motion->threshold) motion->threshold = next();
  return motion;
}

}  // namespace

std::uint8_t motion_flags(const std::optional<core::MotionScore>& motion) {
  if (!motion) return 0;
  return static_cast<std::uint8_t>(1U | (motion->confirmed ? 2U : 0U) |
                                   (motion->threshold ? 4U : 0U));
}

std::optional<core::MotionScore> motion_with(std::uint8_t flags) {
  if (flags == 0) return std::nullopt;
  if (flags > 7 || flags % 2 == 0) throw StorageError::damage("a motion score has unknown parts");
  core::MotionScore motion;
  if ((flags & 2U) != 0) motion.confirmed = 0.0;
  if ((flags & 4U) != 0) motion.threshold = 0.0;
  return motion;
}

core::DetectorId known_detector(std::uint8_t number) {
  if (number >= core::kDetectorNames.size()) {
    throw StorageError::damage("a score of detector " + std::to_string(number) +
                               ", which is unknown");
  }
  return core::DetectorId{number};
}

std::vector<float> floats(std::span<const std::byte> bytes) {
  std::vector<float> values(bytes.size() / sizeof(float));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

core::Score score_from(const Statement& row, int first) {
  core::Score score;
  score.stamp = row.stamp(first);
  score.reference = row.stamp(first + 1);
  score.dissimilarity.cost = row.real(first + 2);
  score.dissimilarity.cost_per_beam = row.real(first + 3);
  score.dissimilarity.standardized = row.integer(first + 4) != 0;
  if (!row.is_null(first + 5)) score.threshold = row.real(first + 5);
  score.state = static_cast<core::RobotState>(row.integer(first + 6));
  score.others = others_from(row.blob(first + 7));
  score.motion = motion_from(row.blob(first + 8));
  return score;
}

void bind_score(Statement& insert, std::int64_t robot, core::Stamp arrival,
                const core::Score& score) {
  insert.bind(robot, arrival, score.stamp, score.reference, score.dissimilarity.cost,
              score.dissimilarity.cost_per_beam, score.dissimilarity.standardized, score.threshold,
              static_cast<int>(score.state), bytes_of(score.others), bytes_of(score.motion));
}

core::Incident incident_from(const Statement& row) {
  core::Incident incident;
  incident.id = row.text(0);
  incident.robot = row.text(1);
  incident.seq = static_cast<std::uint32_t>(row.integer(2));
  incident.kind = core::incident_kind(row.text(3), "kind");
  incident.state = core::incident_state(row.text(4), "state");
  incident.opened_at = row.stamp(5);
  if (!row.is_null(6)) incident.resolved_at = row.stamp(6);
  incident.scan_stamp = row.stamp(7);
  incident.before_stamp = row.stamp(8);
  incident.after_stamp = row.stamp(9);
  incident.detector = row.text(10);
  incident.score = row.real(11);
  incident.threshold = row.real(12);
  incident.config_version = row.integer(13);
  incident.cause = core::cause(row.text(14), "cause");
  incident.acknowledged_by = row.text(15);
  incident.resolved_by = row.text(16);
  if (!row.is_null(17)) incident.shelved_until = row.stamp(17);
  if (!row.is_null(18)) incident.label = core::incident_label(row.text(18), "label");
  incident.comment = row.text(19);
  return incident;
}

void bind_incident(Statement& upsert, const core::Incident& incident) {
  const auto label = incident.label ? std::optional(core::name(*incident.label)) : std::nullopt;
  upsert.bind(incident.id, incident.robot, incident.seq, core::name(incident.kind),
              core::name(incident.state), incident.opened_at, incident.resolved_at,
              incident.scan_stamp, incident.before_stamp, incident.after_stamp, incident.detector,
              incident.score, incident.threshold, incident.config_version,
              core::name(incident.cause), incident.acknowledged_by, incident.resolved_by,
              incident.shelved_until, label, incident.comment);
}

core::Scan scan_from(const Statement& row) {
  core::Scan scan;
  scan.stamp = row.stamp(0);
  scan.geometry = {.angle_min_rad = row.real(1),
                   .angle_increment_rad = row.real(2),
                   .range_min_m = row.real(3),
                   .range_max_m = row.real(4)};
  scan.odometry = pose_from(row, 5);
  scan.ranges_m = floats(row.blob(8));
  return scan;
}

void bind_scan(Statement& insert, const std::string& incident_id, bool is_after,
               const core::Scan& scan) {
  const auto& lidar = scan.geometry;
  const auto part = [&](double core::Pose::*member) {
    return scan.odometry ? std::optional((*scan.odometry).*member) : std::nullopt;
  };
  insert.bind(incident_id, is_after, scan.stamp, lidar.angle_min_rad, lidar.angle_increment_rad,
              lidar.range_min_m, lidar.range_max_m, part(&core::Pose::x_m), part(&core::Pose::y_m),
              part(&core::Pose::theta_rad), std::as_bytes(std::span(scan.ranges_m)));
}

}  // namespace kidnapwatch::storage
