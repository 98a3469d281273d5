// SPDX-License-Identifier: Apache-2.0
// All robots: which lane watches each.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "api/ports.hpp"
#include "service/lane.hpp"

namespace kidnapwatch::service {

struct FleetConfig {
  std::size_t lanes = 2;
  std::size_t max_robots = 10'000;
  LaneConfig lane;
};

/// Any thread may call anything.
class Fleet {
 public:
  struct Outside {
    Announcer& announcer;
    std::function<core::Stamp()> now;
    std::function<core::Stamp()> uptime;  ///< as in Surroundings
    std::function<std::string(core::Stamp)> new_id;
    std::function<void(const std::string& robot, const core::BadInput& why)> log_refusal;
    /// As in Surroundings.
    std::function<std::shared_ptr<const core::ConfigVersion>(const std::string& robot)> config;
  };

  /// `outside.announcer` outlives the fleet.
  Fleet(const FleetConfig& config, const Outside& outside);

  /// A robot that an earlier run of the service knew. Before the first receive().
  void resume(const std::string& robot, const Past& past);

  /// A scan of `robot`, which need not be known nor be a robot id; or what else it sends, ignored
  /// until it sent a scan.
  void receive(const std::string& robot, Message message);
  /// Has it done on the robot's lane, or destroyed undone where its queue is full of orders. False
  /// if there is no room for another robot.
  bool order(const std::string& robot, Order order);
  /// A message that belongs to no robot.
  void count(core::Outcome outcome);
  /// Finishes what is queued. No call of receive() may follow.
  void stop();

  [[nodiscard]] std::vector<core::RobotStatus> robots() const;
  [[nodiscard]] std::optional<core::RobotStatus> robot(const std::string& id) const;
  /// `counts`, `robots` and `queued_scans`.
  void describe(core::ServiceStatus& status) const;

 private:
  struct Member {
    std::shared_ptr<Watch> watch;
    Lane* lane;
  };

  [[nodiscard]] bool is_known(const std::string& robot) const;
  [[nodiscard]] std::optional<Member> member(const std::string& robot);
  [[nodiscard]] Member& join(const std::string& robot);

  const FleetConfig config_;
  Surroundings around_;
  mutable std::mutex mutex_;  // over members_ and counts_
  std::map<std::string, Member> members_;
  core::OutcomeCounts counts_{};
  std::vector<std::unique_ptr<Lane>> lanes_;  // last: they stop before what they use goes
};

}  // namespace kidnapwatch::service
