// SPDX-License-Identifier: Apache-2.0
// Episodes planned, and driven through.
#include "core/evaluation/trial.hpp"

#include <algorithm>
#include <limits>

namespace kidnapwatch::core::evaluation {
namespace {

constexpr std::size_t kTries = 4;     // per episode wanted
constexpr std::size_t kLead_in = 12;  // scans into the second half before the first episode

std::size_t half(const Recording& recording) { return recording.scans.size() / 2; }

/// FNV-1a: the same dice for the same log and kind on every platform.
Random dice(const Recording& recording, std::string_view kind, std::uint64_t seed) {
  std::uint64_t hash = 0xcbf29ce484222325U ^ seed;
  for (const std::string_view text : {std::string_view(recording.name), kind})
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return Random(hash);
}

/// Whether the event itself is between scans that can be compared.
bool is_visible(const Recording& recording, const Episode& episode) {
  const auto deciding = std::min<std::size_t>(3, episode.scans.size());
  return is_comparable(recording.scans[episode.at - 1].scan) &&
         std::all_of(episode.scans.begin(),
                     episode.scans.begin() + static_cast<std::ptrdiff_t>(deciding), is_comparable);
}

template <class Make>
void add(const Recording& recording, const TrialConfig& config, std::string_view kind,
         bool is_kidnap, std::size_t count, Make make, Plan& plan) {
  const std::size_t first = half(recording) + kLead_in;
  if (recording.scans.size() <= first + count) return;
  const std::size_t room = recording.scans.size() - first - count;
  Random random = dice(recording, kind, config.seed);
  std::size_t made = 0;
  for (std::size_t t = 0; t < kTries * config.episodes && made < config.episodes; ++t) {
    auto episode = make(first + pick(random, room), count, random);
    if (!episode || episode->at < half(recording) + 2 || !is_visible(recording, *episode)) continue;
    plan.entries.push_back({std::string(kind), is_kidnap, std::move(*episode)});
    ++made;
  }
}

EpisodeResult outcome(const Subject& before, const Episode& episode, const TrialConfig& config,
                      bool is_carry) {
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  EpisodeResult result{.score = kNone, .highest = kNone};
  const auto subject = before.copy();
  for (std::size_t i = 0; i < episode.scans.size(); ++i) {
    const auto reading = subject->observe(episode.scans[i], false);
    if (!reading) continue;
    if (i < config.deciding_scans || is_carry)
      result.score = std::max(result.score, reading->score);
    result.highest = std::max(result.highest, reading->score);
    result.carried = result.carried || reading->carried;
    const bool alarm = reading->alarm || reading->carried;
    if (alarm && !result.alarm) result.cause = reading->cause;
    result.alarm = result.alarm || alarm;
  }
  return result;
}

void note(const std::optional<Reading>& reading, TrialResult& result) {
  if (!reading) {
    ++result.skipped;
    return;
  }
  result.natural.push_back(reading->score);
  result.alarms += reading->alarm ? 1 : 0;
  result.carry_alarms += reading->carried ? 1 : 0;
  if (reading->trouble) ++result.troubles[std::string(name(*reading->trouble))];
}

}  // namespace

Plan plan(const Recording& recording, const TrialConfig& config) {
  Plan result;
  for (const Kidnap kind : kKidnaps) {
    const std::size_t count = kind == Kidnap::carry ? config.carry_scans : config.episode_scans;
    add(
        recording, config, name(kind), true, count,
        [&](std::size_t at, std::size_t scans, Random& random) {
          return kidnapped(recording, kind, at, scans, random);
        },
        result);
  }
  for (const Confounder kind : kConfounders) {
    add(
        recording, config, name(kind), false, config.episode_scans,
        [&](std::size_t at, std::size_t scans, Random& random) {
          return confounded(recording, kind, at, scans, random);
        },
        result);
  }
  std::ranges::stable_sort(result.entries, {}, [](const auto& entry) { return entry.episode.at; });
  return result;
}

TrialResult trial(const Recording& recording, const Plan& plan, const TrialConfig& config,
                  std::unique_ptr<Subject> subject) {
  TrialResult result;
  for (std::size_t i = 0; i < half(recording); ++i)
    (void)subject->observe(recording.scans[i].scan, true);
  result.threshold = subject->threshold();
  result.own_threshold = subject->own_threshold();
  auto entry = plan.entries.begin();
  for (std::size_t i = half(recording); i < recording.scans.size(); ++i) {
    for (; entry != plan.entries.end() && entry->episode.at == i; ++entry) {
      auto& group = entry->is_kidnap ? result.kidnaps : result.confounders;
      group[entry->kind].push_back(
          outcome(*subject, entry->episode, config, entry->kind == name(Kidnap::carry)));
    }
    note(subject->observe(recording.scans[i].scan, false), result);
  }
  return result;
}

}  // namespace kidnapwatch::core::evaluation
