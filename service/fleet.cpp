// SPDX-License-Identifier: Apache-2.0
// Robots to lanes, and what everybody wants to know of them.
#include "service/fleet.hpp"

#include <functional>
#include <utility>

namespace kidnapwatch::service {

Fleet::Fleet(const FleetConfig& config, const Outside& outside)
    : config_(config),
      around_{.announcer = outside.announcer,
              .now = outside.now,
              .uptime = outside.uptime,
              .new_id = outside.new_id,
              .config = outside.config,
              .log_refusal = outside.log_refusal} {
  for (std::size_t i = 0; i < config_.lanes; ++i) {
    lanes_.push_back(std::make_unique<Lane>(config_.lane));
  }
}

void Fleet::resume(const std::string& robot, const Past& past) {
  const std::lock_guard lock(mutex_);
  join(robot).watch->resume(past);
}

void Fleet::receive(const std::string& robot, Message message) {
  const bool is_welcome = message.kind == MessageKind::scan || is_known(robot);
  if (const auto found = is_welcome ? member(robot) : std::nullopt) {
    found->lane->push(*found->watch, std::move(message));
  }
}

bool Fleet::order(const std::string& robot, Order order) {
  const auto found = member(robot);
  if (!found) {
    return false;
  }
  Message message{.payload = {}, .content_type = {}, .arrival = around_.now()};
  message.kind = MessageKind::order;
  message.order = std::move(order);
  found->lane->push(*found->watch, std::move(message));
  return true;
}

bool Fleet::is_known(const std::string& robot) const {
  const std::lock_guard lock(mutex_);
  return members_.contains(robot);
}

std::optional<Fleet::Member> Fleet::member(const std::string& robot) {
  const std::lock_guard lock(mutex_);
  if (const auto known = members_.find(robot); known != members_.end()) {
    return known->second;
  }
  if (!core::is_robot_id(robot)) {
    ++counts_.at(static_cast<std::size_t>(core::Outcome::bad_robot_id));
    return std::nullopt;
  }
  if (members_.size() >= config_.max_robots) {
    ++counts_.at(static_cast<std::size_t>(core::Outcome::too_many_robots));
    return std::nullopt;
  }
  return join(robot);
}

Fleet::Member& Fleet::join(const std::string& robot) {
  const auto watch = std::make_shared<Watch>(robot, around_);
  Lane* lane = lanes_[std::hash<std::string>{}(robot) % lanes_.size()].get();
  lane->add(watch);
  return members_.emplace(robot, Member{watch, lane}).first->second;
}

void Fleet::count(core::Outcome outcome) {
  const std::lock_guard lock(mutex_);
  ++counts_.at(static_cast<std::size_t>(outcome));
}

void Fleet::stop() {
  for (const auto& lane : lanes_) {
    lane->stop();
  }
  const std::lock_guard lock(mutex_);
  for (const auto& [id, member] : members_) {
    member.watch->keep_learned();
  }
}

std::vector<core::RobotStatus> Fleet::robots() const {
  const std::lock_guard lock(mutex_);
  std::vector<core::RobotStatus> all;
  all.reserve(members_.size());
  for (const auto& [id, member] : members_) {
    all.push_back(member.watch->status());
  }
  return all;
}

std::optional<core::RobotStatus> Fleet::robot(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = members_.find(id);
  return found == members_.end() ? std::nullopt : std::optional(found->second.watch->status());
}

void Fleet::describe(core::ServiceStatus& status) const {
  {
    const std::lock_guard lock(mutex_);
    status.counts = counts_;
  }
  const auto all = robots();
  status.robots = all.size();
  for (const auto& robot : all) {
    for (std::size_t i = 0; i < core::kOutcomes; ++i) {
      status.counts.at(i) += robot.counts.at(i);
    }
  }
  status.queued_scans = 0;
  for (const auto& lane : lanes_) {
    status.queued_scans += lane->queued();
    status.judging += lane->judging();
  }
}

}  // namespace kidnapwatch::service
