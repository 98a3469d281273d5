// SPDX-License-Identifier: Apache-2.0
// A kidnapping as people and programs speak of it: what was seen, and what became of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/cause.hpp"
#include "core/session.hpp"

namespace kidnapwatch::core {

enum class IncidentKind : std::uint8_t { teleport, carry };
enum class IncidentState : std::uint8_t { open, acknowledged, resolved };
/// What somebody says that it was.
enum class IncidentLabel : std::uint8_t { kidnapping, false_alarm, test };
/// What an alert tells of an incident.
enum class AlertType : std::uint8_t {
  opened,
  updated,
  acknowledged,
  unacknowledged,
  resolved,
  shelved
};

[[nodiscard]] std::string_view name(IncidentKind kind);
[[nodiscard]] std::string_view name(IncidentState state);
[[nodiscard]] std::string_view name(IncidentLabel label);
[[nodiscard]] std::string_view name(AlertType type);
/// The inverse of name(). Throws BadInput naming `field` for any other text.
[[nodiscard]] IncidentKind incident_kind(std::string_view text, std::string_view field);
[[nodiscard]] IncidentState incident_state(std::string_view text, std::string_view field);
[[nodiscard]] IncidentLabel incident_label(std::string_view text, std::string_view field);

struct Incident {
  std::string id;  ///< UUIDv7
  std::string robot;
  std::uint32_t seq = 0;  ///< changes so far; 1 when opened
  IncidentKind kind = IncidentKind::teleport;
  Cause cause = Cause::teleport;  ///< what it looks like
  IncidentState state = IncidentState::open;
  Stamp opened_at;                   ///< by the service's clock
  std::optional<Stamp> resolved_at;  ///< by the service's clock
  Stamp scan_stamp;                  ///< of the scan that confirmed the latest jump
  Stamp before_stamp;                ///< of the last good scan before the jump
  Stamp after_stamp;                 ///< of the first scan after it
  std::string detector;              ///< detector_name()
  double score = 0.0;                ///< of the jump
  double threshold = 0.0;
  std::int64_t config_version = 0;
  std::string acknowledged_by;         ///< while acknowledged
  std::string resolved_by;             ///< empty: by rule
  std::optional<Stamp> shelved_until;  ///< nobody is to be called before
  std::optional<IncidentLabel> label;
  std::string comment;

  friend bool operator==(const Incident&, const Incident&) = default;
};

/// One message about an incident: its full state after the change.
struct Alert {
  std::string event_id;  ///< UUIDv7; the same in every repetition of this message
  AlertType type = AlertType::opened;
  Stamp timestamp;  ///< by the service's clock
  Incident incident;
  std::string author = "kidnapwatch";  ///< of the change
};

/// What an incident was concluded from.
struct Evidence {
  ScanPair scans;
  std::vector<Score> scores;  ///< around the jump, oldest first
};

}  // namespace kidnapwatch::core
