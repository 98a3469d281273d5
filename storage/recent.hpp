// SPDX-License-Identifier: Apache-2.0
// The hot table in memory: the latest scores of every robot, which are in no block yet.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "storage/block.hpp"

namespace kidnapwatch::storage {

/// Scores that become blocks together; numbered in order of arrival.
using Segment = std::int64_t;

/// A score on its way to the store.
struct ScoreRow {
  std::string robot;
  core::Score score;
  core::Stamp arrival;
};

struct RecentScore {
  Segment segment = 0;
  ArrivedScore arrived;
};

/// Holds the durable rows of at most two segments, so that no read has to look through a hot table
/// for one robot (300,000 rows: 60 ms). Any thread.
class RecentScores {
 public:
  void add(Segment segment, std::span<const ScoreRow> rows);
  void drop(Segment segment);

  /// In order of arrival.
  [[nodiscard]] std::vector<RecentScore> of(const std::string& robot) const;
  [[nodiscard]] std::vector<ArrivedScore> of(const std::string& robot, Segment segment) const;
  [[nodiscard]] std::vector<std::string> robots(Segment segment) const;

  struct Size {
    std::size_t scores = 0;
    std::size_t robots = 0;
  };
  [[nodiscard]] Size size(Segment segment) const;

 private:
  struct Content {
    std::unordered_map<std::string, std::vector<ArrivedScore>> robots;
    std::size_t scores = 0;
  };

  mutable std::mutex mutex_;
  std::map<Segment, Content> segments_;
};

}  // namespace kidnapwatch::storage
