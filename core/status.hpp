// SPDX-License-Identifier: Apache-2.0
// What the running service knows of its robots and of itself, as values to look at.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/durations.hpp"
#include "core/outcome.hpp"
#include "core/robot_command.hpp"
#include "core/session.hpp"

namespace kidnapwatch::core {

struct RobotStatus {
  std::string id;
  RobotState state = RobotState::unknown;
  std::optional<Trouble> trouble;              ///< why it is degraded
  Stamp last_arrival;                          ///< of any scan, by the service's clock
  std::optional<Score> score;                  ///< the latest
  std::optional<double> threshold;             ///< of QS-2DDTW
  std::optional<double> motion_threshold;      ///< of motion consistency, in force
  std::optional<double> own_motion_threshold;  ///< without fleet and configuration
  std::uint64_t calibration_pairs = 0;
  std::uint64_t warmup_pairs = 0;          ///< calibration_pairs needed before there is a threshold
  std::optional<std::string> incident_id;  ///< of the open incident
  OutcomeCounts counts{};                  ///< since the service started
};

/// Something that the service cannot do as it should.
struct Degradation {
  std::string name;  ///< "broker", "store", "quarantine", "clock", "overload"
  std::string what;  ///< a sentence for the operator

  friend bool operator==(const Degradation&, const Degradation&) = default;
};

struct ServiceStatus {
  std::string version;
  Stamp started;
  std::uint64_t robots = 0;
  bool broker_connected = false;
  bool store_healthy = false;
  std::uint64_t queued_scans = 0;     ///< waiting in all lanes
  std::uint64_t queued_writes = 0;    ///< waiting for the store
  std::uint64_t lost_writes = 0;      ///< refused because the store's queue was full
  std::uint64_t store_bytes = 0;      ///< on the disk
  Durations judging;                  ///< from a scan's arrival until its alert is on its way
  Durations commits;                  ///< of the store
  std::vector<Degradation> degraded;  ///< empty: all is well
  OutcomeCounts counts{};             ///< of all robots and of messages that belong to none
  CommandCounts commands{};           ///< by MQTT
};

/// A configuration as somebody set it.
struct ConfigVersion {
  std::int64_t version = 0;  ///< 0: the service's own start configuration
  Stamp since;
  std::string author;
  DetectionConfig config;
};

}  // namespace kidnapwatch::core
