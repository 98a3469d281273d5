// SPDX-License-Identifier: Apache-2.0
// The paper's claims as comparisons of summaries.
#include "core/study/claims.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/study/systems.hpp"

namespace kidnapwatch::core::study {
namespace {

using baselines::Relocalization;
using evaluation::Evaluator;

constexpr std::array kDimensions{Dimension::ranges, Dimension::points};

std::string two_digits(double value) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 2);
  return {text.data(), end.ptr};
}

/// Cases in which a claim was looked at, and what they said.
struct Cases {
  std::size_t all = 0;
  std::size_t held = 0;
  std::string text;

  void add(bool holds, const std::string& what) {
    ++all;
    held += holds ? 1U : 0U;
    if (!what.empty()) text += (text.empty() ? "" : "; ") + what;
  }
  [[nodiscard]] Verdict verdict() const {
    if (held == all) return Verdict::holds;
    return 2 * held >= all ? Verdict::partly : Verdict::fails;
  }
  [[nodiscard]] std::string share() const {
    return std::to_string(held) + " of " + std::to_string(all) + " cases";
  }
};

/// Looks summaries up.
class Measured {
 public:
  Measured(const Condition& condition, Evaluator evaluator)
      : condition_(condition), summaries_(summaries(condition, evaluator)) {}

  [[nodiscard]] bool has(const std::string& id) const { return summaries_.contains(id); }
  [[nodiscard]] double eta(const std::string& id) const {
    return summaries_.at(id).performance.mean;
  }
  [[nodiscard]] double undetected(const std::string& id) const {
    return summaries_.at(id).performance.undetected;
  }
  [[nodiscard]] double dips(const std::string& id) const { return summaries_.at(id).dips; }
  [[nodiscard]] const std::string& map() const { return condition_.map; }

 private:
  const Condition& condition_;
  const std::map<std::string, Summary>& summaries_;
};

std::vector<Measured> measured(std::span<const Condition> conditions, Evaluator evaluator,
                               const std::string& needed, bool main_only = true) {
  std::vector<Measured> found;
  for (const Condition& condition : conditions) {
    if (main_only && !is_main(condition)) continue;
    const Measured one(condition, evaluator);
    if (one.has(needed)) found.push_back(one);
  }
  return found;
}

void add(Claim claim, const Cases& cases, std::vector<Claim>& claims) {
  if (cases.all == 0) return;
  claim.measured = cases.share() + (cases.text.empty() ? "" : ". " + cases.text);
  claim.verdict = cases.verdict();
  claims.push_back(std::move(claim));
}

void judge_standardizing(std::span<const Condition> conditions, const Reading& reading,
                         std::vector<Claim>& claims) {
  Cases cases;
  for (const auto dimension : kDimensions) {
    const std::string raw = reading.id(dimension, Gate::never);
    const std::string standardized = reading.id(dimension, Gate::always);
    for (const Measured& at : measured(conditions, reading.evaluator, raw)) {
      cases.add(at.eta(standardized) < at.eta(raw),
                at.map() + (dimension == Dimension::points ? " 2-D " : " 1-D ") +
                    two_digits(at.eta(raw)) + " to " + two_digits(at.eta(standardized)));
    }
  }
  add({"2",
       "Standardizing always, as Algorithm 1 does, lowers the performance index.",
       {},
       {},
       "Standardizing removes how large the room is, which is much of what tells places apart."},
      cases, claims);
}

