// SPDX-License-Identifier: Apache-2.0
// Waits for the lane, then for the store.
#include "service/orders.hpp"

#include <chrono>
#include <future>
#include <memory>
#include <utility>

namespace kidnapwatch::service {
namespace {

constexpr std::chrono::seconds kPatience{5};  // with a lane and with the store

}  // namespace

std::optional<core::Incident> Orders::change(const std::string& id,
                                             const core::IncidentCommand& command) {
  const std::lock_guard one_at_a_time(mutex_);
  auto stored = archive_.incident(id);
  if (!stored) return std::nullopt;
  const std::string robot = stored->robot;
  auto changed = carried_out(robot, [stored = std::move(*stored), command](Watch& watch) {
    return watch.carry_out(stored, command);
  });
  await_stored();
  return changed;
}

std::optional<core::Incident> Orders::change_open(const std::string& robot,
                                                  const core::IncidentCommand& command) {
  const std::lock_guard one_at_a_time(mutex_);
  auto changed = carried_out(robot, [command](Watch& watch) {
    const auto incident = watch.open_incident();
    return incident ? watch.carry_out(*incident, command) : std::nullopt;
  });
  await_stored();
  return changed;
}

std::vector<core::Scan> Orders::last_scans(const std::string& robot) {
  if (!fleet_.robot(robot)) return {};
  const auto scans = std::make_shared<std::vector<core::Scan>>();  // outlives an order given up
  (void)carried_out(robot, [scans](Watch& watch) {
    *scans = watch.last_scans();
    return std::nullopt;
  });
  return std::move(*scans);
}

void Orders::forget_scans(const std::string& robot) {
  (void)carried_out(robot, [](Watch& watch) {
    watch.forget_scans();
    return std::nullopt;
  });
}

Orders::Changed Orders::carried_out(const std::string& robot,
                                    std::function<Changed(Watch&)> order) {
  // What it throws is for who waits, and not for the lane.
  const auto task = std::make_shared<std::packaged_task<Changed(Watch&)>>(std::move(order));
  auto changed = task->get_future();
  const bool is_taken = fleet_.order(robot, [task](Watch& watch) { (*task)(watch); });
  if (!is_taken || changed.wait_for(kPatience) != std::future_status::ready) {
    throw api::Unavailable("the robot's lane is too busy");
  }
  try {
    return changed.get();
  } catch (const std::future_error&) {
    throw api::Unavailable("the robot's queue is full of orders");
  }
}

void Orders::await_stored() {
  auto stored = writer_.flush();
  if (stored.wait_for(kPatience) != std::future_status::ready) {
    throw api::Unavailable("the store is too slow: the change is made, but not stored yet");
  }
  try {
    stored.get();
  } catch (const storage::StorageError& error) {
    throw api::Unavailable(std::string("the change is made, but not stored yet: ") + error.what());
  }
}

}  // namespace kidnapwatch::service
