// SPDX-License-Identifier: Apache-2.0
// Blocks and recent scores, put together without doubles or holes.
#include "storage/scores.hpp"

#include <algorithm>
#include <set>

#include "storage/block.hpp"

namespace kidnapwatch::storage {
namespace {

using core::RobotState;
using core::Score;
using core::Stamp;

constexpr int kMaxBlocksLookedBack = 64;

bool is_earlier(const Score& a, const Score& b) { return a.stamp < b.stamp; }

/// Scores in the range, as they are found; ordered and cut in the end.
struct Gathered {
  Stamp from;
  Stamp to;
  std::vector<Score> scores;
  bool is_ordered = true;

  /// The stamps of `block` ascend.
  void add(std::span<const Score> block) {
    const auto begin = std::ranges::lower_bound(block, from, {}, &Score::stamp);
    const auto end = std::ranges::lower_bound(block, to, {}, &Score::stamp);
    if (begin >= end) return;
    is_ordered = is_ordered && (scores.empty() || !is_earlier(*begin, scores.back()));
    scores.insert(scores.end(), begin, end);
  }
  void order() {
    if (!is_ordered) std::ranges::stable_sort(scores, is_earlier);
    is_ordered = true;
  }
  /// Whether none that begins at `stamp` belongs to the first `limit`.
  [[nodiscard]] bool is_complete(std::size_t limit, Stamp stamp) {
    if (scores.size() < limit) return false;
    order();
    return limit == 0 || scores[limit - 1].stamp < stamp;
  }
};

Stamp before_by_a_block(Stamp stamp) {
  return stamp < Stamp::min() + kMaxBlockSpan ? Stamp::min() : stamp - kMaxBlockSpan;
}

constexpr std::string_view kBlocksBetween =
    "FROM block WHERE robot = (SELECT id FROM robot WHERE name = ?1) AND first_stamp >= ?2 "
    "AND first_stamp < ?3 AND last_stamp >= ?4 ";

Statement blocks_between(Database& database, const std::string& robot, Stamp from, Stamp to) {
  Statement query(database, "SELECT first_stamp, segment, data " + std::string(kBlocksBetween) +
                                "ORDER BY first_stamp");
  query.bind(robot, before_by_a_block(from), to, from);
  return query;
}

/// How many there are, but not more than `limit`; a look at the index.
std::size_t count_blocks(Database& database, const std::string& robot, Stamp from, Stamp to,
                         std::size_t limit) {
  Statement query(database,
                  "SELECT count(*) FROM (SELECT 1 " + std::string(kBlocksBetween) + "LIMIT ?5)");
  query.bind(robot, before_by_a_block(from), to, from, limit).step();
  return static_cast<std::size_t>(query.integer(0));
}

Statement latest_blocks(Database& database, const std::string& robot) {
  Statement query(database,
                  "SELECT arrival, segment, data FROM block "
                  "WHERE robot = (SELECT id FROM robot WHERE name = ?1) "
                  "ORDER BY first_stamp DESC LIMIT ?2");
  query.bind(robot, kMaxBlocksLookedBack);
  return query;
}

std::set<Segment> segments(const std::vector<RecentScore>& scores) {
  std::set<Segment> segments;
  for (const auto& score : scores) segments.insert(score.segment);
  return segments;
}

bool is_natural(const Score& score) {
  return score.state == RobotState::normal || score.state == RobotState::unknown;
}

/// A robot's scores from the latest back.
class LookBack {
 public:
  LookBack(std::string robot, std::size_t natural_scores)
      : wanted_(natural_scores), history_{.robot = std::move(robot)} {}

  void add(const Score& score, Stamp arrival) {
    if (!found_) {
      history_.latest = score;
      history_.last_arrival = arrival;
      found_ = true;
    }
    if (!is_done() && is_natural(score)) {
      history_.natural_scores.push_back(score.dissimilarity.cost);
    }
  }
  [[nodiscard]] bool is_done() const { return found_ && history_.natural_scores.size() >= wanted_; }
  [[nodiscard]] std::optional<RobotHistory> result() {
    if (!found_) return std::nullopt;
    std::ranges::reverse(history_.natural_scores);
    return std::move(history_);
  }

 private:
  std::size_t wanted_;
  bool found_ = false;
  RobotHistory history_;
};

}  // namespace

std::vector<Score> scores(Database& database, const RecentScores& recent, const std::string& robot,
                          Stamp from, Stamp to, std::size_t limit) {
  const auto in_memory = recent.of(robot);  // first: what is packed meanwhile is then found twice
  const auto known = segments(in_memory);
  Gathered gathered{.from = from, .to = to, .scores = {}};
  auto query = blocks_between(database, robot, from, to);
  while (query.step() && !gathered.is_complete(limit, query.stamp(0))) {
    if (known.contains(query.integer(1))) continue;
    const auto block = unpacked(query.blob(2));
    if (gathered.scores.empty() && !block.empty()) {  // growing costs more than reading
      const auto blocks = count_blocks(database, robot, from, to, limit / block.size() + 2);
      gathered.scores.reserve(block.size() * blocks);
    }
    gathered.add(block);
  }
  for (const auto& found : in_memory) gathered.add({&found.arrived.score, 1});
  gathered.order();
  if (gathered.scores.size() > limit) gathered.scores.resize(limit);
  return std::move(gathered.scores);
}

void for_packed_scores(Database& database, const std::string& robot, Stamp from, Stamp to,
                       const std::function<void(const Score&)>& take) {
  auto query = blocks_between(database, robot, from, to);
  while (query.step()) {
    for (const Score& score : unpacked(query.blob(2))) {
      if (score.stamp >= from && score.stamp < to) take(score);
    }
  }
}

std::optional<RobotHistory> history(Database& database, const RecentScores& recent,
                                    const std::string& robot, std::size_t natural_scores) {
  auto in_memory = recent.of(robot);
  const auto known = segments(in_memory);
  LookBack look_back(robot, natural_scores);
  std::ranges::reverse(in_memory);
  for (const auto& found : in_memory) look_back.add(found.arrived.score, found.arrived.arrival);
  auto query = latest_blocks(database, robot);
  while (!look_back.is_done() && query.step()) {
    if (known.contains(query.integer(1))) continue;
    auto block = unpacked(query.blob(2));
    std::ranges::reverse(block);
    for (const Score& score : block) look_back.add(score, query.stamp(0));
  }
  return look_back.result();
}

}  // namespace kidnapwatch::storage
