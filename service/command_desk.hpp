// SPDX-License-Identifier: Apache-2.0
// Commands that come by MQTT: carried out one after the other, counted, and answered.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "adapters/codecs/command_json.hpp"

namespace kidnapwatch::service {

/// A command as it came from the broker.
struct CommandLetter {
  std::string robot;
  std::shared_ptr<const std::string> payload;  ///< never null
  std::string response_topic;                  ///< empty: no answer is awaited
  std::string correlation;
  bool retained = false;
};

/// Waits for lanes and the store on a thread of its own, never on the one that brings the commands.
class CommandDesk {
 public:
  /// How commands take effect; called on the desk's thread. All may throw: api::Unavailable where
  /// the service is too busy.
  struct Ways {
    std::function<bool(const std::string& robot)> knows;
    std::function<std::optional<core::Incident>(const std::string& id)> stored;
    /// As in Orders.
    std::function<std::optional<core::Incident>(const std::string& id,
                                                const core::IncidentCommand&)>
        change;
    std::function<std::optional<core::Incident>(const std::string& robot,
                                                const core::IncidentCommand&)>
        change_open;
    std::function<void(const std::string& robot)> forget_scans;
    /// Sends the answer to the letter's response topic; false where that is not one for answers.
    std::function<bool(const CommandLetter&, std::string answer)> publish;
    std::function<void(const std::string& robot, const core::BadInput& why)> log_refusal;
  };
  explicit CommandDesk(Ways ways) : ways_(std::move(ways)), thread_([this] { run(); }) {}
  ~CommandDesk() { stop(); }
  CommandDesk(const CommandDesk&) = delete;
  CommandDesk& operator=(const CommandDesk&) = delete;

  /// Any thread; does not wait.
  void take(CommandLetter letter);
  /// Finishes the one under way; those that wait are left undone, and unanswered.
  void stop();

  [[nodiscard]] core::CommandCounts counts() const;

 private:
  using Answer = adapters::codecs::CommandAnswer;

  void run();
  void serve(const CommandLetter& letter);
  [[nodiscard]] Answer answer(const CommandLetter& letter) const;
  [[nodiscard]] Answer carried_out(const CommandLetter& letter) const;
  [[nodiscard]] Answer changed(const std::string& robot, const core::RobotCommand& command) const;
  void count(core::CommandResult result);

  const Ways ways_;
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::deque<CommandLetter> letters_;
  core::CommandCounts counts_{};
  bool stopping_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace kidnapwatch::service
