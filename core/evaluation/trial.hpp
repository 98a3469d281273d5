// SPDX-License-Identifier: Apache-2.0
// A detector tried on a recorded run: it learns on the first half and is judged on the second.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/evaluation/confounders.hpp"
#include "core/evaluation/kidnaps.hpp"
#include "core/evaluation/subject.hpp"

namespace kidnapwatch::core::evaluation {

struct TrialConfig {
  std::size_t episodes = 20;       ///< of each kind, at most
  std::size_t episode_scans = 8;   ///< after the event
  std::size_t carry_scans = 32;    ///< the same for slow carries
  std::size_t deciding_scans = 3;  ///< of them, whose highest score is the episode's
  std::uint64_t seed = 1;
};

/// What a detector made of one episode.
struct EpisodeResult {
  double score = 0.0;    ///< the highest of the deciding scans
  double highest = 0.0;  ///< of all scans
  bool alarm = false;    ///< within the episode, at the robot's own threshold
  bool carried = false;  ///< by the alarm for slow carries
  std::optional<Cause> cause;
};

/// One detector on one run.
struct TrialResult {
  std::optional<double> threshold;  ///< that the first half gave; its own, no lower than a fleet's
  std::optional<double> own_threshold;  ///< the same without a fleet
  std::vector<double> natural;          ///< scores of the second half's pairs
  std::size_t alarms = 0;               ///< natural pairs above the threshold
  std::size_t carry_alarms = 0;         ///< on natural scans
  std::size_t skipped = 0;              ///< scans of the second half that cannot be compared
  std::map<std::string, std::size_t> troubles;  ///< scans of the second half, by trouble
  std::map<std::string, std::vector<EpisodeResult>> kidnaps;
  std::map<std::string, std::vector<EpisodeResult>> confounders;
};

/// What happens in the second half of a run, the same for every detector.
struct Plan {
  struct Entry {
    std::string kind;
    bool is_kidnap = false;
    Episode episode;
  };
  std::vector<Entry> entries;  ///< in order of episode.at
};

/// Episodes of every kind that the recording has room for, at random places of its second half.
[[nodiscard]] Plan plan(const Recording& recording, const TrialConfig& config);

/// Drives `subject` through the recording, and copies of it through the plan's episodes.
[[nodiscard]] TrialResult trial(const Recording& recording, const Plan& plan,
                                const TrialConfig& config, std::unique_ptr<Subject> subject);

}  // namespace kidnapwatch::core::evaluation
