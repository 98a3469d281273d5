// SPDX-License-Identifier: Apache-2.0
// What REST needs to know and to do: the running fleet, and its history.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "adapters/codecs/json.hpp"
#include "core/incident.hpp"
#include "core/incident_command.hpp"
#include "core/score_buckets.hpp"
#include "core/status.hpp"

namespace kidnapwatch::api {

using adapters::codecs::Json;

/// A level of the configuration as somebody set it: the fleet's, or a robot's.
struct ConfigChange {
  std::int64_t version = 0;  ///< counts the changes of all levels, from 1
  core::Stamp since;
  std::string author;
  std::string robot;             ///< empty: the fleet's level
  Json values = Json::object();  ///< what is left out is inherited

  friend bool operator==(const ConfigChange&, const ConfigChange&) = default;
};

/// What is in force, and why: defaults <- fleet <- robot.
struct ConfigView {
  core::ConfigVersion effective;  ///< its version is that of the latest change that bears on it
  Json fleet = Json::object();    ///< the values that the fleet's level sets
  Json robot = Json::object();    ///< the values that the robot's level sets
};

/// Which changes of the configuration, newest first.
struct ConfigQuery {
  std::optional<std::string> robot;    ///< of this level; empty: the fleet's
  std::optional<std::int64_t> before;  ///< only earlier versions
  std::size_t limit = 100;
};

/// Thrown by put_config where the configuration is not the version that the caller saw.
struct VersionConflict {
  std::int64_t current = 0;
};

/// Thrown where the service is too busy to say more than that.
struct Unavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The running service. Every function may be called from any thread and answers from memory, but
/// for those that say that they throw Unavailable: they wait for the robot's turn.
class Fleet {
 public:
  virtual ~Fleet() = default;
  /// Ordered by id.
  [[nodiscard]] virtual std::vector<core::RobotStatus> robots() const = 0;
  [[nodiscard]] virtual std::optional<core::RobotStatus> robot(const std::string& id) const = 0;
  [[nodiscard]] virtual core::ServiceStatus status() const = 0;
  /// Of this robot; of robots without a level of their own if `robot` is empty.
  [[nodiscard]] virtual ConfigView config(const std::string& robot) const = 0;
  /// Sets the level of this robot, or the fleet's if `robot` is empty, to exactly these values.
  /// Takes effect with the next scan, is durable once it returned. Throws BadInput naming the
  /// member that is unknown, or out of range for this robot or any that inherits it;
  /// VersionConflict unless `seen_version` is that of config(robot).
  virtual ConfigView put_config(const std::string& robot, const Json& values,
                                std::int64_t seen_version, const std::string& author) = 0;
  /// The robot's last two good scans, oldest first; fewer if there were not so many, or there is no
  /// such robot. Throws Unavailable.
  [[nodiscard]] virtual std::vector<core::Scan> last_scans(const std::string& robot) = 0;
  /// The incident after a command that passed check(), as it is stored; nothing where its state
  /// does not allow it, or there is none. Throws Unavailable.
  virtual std::optional<core::Incident> change_incident(const std::string& id,
                                                        const core::IncidentCommand& command) = 0;
};

struct TimeRange {
  core::Stamp from = core::Stamp::min();
  core::Stamp to = core::Stamp::max();  ///< exclusive
};

/// Which incidents, newest first.
struct IncidentQuery {
  std::optional<std::string> robot;
  std::optional<core::IncidentState> state;
  std::optional<core::IncidentKind> kind;
  std::optional<core::IncidentLabel> label;
  TimeRange opened_at;
  std::optional<std::string> before_id;  ///< go on after the page that ended with this incident
  std::size_t limit = 100;
};

/// An alert as it was told, for those who follow them all.
struct NumberedAlert {
  std::int64_t number = 0;  ///< greater than those of all before
  std::string robot;
  std::string json;  ///< the message, on one line
};

/// Of the alerts that a follower can still be told.
struct AlertNumbers {
  std::int64_t first = 1;  ///< that is kept; last + 1 if none is
  std::int64_t last = 0;   ///< that was ever given
};

/// What was stored. Every function may be called from any thread; each is one consistent read.
class History {
 public:
  virtual ~History() = default;
  /// By stamp, oldest first, at most `limit`.
  [[nodiscard]] virtual std::vector<core::Score> scores(const std::string& robot, TimeRange stamps,
                                                        std::size_t limit) const = 0;
  /// The same scores in buckets, oldest first, at most `limit` of them; wider ones than asked for
  /// where single scores are gone, or where `resolution` does not fit into minutes and hours.
  [[nodiscard]] virtual std::vector<core::ScoreBucket> score_buckets(
      const std::string& robot, TimeRange stamps, std::chrono::seconds resolution,
      std::size_t limit) const = 0;
  [[nodiscard]] virtual std::vector<core::Incident> incidents(const IncidentQuery& query) const = 0;
  [[nodiscard]] virtual std::optional<core::Incident> incident(const std::string& id) const = 0;
  [[nodiscard]] virtual std::optional<core::Evidence> evidence(
      const std::string& incident_id) const = 0;
  /// In the order in which they came about, at most `limit`, only those after number `after`.
  [[nodiscard]] virtual std::vector<NumberedAlert> alerts(std::int64_t after,
                                                          std::size_t limit) const = 0;
  /// Of an incident, oldest first.
  [[nodiscard]] virtual std::vector<NumberedAlert> alerts_of(
      const std::string& incident_id) const = 0;
  [[nodiscard]] virtual AlertNumbers alert_numbers() const = 0;
  [[nodiscard]] virtual std::vector<ConfigChange> configs(const ConfigQuery& query) const = 0;
};

}  // namespace kidnapwatch::api
