// SPDX-License-Identifier: Apache-2.0
// Hot tables in turns, and their packing into blocks.
#include "storage/segments.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "storage/rows.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr std::size_t kRowsPerLoad = 1000;

std::string hot_table(Segment segment) { return segment % 2 == 0 ? "score_even" : "score_odd"; }

std::string insert_into(Segment segment) {
  return "INSERT INTO " + hot_table(segment) + " (robot, arrival, " + std::string(kScoreColumns) +
         ") VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)";
}

std::string empty(Segment segment) { return "DELETE FROM " + hot_table(segment); }

std::size_t turn(Segment segment) { return static_cast<std::size_t>(segment % 2); }

Segment open_segment(Database& database) { return database.integer("SELECT open FROM segment"); }

void load(Database& database, Segment segment, RecentScores& recent) {
  Statement query(database, "SELECT name, arrival, " + std::string(kScoreColumns) + " FROM " +
                                hot_table(segment) + " AS hot JOIN robot ON robot.id = robot " +
                                "ORDER BY hot.id");
  std::vector<ScoreRow> rows;
  for (bool more = true; more;) {
    rows.clear();
    while (rows.size() < kRowsPerLoad && (more = query.step())) {
      rows.push_back({query.text(0), score_from(query, 2), query.stamp(1)});
    }
    if (!rows.empty()) recent.add(segment, rows);
  }
}

/// Robots whose scores of this segment, the latest one packed, were packed before the service
/// stopped.
std::set<std::string> packed_robots(Database& database, Segment segment) {
  Statement query(database,
                  "SELECT name FROM rollup_open AS open JOIN robot ON robot.id = open.robot "
                  "WHERE segment = ?1");
  query.bind(segment);
  std::set<std::string> robots;
  while (query.step()) robots.insert(query.text(0));
  return robots;
}

}  // namespace

std::shared_ptr<RecentScores> hot_scores(Database& database) {
  const Transaction one_look(database, Transaction::Kind::read);
  auto recent = std::make_shared<RecentScores>();
  const Segment open = open_segment(database);
  for (const Segment segment : {open - 1, open}) load(database, segment, *recent);
  return recent;
}

RobotIds::RobotIds(Database& database)
    : database_(database),
      find_(database, "SELECT id FROM robot WHERE name = ?1"),
      add_(database, "INSERT INTO robot (name) VALUES (?1)") {}

std::int64_t RobotIds::of(const std::string& robot) {
  if (const auto known = known_.find(robot); known != known_.end()) return known->second;
  const bool exists = find_.bind(robot).step();
  auto id = exists ? find_.integer(0) : 0;
  find_.bind();
  if (!exists) {
    add_.bind(robot).run();
    id = database_.last_row_id();
  }
  known_.emplace(robot, id);
  return id;
}

Segments::Segments(Database& database, SegmentConfig config)
    : config_(config),
      robot_ids_(database),
      rollups_(database),
      add_score_{Statement(database, insert_into(0)), Statement(database, insert_into(1))},
      empty_{Statement(database, empty(0)), Statement(database, empty(1))},
      add_block_(database,
                 "INSERT INTO block (robot, segment, arrival, first_stamp, last_stamp, data) "
                 "VALUES (?1, ?2, ?3, ?4, ?5, ?6)"),
      set_open_(database, "UPDATE segment SET open = ?1"),
      recent_(hot_scores(database)) {
  const Segment closed = open_segment(database) - 1;
  state_ = {.open = closed + 1, .packing = recent_->size(closed).scores > 0, .packed = 0};
  next_ = state_;
  if (!state_.packing) return;
  const auto packed = packed_robots(database, closed);
  waiting_ = recent_->robots(closed);
  std::erase_if(waiting_, [&](const auto& robot) { return packed.contains(robot); });
}

void Segments::write(std::span<const ScoreRow> rows) {
  if (state_.packing) {
    pack_some();
  } else if (is_full()) {
    close();
  }
  rows_ = rows;
  for (const ScoreRow& row : rows) {
    auto& insert = add_score_.at(turn(next_.open));
    bind_score(insert, robot_ids_.of(row.robot), row.arrival, row.score);
    insert.run();
  }
}

bool Segments::is_full() const {
  const auto size = recent_->size(state_.open);
  return size.scores > 0 &&
         size.scores >= std::min(config_.max_scores, config_.scores_per_robot * size.robots);
}

void Segments::close() {
  waiting_ = recent_->robots(state_.open);
  next_ = {.open = state_.open + 1, .packing = true, .packed = 0};
  set_open_.bind(next_.open).run();
}

void Segments::pack_some() {
  const Segment closed = state_.open - 1;
  const auto end = std::min(waiting_.size(), state_.packed + config_.robots_per_commit);
  for (; next_.packed < end; ++next_.packed) pack(waiting_[next_.packed], closed);
  if (end < waiting_.size()) return;
  empty_.at(turn(closed)).run();
  next_.packing = false;
}

void Segments::pack(const std::string& robot, Segment segment) {
  const auto id = robot_ids_.of(robot);
  const auto scores = recent_->of(robot, segment);
  rollups_.add(id, segment, scores);
  for (const Block& block : blocks(scores)) {
    add_block_.bind(id, segment, block.arrival, block.first, block.last, block.data).run();
  }
}

void Segments::committed() {
  if (!rows_.empty()) recent_->add(next_.open, rows_);
  if (state_.packing && !next_.packing) recent_->drop(state_.open - 1);
  state_ = next_;
  rows_ = {};
}

void Segments::undone() {
  robot_ids_.forget();
  next_ = state_;
  rows_ = {};
}

}  // namespace kidnapwatch::storage
