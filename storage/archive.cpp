// SPDX-License-Identifier: Apache-2.0
// The statements that read.
#include "storage/archive.hpp"

#include <algorithm>

#include "storage/audit.hpp"
#include "storage/buckets.hpp"
#include "storage/rows.hpp"
#include "storage/scores.hpp"
#include "storage/segments.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr std::size_t kMaxEvidenceScores = 1000;

constexpr std::string_view kOutbox = R"(
SELECT event_id, robot, payload, delivered FROM alert WHERE id IN (
  SELECT id FROM alert WHERE NOT delivered
  UNION SELECT (SELECT max(id) FROM alert WHERE alert.incident = incident.id)
  FROM incident WHERE state <> 'resolved') ORDER BY id)";

constexpr std::string_view kAlertNumbers = R"(
SELECT last, coalesce((SELECT min(id) FROM alert), last + 1) FROM (
  SELECT coalesce(max(seq), 0) AS last FROM sqlite_sequence WHERE name = 'alert'))";

std::string select(std::string_view columns, std::string_view rest) {
  return "SELECT " + std::string(columns) + " " + std::string(rest);
}

std::vector<core::Incident> all_incidents(Statement& query) {
  std::vector<core::Incident> incidents;
  while (query.step()) incidents.push_back(incident_from(query));
  return incidents;
}

std::optional<core::Incident> find_incident(Database& database, const std::string& id) {
  Statement query(database, select(kIncidentColumns, "FROM incident WHERE id = ?1"));
  if (!query.bind(id).step()) return std::nullopt;
  return incident_from(query);
}

std::optional<core::ScanPair> find_scans(Database& database, const std::string& incident_id) {
  Statement query(database,
                  select(kScanColumns, "FROM evidence_scan WHERE incident = ?1 ORDER BY is_after"));
  query.bind(incident_id);
  core::ScanPair scans;
  if (!query.step()) return std::nullopt;
  scans.before = scan_from(query);
  if (!query.step()) return std::nullopt;
  scans.after = scan_from(query);
  return scans;
}

template <typename Name>
std::optional<std::string> text(const std::optional<Name>& value) {
  return value ? std::optional(std::string(core::name(*value))) : std::nullopt;
}

std::vector<float> learned(Database& database, const std::string& robot) {
  Statement query(database, "SELECT numbers FROM learned WHERE robot = ?1");
  if (!query.bind(robot).step()) return {};
  return floats(query.blob(0));
}

ConfigText config_from(const Statement& row) {
  return {.version = row.integer(0),
          .since = row.stamp(1),
          .author = row.text(2),
          .text = row.text(3),
          .robot = row.text(4)};
}

std::vector<ConfigText> all_configs(Statement& query) {
  std::vector<ConfigText> configs;
  while (query.step()) configs.push_back(config_from(query));
  return configs;
}

std::vector<StoredAlert> all_alerts(Statement& query) {
  std::vector<StoredAlert> alerts;
  while (query.step()) {
    alerts.push_back(
        {.number = query.integer(0), .robot = query.text(1), .payload = query.text(2)});
  }
  return alerts;
}

}  // namespace

/// A connection for one read; opened where all others are busy.
class Archive::Lease {
 public:
  explicit Lease(const Archive& archive) : archive_(archive) {
    {
      const std::lock_guard lock(archive.mutex_);
      if (!archive.idle_.empty()) {
        connection_ = std::move(archive.idle_.back());
        archive.idle_.pop_back();
      }
    }
    if (!connection_) connection_ = std::make_unique<Database>(archive.file_, Access::read_only);
  }
  ~Lease() {
    const std::lock_guard lock(archive_.mutex_);
    archive_.idle_.push_back(std::move(connection_));
  }
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;

  operator Database&() const { return *connection_; }  // NOLINT(google-explicit-constructor)

 private:
  const Archive& archive_;
  std::unique_ptr<Database> connection_;
};

Archive::Archive(std::filesystem::path file, std::shared_ptr<const RecentScores> recent)
    : file_(std::move(file)), recent_(std::move(recent)) {}

Archive::~Archive() = default;

std::shared_ptr<const RecentScores> Archive::recent(Database& database) const {
  return recent_ ? recent_ : hot_scores(database);
}

std::vector<core::Score> Archive::scores(const std::string& robot, core::Stamp from, core::Stamp to,
                                         std::size_t limit) const {
  const Lease lease(*this);
  return storage::scores(lease, *recent(lease), robot, from, to, limit);
}

std::vector<core::ScoreBucket> Archive::score_buckets(const std::string& robot, core::Stamp from,
                                                      core::Stamp to,
                                                      std::chrono::seconds resolution,
                                                      std::size_t limit) const {
  const Lease lease(*this);
  return storage::score_buckets(lease, *recent(lease), robot, from, to, resolution, limit);
}

