// SPDX-License-Identifier: Apache-2.0
// The way of a command: refuse, carry out, answer, count.
#include "service/command_desk.hpp"

#include <utility>

#include "api/ports.hpp"

namespace kidnapwatch::service {
namespace {

using core::CommandResult;

constexpr std::size_t kLongestPayload = 16'384;  // a comment of 2000 bytes, all of them escaped
constexpr std::size_t kMostWaiting = 64;

}  // namespace

void CommandDesk::take(CommandLetter letter) {
  if (letter.retained) {
    count(CommandResult::retained);
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    if (letters_.size() >= kMostWaiting) {
      ++counts_.at(static_cast<std::size_t>(CommandResult::overload));
      return;
    }
    letters_.push_back(std::move(letter));
  }
  filled_.notify_one();
}

void CommandDesk::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  filled_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
  }
}

core::CommandCounts CommandDesk::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

void CommandDesk::count(CommandResult result) {
  const std::lock_guard lock(mutex_);
  ++counts_.at(static_cast<std::size_t>(result));
}

void CommandDesk::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    filled_.wait(lock, [this] { return stopping_ || !letters_.empty(); });
    if (stopping_) {
      return;
    }
    const CommandLetter letter = std::move(letters_.front());
    letters_.pop_front();
    lock.unlock();
    serve(letter);
    lock.lock();
  }
}

void CommandDesk::serve(const CommandLetter& letter) {
  const Answer result = answer(letter);
  count(result.result);
  if (result.result != CommandResult::done) {
    ways_.log_refusal(letter.robot, core::BadInput("command", result.detail));
  }
  if (letter.response_topic.empty()) {
    return;
  }
  if (!ways_.publish(letter, adapters::codecs::answer_message(letter.robot, result))) {
    ways_.log_refusal(letter.robot, core::BadInput("response topic",
                                                   letter.response_topic + " is not for answers"));
  }
}

CommandDesk::Answer CommandDesk::answer(const CommandLetter& letter) const {
  try {
    return carried_out(letter);
  } catch (const core::BadInput& bad) {
    return {.result = CommandResult::malformed, .detail = bad.what(), .field = bad.field()};
  } catch (const api::Unavailable& busy) {
    return {.result = CommandResult::unavailable, .detail = busy.what()};
  } catch (const std::exception& fault) {
    ways_.log_refusal(letter.robot, core::BadInput("command", fault.what()));
    return {.result = CommandResult::failed, .detail = "the service failed; its log says more"};
  }
}

CommandDesk::Answer CommandDesk::carried_out(const CommandLetter& letter) const {
  if (letter.payload->size() > kLongestPayload) {
    return {.result = CommandResult::too_large, .detail = "a command has at most 16384 bytes"};
  }
  if (!ways_.knows(letter.robot)) {
    return {.result = CommandResult::unknown_robot,
            .detail = "no robot named " + letter.robot + " has sent a scan"};
  }
  const auto command = adapters::codecs::robot_command(*letter.payload, letter.robot);
  if (!command.change) {
    ways_.forget_scans(letter.robot);
    return {};
  }
  return changed(letter.robot, command);
}

CommandDesk::Answer CommandDesk::changed(const std::string& robot,
                                         const core::RobotCommand& command) const {
  if (!command.incident_id) {
    auto incident = ways_.change_open(robot, *command.change);
    return incident ? Answer{.incident = std::move(incident)}
                    : Answer{.result = CommandResult::no_incident,
                             .detail = "no incident of this robot is open"};
  }
  const auto stored = ways_.stored(*command.incident_id);
  if (!stored || stored->robot != robot) {
    return {.result = CommandResult::no_incident,
            .detail = "no incident of this robot has that id",
            .field = "incidentId"};
  }
  auto incident = ways_.change(stored->id, *command.change);
  return incident
             ? Answer{.incident = std::move(incident)}
             : Answer{.result = CommandResult::not_allowed, .detail = "the incident is resolved"};
}

}  // namespace kidnapwatch::service
