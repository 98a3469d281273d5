// SPDX-License-Identifier: Apache-2.0
// The way of one scan: decode, judge, announce, count.
#include "service/watch.hpp"

#include <utility>

namespace kidnapwatch::service {
namespace {

using core::Outcome;

constexpr std::size_t kKeepEvery = 500;  // scans; 12 kB each time
constexpr std::size_t kTellEvery = 100;  // scans: a threshold changes slowly

core::AlertType alert_type(core::EpisodeChange change) {
  switch (change) {
    case core::EpisodeChange::opened:
      return core::AlertType::opened;
    case core::EpisodeChange::updated:
      return core::AlertType::updated;
    case core::EpisodeChange::resolved:
      break;
  }
  return core::AlertType::resolved;
}

/// The incident that a confirmed jump is, or becomes.
void describe(core::Incident& incident, const core::Jump& jump) {
  incident.state = core::IncidentState::open;  // whoever looked after it did not know of this
  incident.acknowledged_by.clear();
  incident.before_stamp = jump.scans.before.stamp;
  incident.after_stamp = jump.scans.after.stamp;
  incident.kind =
      jump.cause == core::Cause::carry ? core::IncidentKind::carry : core::IncidentKind::teleport;
  incident.cause = jump.cause;
  incident.detector = jump.detector;
  incident.score = jump.score;
  incident.threshold = jump.threshold;
}

}  // namespace

Watch::Watch(std::string id, const Surroundings& around)
    : id_(std::move(id)),
      around_(around),
      config_(around.config(id_)),
      session_(config_->config),
      others_(config_->config) {
  status_.id = id_;
  refresh_status(around_.now());
}

void Watch::resume(const Past& past) {
  (void)session_.restore(past.learned);  // of another version: it is learned anew
  tell_fleet();
  session_.resume(past.natural_scores, past.open_incident.has_value(), around_.uptime());
  incident_open_ = past.open_incident.has_value();
  incident_ = past.open_incident.value_or(core::Incident{});
  refresh_status(around_.now());
}

void Watch::take(const Message& message, Bench& bench) {
  refresh_config();
  if (message.kind == MessageKind::odometry) {
    take_odometry(message, bench);
    return;
  }
  if (message.kind == MessageKind::particles) {
    take_particles(message, bench);
    return;
  }
  if (message.kind == MessageKind::order) {
    message.order(*this);
    return;
  }
  const core::Stamp arrival = message.arrival;
  const core::RobotState before = status().state;
  count(outcome_of(message, bench));
  refresh_status(arrival);
  const core::RobotStatus after = status();
  if (after.state != before) {
    around_.announcer.announce_state(after, arrival);
  }
  const bool warmed_up = before == core::RobotState::unknown && after.state != before;
  if (++untold_ >= kTellEvery || warmed_up) {
    tell_fleet();
  }
  if (++unkept_ >= kKeepEvery || warmed_up) {
    keep_learned();
  }
}

void Watch::keep_learned() {
  if (std::exchange(unkept_, 0) > 0) {
    around_.announcer.keep_learned(id_, session_.learned());
  }
}

/// Its own threshold, not the one in force: the fleet's median is not to feed itself.
void Watch::tell_fleet() {
  untold_ = 0;
  if (const auto own = session_.own_motion_threshold()) {
    around_.fleet_threshold->tell(id_, *own);
  }
}

void Watch::take_odometry(const Message& message, Bench& bench) {
  try {
    const auto [stamp, pose] = bench.odometry.decode(*message.payload);
    odometry_.add(stamp, pose);
  } catch (const core::BadInput& bad) {
    around_.log_refusal(id_, bad);
  }
}

void Watch::take_particles(const Message& message, Bench& bench) {
  if (!others_.need_particles()) {
    return;
  }
  try {
    others_.take_particles(bench.particles.decode(*message.payload));
  } catch (const core::BadInput& bad) {
    around_.log_refusal(id_, bad);
  }
}

std::optional<core::Incident> Watch::carry_out(const core::Incident& stored,
                                               const core::IncidentCommand& command) {
  const core::Stamp now = around_.now();
  const bool is_latest = stored.id == incident_.id;
  const core::Incident before = is_latest ? incident_ : stored;
  const auto result = core::changed(before, command, now);
  if (!result) {
    return std::nullopt;
  }
  if (result->incident.seq != before.seq) {
    around_.announcer.announce_alert({.event_id = around_.new_id(now),
                                      .type = result->type,
                                      .timestamp = now,
                                      .incident = result->incident,
                                      .author = command.author},
                                     std::nullopt);
  }
  if (is_latest) {
    incident_ = result->incident;
  }
  const bool ends = is_latest && incident_.state == core::IncidentState::resolved;
  if (ends && std::exchange(incident_open_, false)) {
    session_.resolve();
    refresh_status(status().last_arrival);
    around_.announcer.announce_state(status(), now);
  }
  return result->incident;
}

std::optional<core::Incident> Watch::open_incident() const {
  return incident_open_ ? std::optional(incident_) : std::nullopt;
}

std::vector<core::Scan> Watch::last_scans() const {
  if (good_scans_ == 0) return {};
  if (good_scans_ == 1) return {session_.reference()};
  return {before_last_, session_.reference()};
}

void Watch::forget_scans() {
  good_scans_ = 0;
  session_.forget_scans();
  odometry_ = {};
  refresh_status(status().last_arrival);
}

void Watch::end_shelving(core::Stamp now) {
  if (!incident_open_ || !incident_.shelved_until || *incident_.shelved_until > now) {
    return;
  }
  incident_.shelved_until.reset();
  ++incident_.seq;
  around_.announcer.announce_alert({.event_id = around_.new_id(now),
                                    .type = core::AlertType::updated,
                                    .timestamp = now,
                                    .incident = incident_},
                                   std::nullopt);
}

Outcome Watch::outcome_of(const Message& message, Bench& bench) {
  try {
    bench.decoder.decode(*message.payload, message.content_type, bench.scan);
    if (!bench.scan.odometry) {
      bench.scan.odometry = odometry_.at(bench.scan.stamp);
    }
    session_.set_fleet_threshold(around_.fleet_threshold->median());
    core::Observation seen = session_.observe(bench.scan, around_.uptime(), bench.workspace);
    if (seen.verdict) {
      std::swap(before_last_, bench.scan);  // the session left its last reference there
      ++good_scans_;
      conclude(*seen.verdict, message.arrival);
    } else if (seen.outcome == Outcome::first) {
      good_scans_ = 1;
      (void)others_.observe(session_.reference());
    }
    return seen.outcome;
  } catch (const core::BadScan& bad) {
    around_.log_refusal(id_, bad);
    return bad.outcome();
  } catch (const std::exception& fault) {
    around_.log_refusal(id_, core::BadInput("scan", fault.what()));
    return Outcome::failed;
  }
}

void Watch::conclude(core::Verdict& verdict, core::Stamp arrival) {
  if (verdict.change) {  // first: a full disk or a slow store must not hide a kidnapping
    incident_.scan_stamp = verdict.score.stamp;
    change_incident(*verdict.change, around_.now());
  }
  verdict.score.others = others_.observe(session_.reference());
  around_.announcer.announce_score(id_, verdict.score, arrival);
  const std::lock_guard lock(mutex_);
  status_.score = verdict.score;
}

void Watch::change_incident(core::EpisodeChange change, core::Stamp now) {
  std::optional<core::ScanPair> evidence;
  if (change == core::EpisodeChange::opened) {
    incident_ = core::Incident{.id = around_.new_id(now),
                               .robot = id_,
                               .opened_at = now,
                               .scan_stamp = incident_.scan_stamp,
                               .config_version = config_->version};
  }
  if (change == core::EpisodeChange::resolved) {
    incident_.state = core::IncidentState::resolved;
    incident_.resolved_at = now;
    incident_.shelved_until.reset();
  } else {
    describe(incident_, *session_.jump());
    evidence = session_.jump()->scans;
  }
  incident_open_ = change != core::EpisodeChange::resolved;
  ++incident_.seq;
  around_.announcer.announce_alert({around_.new_id(now), alert_type(change), now, incident_},
                                   std::move(evidence));
}

void Watch::tick() {
  const core::Stamp now = around_.now();
  end_shelving(now);
  const core::RobotState before = status().state;
  {
    const std::lock_guard lock(mutex_);
    status_.state = session_.state(around_.uptime());
    if (status_.state != core::RobotState::degraded) {
      status_.trouble.reset();
    }
  }
  const core::RobotStatus after = status();
  if (after.state != before) {
    around_.announcer.announce_state(after, now);
  }
}

void Watch::refresh_config() {
  auto current = around_.config(id_);
  if (current->version != config_->version) {
    session_.configure(current->config);
    if (current->config.detectors != config_->config.detectors ||
        current->config.dissimilarity != config_->config.dissimilarity) {
      others_ = OtherDetectors(current->config);
    }
    config_ = std::move(current);
  }
}

void Watch::refresh_status(core::Stamp arrival) {
  const std::lock_guard lock(mutex_);
  status_.state = session_.state(around_.uptime());
  status_.trouble = status_.state == core::RobotState::degraded ? session_.trouble() : std::nullopt;
  status_.last_arrival = arrival;
  status_.threshold = session_.threshold();
  status_.motion_threshold = session_.motion_threshold();
  status_.own_motion_threshold = session_.own_motion_threshold();
  status_.calibration_pairs = session_.calibration_pairs();
  status_.warmup_pairs = config_->config.calibration.warmup_pairs;
  status_.incident_id = incident_open_ ? std::optional(incident_.id) : std::nullopt;
}

core::RobotStatus Watch::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void Watch::count(Outcome outcome) {
  const std::lock_guard lock(mutex_);
  ++status_.counts.at(static_cast<std::size_t>(outcome));
}

}  // namespace kidnapwatch::service