std::vector<core::Incident> Archive::incidents(const IncidentFilter& filter) const {
  const Lease lease(*this);
  std::string where = "FROM incident WHERE true";
  if (filter.opened_from != core::Stamp::min()) where += " AND opened_at >= ?4";
  if (filter.opened_to != core::Stamp::max()) where += " AND opened_at < ?5";
  if (filter.robot) where += " AND robot = ?1";
  if (filter.state) where += " AND state = ?2";
  if (filter.kind) where += " AND kind = ?3";
  if (filter.label) where += " AND label = ?7";
  if (filter.before_id) where += " AND id < ?6";
  Statement query(lease, select(kIncidentColumns, where + " ORDER BY id DESC LIMIT ?8"));
  query.bind(filter.robot, text(filter.state), text(filter.kind), filter.opened_from,
             filter.opened_to, filter.before_id, text(filter.label), filter.limit);
  return all_incidents(query);
}

std::vector<core::Incident> Archive::unresolved_incidents() const {
  const Lease lease(*this);
  Statement query(
      lease, select(kIncidentColumns, "FROM incident WHERE state <> 'resolved' ORDER BY id DESC"));
  return all_incidents(query);
}

std::optional<core::Incident> Archive::incident(const std::string& id) const {
  const Lease lease(*this);
  return find_incident(lease, id);
}

std::optional<core::Evidence> Archive::evidence(const std::string& incident_id) const {
  const Lease lease(*this);
  Database& database = lease;
  const auto incident = find_incident(database, incident_id);
  auto scans = find_scans(database, incident_id);
  if (!incident || !scans) return std::nullopt;
  auto scores = storage::scores(database, *recent(database), incident->robot,
                                scans->before.stamp - kAroundEvidence,
                                scans->after.stamp + kAroundEvidence, kMaxEvidenceScores);
  return core::Evidence{.scans = std::move(*scans), .scores = std::move(scores)};
}

std::vector<ConfigText> Archive::latest_configs() const {
  const Lease lease(*this);
  Statement query(lease,
                  "SELECT * FROM config WHERE version IN "
                  "(SELECT max(version) FROM config GROUP BY robot) ORDER BY version");
  return all_configs(query);
}

std::vector<ConfigText> Archive::configs(const ConfigFilter& filter) const {
  const Lease lease(*this);
  std::string where = "FROM config WHERE true";
  if (filter.robot) where += " AND robot = ?1";
  if (filter.before) where += " AND version < ?2";
  Statement query(lease, select("*", where + " ORDER BY version DESC LIMIT ?3"));
  query.bind(filter.robot, filter.before, filter.limit);
  return all_configs(query);
}

std::vector<OutboxMessage> Archive::outbox() const {
  const Lease lease(*this);
  Statement query(lease, kOutbox);
  std::vector<OutboxMessage> messages;
  while (query.step()) {
    messages.push_back({.event_id = query.text(0),
                        .robot = query.text(1),
                        .payload = query.text(2),
                        .delivered = query.integer(3) != 0});
  }
  return messages;
}

std::vector<StoredAlert> Archive::alerts(std::int64_t after, std::size_t limit) const {
  const Lease lease(*this);
  Statement query(lease, "SELECT id, robot, payload FROM alert WHERE id > ?1 ORDER BY id LIMIT ?2");
  query.bind(after, limit);
  return all_alerts(query);
}

std::vector<StoredAlert> Archive::alerts_of(const std::string& incident_id) const {
  const Lease lease(*this);
  Statement query(lease, "SELECT id, robot, payload FROM alert WHERE incident = ?1 ORDER BY id");
  query.bind(incident_id);
  return all_alerts(query);
}

AlertNumbers Archive::alert_numbers() const {
  const Lease lease(*this);
  Statement query(lease, kAlertNumbers);
  query.step();
  return {.first = query.integer(1), .last = query.integer(0)};
}

std::vector<Gap> Archive::gaps() const {
  const Lease lease(*this);
  Statement query(lease, "SELECT since, until, reason, scores FROM gap ORDER BY id");
  std::vector<Gap> gaps;
  while (query.step()) {
    gaps.push_back({.since = query.stamp(0), .until = query.stamp(1), .reason = query.text(2)});
    if (!query.is_null(3)) gaps.back().scores = static_cast<std::uint64_t>(query.integer(3));
  }
  return gaps;
}

std::vector<NumberedAuditEntry> Archive::audit(std::optional<std::int64_t> before,
                                               std::size_t limit) const {
  return audit_entries(Lease(*this), before, limit);
}

std::optional<std::int64_t> Archive::broken_audit_entry() const {
  return first_broken_audit_entry(Lease(*this));
}

std::vector<RobotHistory> Archive::robots(std::size_t natural_scores) const {
  const Lease lease(*this);
  const auto all_recent = recent(lease);
  Statement query(lease, "SELECT name FROM robot ORDER BY name");
  std::vector<RobotHistory> robots;
  while (query.step()) {
    auto found = history(lease, *all_recent, query.text(0), natural_scores);
    if (!found) continue;
    found->learned = learned(lease, found->robot);
    robots.push_back(std::move(*found));
  }
  return robots;
}

}  // namespace kidnapwatch::storage
