// SPDX-License-Identifier: Apache-2.0
// Changes of incidents, seen through: done on the robot's lane, and stored.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/incident_command.hpp"
#include "service/fleet.hpp"
#include "storage/archive.hpp"
#include "storage/writer.hpp"

namespace kidnapwatch::service {

/// One at a time, and durable before the next: each sees what the one before it stored. Every
/// function waits, 10 s at most, and throws api::Unavailable. Any thread but a lane's.
class Orders {
 public:
  /// All outlive this.
  Orders(Fleet& fleet, const storage::Archive& archive, storage::Writer& writer)
      : fleet_(fleet), archive_(archive), writer_(writer) {}

  /// As api::Fleet::change_incident.
  std::optional<core::Incident> change(const std::string& id, const core::IncidentCommand& command);
  /// The same with the robot's open incident; nothing where none is open.
  std::optional<core::Incident> change_open(const std::string& robot,
                                            const core::IncidentCommand& command);
  /// As api::Fleet::last_scans.
  std::vector<core::Scan> last_scans(const std::string& robot);
  void forget_scans(const std::string& robot);

 private:
  using Changed = std::optional<core::Incident>;
  Changed carried_out(const std::string& robot, std::function<Changed(Watch&)> order);
  void await_stored();

  Fleet& fleet_;
  const storage::Archive& archive_;
  storage::Writer& writer_;
  std::mutex mutex_;
};

}  // namespace kidnapwatch::service