void judge_dimensions(std::span<const Condition> conditions, const Reading& reading,
                      std::vector<Claim>& claims) {
  Cases plain;
  Cases quasi;
  const auto compare = [&](Gate gate, Cases& cases) {
    const std::string flat = reading.id(Dimension::ranges, gate);
    const std::string points = reading.id(Dimension::points, gate);
    for (const Measured& at : measured(conditions, reading.evaluator, flat, false)) {
      cases.add(at.eta(points) > at.eta(flat), {});
    }
  };
  for (const auto gate : {Gate::never, Gate::always}) compare(gate, plain);
  for (const auto gate : {Gate::paper, Gate::homogeneous}) compare(gate, quasi);
  const std::string where = "The cases are all maps, reaches and noises that were run. ";
  add({"2",
       "Warping points (2-D) separates better than warping ranges (1-D).",
       {},
       {},
       where + "Points tell where a range was measured, ranges alone do not."},
      plain, claims);
  add({"3",
       "QS-2DDTW separates better than QS-1DDTW.",
       {},
       {},
       where + "The gate switches between metres and deviations. Ranges spread over less than 1 m, "
               "so that a natural pair's score grows when it is standardized, beyond that of "
               "kidnappings that are not; points spread over more, and it shrinks."},
      quasi, claims);
}

void judge_gate(Gate gate, std::span<const Condition> conditions, const Reading& reading,
                std::vector<Claim>& claims) {
  const std::string raw = reading.id(Dimension::points, Gate::never);
  const std::string quasi = reading.id(Dimension::points, gate);
  Cases cases;
  for (const Measured& at : measured(conditions, reading.evaluator, raw)) {
    cases.add(at.undetected(quasi) < at.undetected(raw),
              at.map() + ": eta <= 0 in " + two_digits(at.undetected(raw)) + " of runs, with the " +
                  "gate " + two_digits(at.undetected(quasi)) + "; black steps " +
                  two_digits(at.dips(raw)) + ", " + two_digits(at.dips(quasi)));
  }
  const bool as_printed = gate == Gate::paper;
  add({"3",
       as_printed ? "Quasi-standardizing with line 4 as printed (1 < V < c) lifts the steps where "
                    "raw 2-D DTW fails."
                  : "Quasi-standardizing whenever variances do not differ (V < c) lifts the steps "
                    "where raw 2-D DTW fails.",
       {},
       {},
       as_printed
           ? "1 < V < c on both axes is rare: the score is the raw one nearly everywhere."
           : "Natural pairs have like variances and get a score in deviations, which is smaller "
             "where points spread over more than 1 m; a kidnapping changes the variances and "
             "keeps its score in metres. The gate does the detecting; in a ring it cannot."},
      cases, claims);
}

void judge_weight(std::span<const Condition> conditions, std::vector<Claim>& claims) {
  const std::string none = mcw_id(Relocalization::none);
  const std::string perfect = mcw_id(Relocalization::perfect);
  Cases collapses;
  Cases recovers;
  for (const Measured& at : measured(conditions, Evaluator::all, none)) {
    collapses.add(at.undetected(none) >= 0.5,
                  at.map() + ": eta <= 0 in " + two_digits(at.undetected(none)));
    recovers.add(at.undetected(perfect) <= 0.5 * at.undetected(none),
                 at.map() + ": " + two_digits(at.undetected(none)) + " to " +
                     two_digits(at.undetected(perfect)) + ", global " +
                     two_digits(at.undetected(mcw_id(Relocalization::global))));
  }
  add({"6",
       "Maximum current weight collapses without relocalization (eta <= 0 in half of all runs "
       "or more).",
       {},
       {},
       "The filter stays lost, and later scans fit its particles as badly as the first one did."},
      collapses, claims);
  add({"7",
       "Maximum current weight recovers with perfect relocalization (at most half as many).",
       {},
       {},
       "Once the filter is right again, the weight is low at t_k alone."},
      recovers, claims);
}

void judge_entropy(std::span<const Condition> conditions, std::vector<Claim>& claims) {
  for (const auto polarity : {Polarity::hptf, Polarity::lptf}) {
    const std::string perfect = me_id(polarity, Relocalization::perfect);
    Cases cases;
    for (const Measured& at : measured(conditions, Evaluator::all, perfect)) {
      cases.add(at.undetected(perfect) < 0.5,
                at.map() + ": eta <= 0 in " + two_digits(at.undetected(perfect)));
    }
    add({"7",
         polarity == Polarity::hptf
             ? "Measurement entropy, HPTF as printed, finds kidnappings with relocalization."
             : "Measurement entropy, taken as LPTF, finds kidnappings with relocalization.",
         {},
         {},
         "Where no particle fits, the few that fit least badly take all the weight: entropy falls. "
         "It falls as well wherever a sharp scan makes one particle the best."},
        cases, claims);
  }
}

