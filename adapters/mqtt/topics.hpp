// SPDX-License-Identifier: Apache-2.0
// Topics: how they are named, and what a name means.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kidnapwatch::adapters::mqtt {

enum class TopicKind : std::uint8_t {
  scan,
  odom,
  particles,
  command,
  own,           ///< one that the service publishes: alert, state, score, response, service/status
  bad_robot_id,  ///< of one of the kinds above, but with a robot id that is none
  unknown,
};

struct Topic {
  TopicKind kind = TopicKind::unknown;
  std::string_view robot;  ///< a valid robot id exactly for scan, odom, particles and command
};

struct TopicsConfig {
  std::string prefix = "kidnapwatch/v1";
  /// Further filters of scan topics, each with exactly one level `+`, which is the robot id.
  std::vector<std::string> scan_filters;
};

/// The topics of kidnapwatch/v1, as INTERFACES has them: {prefix}/{robot}/{kind}.
class Topics {
 public:
  /// Throws BadInput naming `prefix` or `scan_filters`.
  explicit Topics(const TopicsConfig& config = {});

  [[nodiscard]] std::string scan(std::string_view robot) const { return of(robot, "scan"); }
  [[nodiscard]] std::string odom(std::string_view robot) const { return of(robot, "odom"); }
  [[nodiscard]] std::string particles(std::string_view robot) const {
    return of(robot, "particles");
  }
  [[nodiscard]] std::string alert(std::string_view robot) const { return of(robot, "alert"); }
  [[nodiscard]] std::string state(std::string_view robot) const { return of(robot, "state"); }
  [[nodiscard]] std::string score(std::string_view robot) const { return of(robot, "score"); }
  [[nodiscard]] std::string command(std::string_view robot) const { return of(robot, "command"); }
  [[nodiscard]] std::string service_status() const { return of("service", "status"); }

  /// Whether a command to `robot` may ask for its answer on `topic`: on {prefix}/{robot}/response
  /// or below it, or away from the prefix, where the broker's ACL says what the service may do.
  /// Else a robot could have the service speak in its own name, or another's.
  [[nodiscard]] bool may_answer(std::string_view robot, std::string_view topic) const;

  /// All that is to be subscribed to: everything below the prefix, so that messages on unknown
  /// topics can be counted, and the scan filters.
  [[nodiscard]] std::vector<std::string> filters() const;

  /// What arrived on `topic`; `robot` is a part of it.
  [[nodiscard]] Topic parse(std::string_view topic) const;

 private:
  /// A scan filter, split at its `+`.
  struct ScanFilter {
    std::string before;
    std::string after;
  };

  [[nodiscard]] std::string of(std::string_view robot, std::string_view kind) const;
  [[nodiscard]] Topic below_prefix(std::string_view rest) const;

  std::string prefix_;  // with the slash at its end
  std::vector<ScanFilter> scan_filters_;
};

}  // namespace kidnapwatch::adapters::mqtt
