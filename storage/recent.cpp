// SPDX-License-Identifier: Apache-2.0
// The hot table in memory.
#include "storage/recent.hpp"

namespace kidnapwatch::storage {

void RecentScores::add(Segment segment, std::span<const ScoreRow> rows) {
  const std::lock_guard lock(mutex_);
  Content& content = segments_[segment];
  for (const ScoreRow& row : rows) content.robots[row.robot].push_back({row.score, row.arrival});
  content.scores += rows.size();
}

void RecentScores::drop(Segment segment) {
  Content dropped;  // freed without the lock
  const std::lock_guard lock(mutex_);
  if (const auto found = segments_.find(segment); found != segments_.end()) {
    std::swap(dropped, found->second);
    segments_.erase(found);
  }
}

std::vector<RecentScore> RecentScores::of(const std::string& robot) const {
  const std::lock_guard lock(mutex_);
  std::vector<RecentScore> scores;
  for (const auto& [segment, content] : segments_) {
    const auto found = content.robots.find(robot);
    if (found == content.robots.end()) continue;
    for (const auto& arrived : found->second) scores.push_back({segment, arrived});
  }
  return scores;
}

std::vector<ArrivedScore> RecentScores::of(const std::string& robot, Segment segment) const {
  const std::lock_guard lock(mutex_);
  const auto content = segments_.find(segment);
  if (content == segments_.end()) return {};
  const auto found = content->second.robots.find(robot);
  return found == content->second.robots.end() ? std::vector<ArrivedScore>() : found->second;
}

std::vector<std::string> RecentScores::robots(Segment segment) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> robots;
  const auto content = segments_.find(segment);
  if (content == segments_.end()) return robots;
  robots.reserve(content->second.robots.size());
  for (const auto& [robot, scores] : content->second.robots) robots.push_back(robot);
  return robots;
}

RecentScores::Size RecentScores::size(Segment segment) const {
  const std::lock_guard lock(mutex_);
  const auto content = segments_.find(segment);
  if (content == segments_.end()) return {};
  return {.scores = content->second.scores, .robots = content->second.robots.size()};
}

}  // namespace kidnapwatch::storage