/// Scores that never see a pose estimate cannot depend on it.
void judge_independence(std::span<const Condition> conditions, const Reading& reading,
                        std::vector<Claim>& claims) {
  const std::string why =
      "The score compares two scans and knows no pose estimate; relocalization cannot change it.";
  if (!measured(conditions, Evaluator::all, "ndt_qe").empty()) {
    claims.push_back({"8, 9", "The metric-based detectors do not depend on relocalization.",
                      "the same scores with every relocalization", Verdict::by_construction, why});
  }
  const std::string quasi = reading.id(Dimension::points, reading.dissimilarity.gate);
  if (!measured(conditions, Evaluator::all, quasi).empty()) {
    claims.push_back({"6-9", "QS-2DDTW hardly depends on relocalization.",
                      "the same scores with every relocalization", Verdict::by_construction, why});
  }
}

void judge_best(std::span<const Condition> conditions, const Reading& reading,
                std::vector<Claim>& claims) {
  const std::string ours = reading.id(Dimension::points, reading.dissimilarity.gate);
  const std::vector<std::string> others{"ndt_qe",
                                        "ndt_qs",
                                        "ndt_qh",
                                        "ndt_qo",
                                        mcw_id(Relocalization::perfect),
                                        me_id(reading.me_polarity, Relocalization::perfect)};
  Cases cases;
  for (const Measured& at : measured(conditions, Evaluator::all, ours)) {
    if (!std::ranges::all_of(others, [&](const auto& id) { return at.has(id); })) continue;
    const auto best = std::ranges::min_element(
        others, {}, [&](const std::string& id) { return at.undetected(id); });
    cases.add(at.undetected(ours) <= at.undetected(*best),
              at.map() + ": eta <= 0 in " + two_digits(at.undetected(ours)) + ", of " + *best +
                  " in " + two_digits(at.undetected(*best)));
  }
  add({"6-9",
       "QS-2DDTW is the best of all (the least runs with eta <= 0, of all steps).",
       {},
       {},
       "Ranked by how often a kidnapping is not the run's most extreme step; the mean of eta "
       "changes with every monotone change of a score, and ranks nothing."},
      cases, claims);
}

void judge_ring(std::span<const Condition> conditions, const Reading& reading,
                std::vector<Claim>& claims) {
  Cases cases;
  for (const auto dimension : kDimensions) {
    for (const auto gate : {Gate::never, Gate::always, Gate::paper, Gate::homogeneous}) {
      const std::string id = reading.id(dimension, gate);
      for (const Measured& at : measured(conditions, reading.evaluator, id)) {
        if (at.map() != "ring") continue;
        cases.add(at.undetected(id) > 0.5, id + " " + two_digits(at.undetected(id)));
      }
    }
  }
  add({"–",
       "Not the paper's: in a ring every DTW variant fails (eta <= 0 in most runs).",
       {},
       {},
       "Every place looks like every other; nothing that compares two scans can tell."},
      cases, claims);
}

}  // namespace

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds:
      return "holds";
    case Verdict::partly:
      return "holds in part";
    case Verdict::by_construction:
      return "holds by construction";
    case Verdict::fails:
      break;
  }
  return "does not hold";
}

std::vector<Claim> claims(std::span<const Condition> conditions, const Reading& reading) {
  std::vector<Claim> result;
  judge_standardizing(conditions, reading, result);
  judge_dimensions(conditions, reading, result);
  for (const auto gate : {Gate::paper, Gate::homogeneous}) {
    judge_gate(gate, conditions, reading, result);
  }
  judge_weight(conditions, result);
  judge_entropy(conditions, result);
  judge_independence(conditions, reading, result);
  judge_best(conditions, reading, result);
  judge_ring(conditions, reading, result);
  return result;
}

}  // namespace kidnapwatch::core::study
