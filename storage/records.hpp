// SPDX-License-Identifier: Apache-2.0
// What goes into the store and comes out of it, where core has no type for it.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/incident.hpp"
#include "core/session.hpp"

namespace kidnapwatch::storage {

/// An alert that is to be delivered at least once: until the receiver has confirmed it, and the
/// latest of an incident as long as that is unresolved.
struct OutboxMessage {
  std::string event_id;  ///< the same message again is ignored
  std::string robot;
  std::string payload;  ///< as it is to be published
  bool delivered = false;

  friend bool operator==(const OutboxMessage&, const OutboxMessage&) = default;
};

/// An alert as it was stored, for those who follow them all.
struct StoredAlert {
  std::int64_t number = 0;  ///< greater than that of all committed before, from 1, with holes
  std::string robot;
  std::string payload;

  friend bool operator==(const StoredAlert&, const StoredAlert&) = default;
};

/// What a follower can still be told.
struct AlertNumbers {
  std::int64_t first = 0;  ///< of those that are kept; last + 1 if none is
  std::int64_t last = 0;   ///< that was ever given; 0 before the first

  friend bool operator==(const AlertNumbers&, const AlertNumbers&) = default;
};

/// A new or changed incident, and all that is stored with it in one transaction.
struct IncidentChange {
  core::Incident incident;
  core::AlertType type = core::AlertType::opened;  ///< for the audit trail
  /// Kept from the first change that has it.
  std::optional<core::ScanPair> evidence = std::nullopt;
  std::optional<OutboxMessage> alert = std::nullopt;
  core::Stamp changed_at = {};         ///< for the audit trail
  std::string author = "kidnapwatch";  ///< for the audit trail
};

/// Scores that are missing from the store, by time of arrival.
struct Gap {
  core::Stamp since;                                   ///< the last one before, or the first lost
  core::Stamp until;                                   ///< the first one after, or the last lost
  std::string reason;                                  ///< "crash", "overload"
  std::optional<std::uint64_t> scores = std::nullopt;  ///< after a crash nobody knows how many

  friend bool operator==(const Gap&, const Gap&) = default;
};

/// How far around the scans of an incident scores are part of its evidence.
inline constexpr std::chrono::seconds kAroundEvidence{10};

/// Who did what to what.
struct AuditEntry {
  core::Stamp at;
  std::string actor;
  std::string action;  ///< "incident.open", "config.set", ...
  std::string subject;
  std::string detail;

  friend bool operator==(const AuditEntry&, const AuditEntry&) = default;
};

struct NumberedAuditEntry {
  std::int64_t number = 0;  ///< from 1, without holes
  AuditEntry entry;

  friend bool operator==(const NumberedAuditEntry&, const NumberedAuditEntry&) = default;
};

/// A level of the configuration as somebody set it; the text is the caller's.
struct ConfigText {
  std::int64_t version = 0;
  core::Stamp since;
  std::string author;
  std::string text;
  std::string robot = {};  ///< whose level; empty: the fleet's

  friend bool operator==(const ConfigText&, const ConfigText&) = default;
};

/// Which changes of the configuration, newest first; nothing set means all.
struct ConfigFilter {
  std::optional<std::string> robot = std::nullopt;    ///< of this level; empty: the fleet's
  std::optional<std::int64_t> before = std::nullopt;  ///< only earlier versions
  std::size_t limit = 100;
};

/// Which incidents; nothing set means all.
struct IncidentFilter {
  std::optional<std::string> robot = std::nullopt;
  std::optional<core::IncidentState> state = std::nullopt;
  std::optional<core::IncidentKind> kind = std::nullopt;
  std::optional<core::IncidentLabel> label = std::nullopt;
  core::Stamp opened_from = core::Stamp::min();
  core::Stamp opened_to = core::Stamp::max();           ///< exclusive
  std::optional<std::string> before_id = std::nullopt;  ///< only older ones than this
  std::size_t limit = 100;
};

/// Where a robot stood when the service stopped.
struct RobotHistory {
  std::string robot;
  core::Stamp last_arrival;  ///< of the latest score, by the service's clock
  core::Score latest;
  std::vector<double> natural_scores;  ///< costs while normal or unknown, oldest first
  std::vector<float> learned;          ///< as it was put last
};

}  // namespace kidnapwatch::storage
