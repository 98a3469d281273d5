// SPDX-License-Identifier: Apache-2.0
// The way of one scan: decode, judge, announce, count.
#include "service/watch.hpp"

#include <utility>

namespace kidnapwatch::service {
namespace {

using core::Outcome;

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
  incident.state = core::IncidentState::open;
  incident.before_stamp = jump.scans.before.stamp;
  incident.after_stamp = jump.scans.after.stamp;
  incident.score = jump.score;
  incident.threshold = jump.threshold;
}

}  // namespace

Watch::Watch(std::string id, const Surroundings& around)
    : id_(std::move(id)),
      around_(around),
      config_(around.config()),
      session_(config_->config),
      others_(config_->config) {
  status_.id = id_;
  refresh_status(around_.now());
}

void Watch::resume(const Past& past) {
  session_.resume(past.natural_scores, past.open_incident.has_value(), around_.uptime());
  incident_open_ = past.open_incident.has_value();
  incident_ = past.open_incident.value_or(core::Incident{});
  refresh_status(around_.now());
}

void Watch::take(const Message& message, Bench& bench) {
  refresh_config();
  if (message.kind == MessageKind::particles) {
    take_particles(message, bench);
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

Outcome Watch::outcome_of(const Message& message, Bench& bench) {
  try {
    bench.decoder.decode(*message.payload, message.content_type, bench.scan);
    core::Observation seen = session_.observe(bench.scan, around_.uptime(), bench.workspace);
    if (seen.verdict) {
      conclude(*seen.verdict, message.arrival);
    } else if (seen.outcome == Outcome::first) {
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
    incident_ =
        core::Incident{.id = around_.new_id(now),
                       .robot = id_,
                       .opened_at = now,
                       .scan_stamp = incident_.scan_stamp,
                       .detector = std::string(core::detector_name(config_->config.dissimilarity)),
                       .config_version = config_->version};
  }
  if (change == core::EpisodeChange::resolved) {
    incident_.state = core::IncidentState::resolved;
    incident_.resolved_at = now;
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
  const core::RobotState before = status().state;
  {
    const std::lock_guard lock(mutex_);
    status_.state = session_.state(around_.uptime());
  }
  const core::RobotStatus after = status();
  if (after.state != before) {
    around_.announcer.announce_state(after, now);
  }
}

void Watch::refresh_config() {
  auto current = around_.config();
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
  status_.last_arrival = arrival;
  status_.threshold = session_.threshold();
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
