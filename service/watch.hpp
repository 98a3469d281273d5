// SPDX-License-Identifier: Apache-2.0
// One robot being watched: its payloads in, announcements out, its status for anyone who looks.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adapters/codecs/odometry_json.hpp"
#include "adapters/codecs/particles_payload.hpp"
#include "adapters/codecs/scan_payload.hpp"
#include "core/incident.hpp"
#include "core/incident_command.hpp"
#include "core/odometry_track.hpp"
#include "core/status.hpp"
#include "service/fleet_threshold.hpp"
#include "service/other_detectors.hpp"

namespace kidnapwatch::service {

class Watch;

/// What somebody wants of a robot's watch; done on the robot's lane.
using Order = std::function<void(Watch&)>;

enum class MessageKind : std::uint8_t { scan, odometry, particles, order };

/// A message from a robot, as it came from the broker.
struct Message {
  std::shared_ptr<const std::string> payload;  ///< never null
  std::string content_type;                    ///< MQTT 5; empty if the publisher told none
  core::Stamp arrival;
  MessageKind kind = MessageKind::scan;
  Order order = {};  ///< of that kind
  std::chrono::steady_clock::time_point queued = {};
};

/// What a thread needs to take scans, whatever robot they are of. It holds no state of a robot.
struct Bench {
  explicit Bench(const adapters::codecs::ScanPayloadConfig& payload)
      : decoder(payload), particles(payload.max_payload_bytes) {}

  adapters::codecs::ScanDecoder decoder;
  adapters::codecs::OdometryDecoder odometry;
  adapters::codecs::ParticlesDecoder particles;
  core::Scan scan;
  core::DissimilarityWorkspace workspace;
};

/// Where conclusions go. Called on the robot's lane; never blocks and never throws.
class Announcer {
 public:
  virtual ~Announcer() = default;
  virtual void announce_state(const core::RobotStatus& status, core::Stamp now) = 0;
  /// `evidence` with a kidnapping, not with the end of one.
  virtual void announce_alert(const core::Alert& alert, std::optional<core::ScanPair> evidence) = 0;
  virtual void announce_score(const std::string& robot, const core::Score& score,
                              core::Stamp arrival) = 0;
  /// Session::learned(), for the service's next start.
  virtual void keep_learned(const std::string& robot, std::vector<float> learned) = 0;
};

/// What all watches share. The functions may be called from any lane.
struct Surroundings {
  Announcer& announcer;
  std::function<core::Stamp()> now;
  /// A clock that only ever goes on, for what lasts: the wall's may jump.
  std::function<core::Stamp()> uptime;
  std::function<std::string(core::Stamp)> new_id;
  /// What is in force for the robot.
  std::function<std::shared_ptr<const core::ConfigVersion>(const std::string& robot)> config;
  std::function<void(const std::string& robot, const core::BadInput& why)> log_refusal;
  std::shared_ptr<FleetThreshold> fleet_threshold = std::make_shared<FleetThreshold>();
};

/// What an earlier run of the service left of a robot.
struct Past {
  std::vector<double> natural_scores = {};  ///< oldest first
  std::vector<float> learned = {};          ///< Session::learned()
  std::optional<core::Incident> open_incident = {};
};

class Watch {
 public:
  Watch(std::string id, const Surroundings& around);

  void resume(const Past& past);

  /// On the robot's lane: one scan, to its end; or odometry, kept for the scans that have none; or
  /// particles, for the next one.
  void take(const Message& message, Bench& bench);
  /// On the robot's lane: the incident after the command, which passed check(); nothing where its
  /// state does not allow it. `stored` is what the store has of it, unless the watch knows better.
  std::optional<core::Incident> carry_out(const core::Incident& stored,
                                          const core::IncidentCommand& command);
  /// On the robot's lane.
  [[nodiscard]] std::optional<core::Incident> open_incident() const;
  /// On the robot's lane: the last good scans, at most two, oldest first.
  [[nodiscard]] std::vector<core::Scan> last_scans() const;
  /// On the robot's lane: the next scan is compared with none before it.
  void forget_scans();
  /// On the robot's lane, now and then: tells when the robot fell silent.
  void tick();
  /// On the robot's lane, or after its end: hands over what was learned since it was last.
  void keep_learned();

  /// Any thread.
  [[nodiscard]] core::RobotStatus status() const;
  void count(core::Outcome outcome);
  [[nodiscard]] const std::string& id() const noexcept { return id_; }

 private:
  void take_odometry(const Message& message, Bench& bench);
  void end_shelving(core::Stamp now);
  [[nodiscard]] core::Outcome outcome_of(const Message& message, Bench& bench);
  void take_particles(const Message& message, Bench& bench);
  void conclude(core::Verdict& verdict, core::Stamp arrival);
  void change_incident(core::EpisodeChange change, core::Stamp now);
  void refresh_config();
  void tell_fleet();
  void refresh_status(core::Stamp now);

  const std::string id_;
  const Surroundings& around_;
  std::shared_ptr<const core::ConfigVersion> config_;
  core::Session session_;
  core::Scan before_last_;      // the good scan before the session's reference
  std::size_t good_scans_ = 0;  // that the session took since it has a reference
  core::OdometryTrack odometry_;
  OtherDetectors others_;
  core::Incident incident_;  // the latest; meaningless before the first
  bool incident_open_ = false;
  std::size_t unkept_ = 0;  // scans since what was learned was kept
  std::size_t untold_ = 0;  // scans since the fleet was told

  mutable std::mutex mutex_;  // over status_ alone
  core::RobotStatus status_;
};

}  // namespace kidnapwatch::service
