// SPDX-License-Identifier: Apache-2.0
// Three scores in a row decide, as in Session.
#include "core/evaluation/what_if.hpp"

#include <algorithm>
#include <array>

#include "core/names.hpp"

namespace kidnapwatch::core::evaluation {
namespace {

constexpr std::array<std::string_view, 2> kNames{"motion_consistency", "qs2ddtw"};
constexpr double kOutstanding = 2.0;  // as in Session::stands_out
constexpr double kSilence_s = 5.0;

bool is_natural(const Score& score) {
  return score.state == RobotState::normal || score.state == RobotState::unknown;
}

bool is_near(const WouldBe& would_be, const Incident& incident, double merge_s) {
  return later_by_s(would_be.last, merge_s) >= incident.before_stamp &&
         later_by_s(would_be.first, -merge_s) <= incident.scan_stamp;
}

}  // namespace

std::string_view name(TunedDetector detector) {
  return kNames.at(static_cast<std::size_t>(detector));
}

TunedDetector tuned_detector(std::string_view text, std::string_view field) {
  return named<TunedDetector>(kNames, text, field);
}

bool decided_on(TunedDetector detector, const Incident& incident) {
  const bool by_motion = incident.detector == name(TunedDetector::motion_consistency);
  return incident.kind != IncidentKind::carry &&
         by_motion == (detector == TunedDetector::motion_consistency);
}

std::optional<double> natural_score(TunedDetector detector, const Score& score) {
  if (!is_natural(score)) return std::nullopt;
  if (detector == TunedDetector::qs2ddtw) return score.dissimilarity.cost;
  return score.motion ? score.motion->confirmed : std::nullopt;
}

void WhatIf::add(const Score& score) {
  ++scores_;
  const double elapsed = elapsed_s(score.reference, score.stamp);
  if (elapsed > 0.0 && elapsed <= kSilence_s) observed_s_ += elapsed;
  Seen now{.stamp = score.stamp, .cost = score.dissimilarity.cost};
  if (score.motion) {
    now.motion = score.motion->score;
    now.confirmed = score.motion->confirmed.value_or(0.0);
  }
  if (const auto score_of_jump = alarm(now)) note(suspect_->stamp, *score_of_jump);
  before_ = suspect_;
  suspect_ = now;
}

/// Whether `now` confirms that the last pair was a jump.
std::optional<double> WhatIf::alarm(const Seen& now) const {
  if (!suspect_) return std::nullopt;
  if (detector_ == TunedDetector::motion_consistency) {
    const bool alarms = suspect_->motion > threshold_ && now.confirmed > threshold_;
    return alarms ? std::optional(now.confirmed) : std::nullopt;
  }
  const double around = std::max(before_ ? before_->cost : 0.0, now.cost);
  const bool alarms = suspect_->cost > threshold_ && suspect_->cost > kOutstanding * around;
  return alarms ? std::optional(suspect_->cost) : std::nullopt;
}

void WhatIf::note(Stamp stamp, double score) {
  const bool goes_on = !incidents_.empty() && elapsed_s(incidents_.back().last, stamp) < merge_s_;
  if (!goes_on) incidents_.push_back({.first = stamp, .last = stamp, .score = score});
  incidents_.back().last = stamp;
  incidents_.back().score = std::max(incidents_.back().score, score);
}

Difference difference(std::span<const Incident> incidents, std::span<const WouldBe> would_be,
                      double merge_s) {
  Difference result;
  for (const auto& incident : incidents) {
    const bool is_kept = std::ranges::any_of(
        would_be, [&](const WouldBe& one) { return is_near(one, incident, merge_s); });
    (is_kept ? result.kept : result.lost).push_back(incident);
  }
  for (const auto& one : would_be) {
    const bool is_new = std::ranges::none_of(
        incidents, [&](const Incident& incident) { return is_near(one, incident, merge_s); });
    if (is_new) result.raised.push_back(one);
  }
  return result;
}

}  // namespace kidnapwatch::core::evaluation
