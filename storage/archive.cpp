// SPDX-License-Identifier: Apache-2.0
// The statements that read.
#include "storage/archive.hpp"

#include <algorithm>
#include <chrono>
#include <map>

#include "storage/rows.hpp"

namespace kidnapwatch::storage {
namespace {

using core::ns_since_epoch;

constexpr std::chrono::seconds kAroundEvidence{10};
constexpr std::size_t kMaxEvidenceScores = 1000;

std::string select(std::string_view columns, std::string_view rest) {
  return "SELECT " + std::string(columns) + " " + std::string(rest);
}

std::vector<core::Score> scores_of(Database& database, const std::string& robot, core::Stamp from,
                                   core::Stamp to, std::size_t limit) {
  Statement query(database, select(kScoreColumns,
                                   "FROM score WHERE robot = (SELECT id FROM robot WHERE name = ?1)"
                                   " AND stamp >= ?2 AND stamp < ?3 ORDER BY stamp, id LIMIT ?4"));
  query.bind(robot, ns_since_epoch(from), ns_since_epoch(to), limit);
  std::vector<core::Score> scores;
  while (query.step()) scores.push_back(score_from(query, 0));
  return scores;
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

ConfigText config_from(const Statement& row) {
  return {.version = row.integer(0),
          .since = core::stamp_from_ns(row.integer(1)),
          .author = row.text(2),
          .text = row.text(3)};
}

bool is_natural(const core::Score& score) {
  return score.state == core::RobotState::normal || score.state == core::RobotState::unknown;
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

Archive::Archive(std::filesystem::path file) : file_(std::move(file)) {}

Archive::~Archive() = default;

std::vector<core::Score> Archive::scores(const std::string& robot, core::Stamp from, core::Stamp to,
                                         std::size_t limit) const {
  const Lease lease(*this);
  return scores_of(lease, robot, from, to, limit);
}

std::vector<core::Incident> Archive::incidents(const IncidentFilter& filter) const {
  const Lease lease(*this);
  std::string where = "FROM incident WHERE opened_at >= ?4 AND opened_at < ?5";
  if (filter.robot) where += " AND robot = ?1";
  if (filter.state) where += " AND state = ?2";
  if (filter.kind) where += " AND kind = ?3";
  if (filter.before_id) where += " AND id < ?6";
  Statement query(lease, select(kIncidentColumns, where + " ORDER BY id DESC LIMIT ?7"));
  query.bind(filter.robot, text(filter.state), text(filter.kind),
             ns_since_epoch(filter.opened_from), ns_since_epoch(filter.opened_to), filter.before_id,
             filter.limit);
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
  const Transaction one_look(database, Transaction::Kind::read);
  const auto incident = find_incident(database, incident_id);
  auto scans = find_scans(database, incident_id);
  if (!incident || !scans) return std::nullopt;
  auto scores = scores_of(database, incident->robot, scans->before.stamp - kAroundEvidence,
                          scans->after.stamp + kAroundEvidence, kMaxEvidenceScores);
  return core::Evidence{.scans = std::move(*scans), .scores = std::move(scores)};
}

std::optional<ConfigText> Archive::config() const {
  const Lease lease(*this);
  Statement query(lease, "SELECT * FROM config ORDER BY version DESC LIMIT 1");
  if (!query.step()) return std::nullopt;
  return config_from(query);
}

std::vector<ConfigText> Archive::configs() const {
  const Lease lease(*this);
  Statement query(lease, "SELECT * FROM config ORDER BY version DESC");
  std::vector<ConfigText> configs;
  while (query.step()) configs.push_back(config_from(query));
  return configs;
}

std::vector<RobotHistory> Archive::robots(std::size_t natural_scores) const {
  const Lease lease(*this);
  Statement query(lease, "SELECT name, arrival, " + std::string(kScoreColumns) +
                             " FROM score JOIN robot ON robot.id = robot ORDER BY score.id DESC");
  std::map<std::string, RobotHistory> found;
  while (query.step()) {
    const auto score = score_from(query, 2);
    const auto [robot, is_new] = found.try_emplace(query.text(0));
    auto& history = robot->second;
    if (is_new) {
      history = {robot->first, core::stamp_from_ns(query.integer(1)), score, {}};
    }
    auto& natural = history.natural_scores;
    if (is_natural(score) && natural.size() < natural_scores) {
      natural.push_back(score.dissimilarity.cost);
    }
  }
  std::vector<RobotHistory> histories;
  for (auto& [name, history] : found) {
    std::ranges::reverse(history.natural_scores);
    histories.push_back(std::move(history));
  }
  return histories;
}

}  // namespace kidnapwatch::storage
