// SPDX-License-Identifier: Apache-2.0
// The experiments: what runs where, and how their pieces come together.
#include "service/evaluate/paper_study.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "adapters/logs/labelled_scores.hpp"
#include "adapters/logs/log.hpp"
#include "core/bad_input.hpp"
#include "core/dissimilarity_detector.hpp"
#include "core/evaluation/held_out.hpp"
#include "core/study/systems.hpp"
#include "service/evaluate/parallel.hpp"

namespace kidnapwatch::service {
namespace {

namespace study = core::study;
namespace evaluation = core::evaluation;

constexpr double kLeastShare = 0.5;  // of the kidnappings asked for, for a run to count
constexpr std::size_t kSimulatedRuns = 10;
constexpr std::string_view kCounter = "map_update_count";  // tells how late it is, no score
constexpr double kNoScore = 1e-6;                          // a logarithm needs something

/// The paper's reach and noise with everything; others without MCL, which takes the most time.
std::vector<study::Stage> stages(const PaperOptions& options) {
  const study::Systems systems{
      .dtw = true, .ndt = options.wants({8, 9}), .mcl = options.wants({6, 7})};
  const study::Systems without_mcl{.dtw = true, .ndt = systems.ndt, .mcl = false};
  const bool trials_wanted = options.wants({2, 3, 6, 7, 8, 9});
  std::vector<study::Stage> all;
  for (const auto& world :
       {core::sim::turns_world(), core::sim::tee_world(), core::sim::ring_world()}) {
    if (!trials_wanted) break;
    const auto add = [&](double range_max_m, double variance_m2, const study::Systems& run) {
      all.emplace_back(
          world, study::Setting{range_max_m, variance_m2, options.steps, options.particles, run});
    };
    add(3.5, 0.1, systems);
    add(3.5, 0.01, without_mcl);
    add(3.5, 1e-4, without_mcl);
    add(8.0, 0.1, without_mcl);
  }
  return all;
}

std::vector<study::Condition> run_trials(const PaperOptions& options) {
  const auto all = stages(options);
  std::vector<std::vector<std::vector<study::TrialRecord>>> records(
      all.size(), std::vector<std::vector<study::TrialRecord>>(options.trials));
  in_parallel(all.size() * options.trials, options.threads, "trials", [&](std::size_t i) {
    const std::size_t stage = i % all.size();
    const std::size_t trial = i / all.size();
    records[stage][trial] = all[stage].trial(options.seed + trial);
  });
  std::vector<study::Condition> conditions;
  for (std::size_t i = 0; i < all.size(); ++i) {
    conditions.push_back(study::condition(all[i], records[i]));
  }
  return conditions;
}

std::vector<std::filesystem::path> files(const std::filesystem::path& folder,
                                         std::string_view ending) {
  std::vector<std::filesystem::path> found;
  if (!is_directory(folder)) return found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().string().ends_with(ending)) found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

/// The six variants of the reading, and NDT's four scores: all that needs no map.
study::Detectors mapless(const study::Reading& reading) {
  study::Detectors detectors;
  for (const auto& config : core::dtw_variants(reading.dissimilarity)) {
    detectors.push_back({study::id_of(config), core::dissimilarity_detector(config)});
  }
  for (auto& ndt : study::ndt_systems()) detectors.push_back(std::move(ndt));
  return detectors;
}

/// In place of a recorded one, of twice T scans: a tour of one of the worlds.
core::Recording simulated_run(const PaperOptions& options, std::size_t number) {
  const std::array worlds{core::sim::turns_world(), core::sim::tee_world(), core::sim::ring_world(),
                          core::sim::corridor_world(), core::sim::room_world()};
  const core::sim::World& world = worlds.at(number % worlds.size());
  core::sim::Drive drive(world, study::TrialConfig{}.robot, options.seed + number, core::Stamp{});
  core::Recording run{world.name, {}};
  while (run.scans.size() < 2 * options.steps) run.scans.push_back(drive.next(1.0));
  return run;
}

std::vector<study::RecordedScores> score_runs(const PaperOptions& options) {
  const auto logs = files(options.data, ".scan.gz");
  const bool recorded = !logs.empty();
  std::vector<study::RecordedScores> scores(recorded ? logs.size() : kSimulatedRuns);
  in_parallel(scores.size(), options.threads, "runs", [&](std::size_t i) {
    scores[i] = study::recorded_scores(
        recorded ? adapters::logs::read_log(logs[i]).recording : simulated_run(options, i),
        [&] { return mapless(options.reading); },
        {.kidnappings = options.kidnappings,
         .seed = options.seed,
         .particles = options.particles,
         .me_polarity = options.reading.me_polarity});
  });
  const double least = kLeastShare * static_cast<double>(options.kidnappings);
  std::erase_if(scores, [&](const study::RecordedScores& run) {
    return static_cast<double>(std::min(run.kidnapped.size(), run.natural.size())) < least;
  });
  return scores;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values.empty() ? 0.0 : values[values.size() / 2];
}

using Rows = std::vector<std::vector<double>>;

std::vector<double> column(const Rows& rows, std::size_t c, core::Polarity polarity) {
  std::vector<double> values;
  for (const auto& row : rows) values.push_back(core::raised(row[c], polarity));
  return values;
}

NamedRoc pooled(const std::vector<study::RecordedScores>& runs, std::size_t c) {
  std::vector<double> natural;
  std::vector<double> kidnapped;
  std::vector<double> areas;
  for (const auto& run : runs) {
    const auto polarity = run.polarities[c];
    const auto n = column(run.natural, c, polarity);
    const auto k = column(run.kidnapped, c, polarity);
    areas.push_back(evaluation::roc(n, k).auc);
    natural.insert(natural.end(), n.begin(), n.end());
    kidnapped.insert(kidnapped.end(), k.begin(), k.end());
  }
  return {runs.front().ids[c], evaluation::roc(natural, kidnapped), median(areas)};
}

/// Of examples by run: the curve of the probabilities that models of the other runs give them.
NamedRoc regressed(const std::vector<std::vector<evaluation::Example>>& runs,
                   const evaluation::HeldOut& held_out) {
  std::vector<double> natural;
  std::vector<double> kidnapped;
  std::vector<double> areas;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    std::vector<double> n;
    std::vector<double> k;
    for (std::size_t i = 0; i < runs[run].size(); ++i) {
      (runs[run][i].kidnapped ? k : n).push_back(held_out.probabilities[run][i]);
    }
    if (!n.empty() && !k.empty()) areas.push_back(evaluation::roc(n, k).auc);
    natural.insert(natural.end(), n.begin(), n.end());
    kidnapped.insert(kidnapped.end(), k.begin(), k.end());
  }
  return {"logistic regression", evaluation::roc(natural, kidnapped), median(areas)};
}

void regress(const std::vector<std::vector<evaluation::Example>>& runs,
             const std::vector<std::string>& ids, RocStudy& result) {
  const auto held_out = evaluation::held_out(runs, {.ridge = 1e-3});
  result.regression = regressed(runs, held_out);
  for (std::size_t f = 0; f < ids.size(); ++f) {
    if (held_out.times_selected[f] > 0) {
      result.selected.emplace_back(ids[f], held_out.times_selected[f]);
    }
  }
}

std::vector<evaluation::Example> examples(const study::RecordedScores& run) {
  std::vector<evaluation::Example> result;
  const auto add = [&](const Rows& rows, bool kidnapped) {
    for (std::vector<double> row : rows) {
      for (double& score : row) score = std::log(kNoScore + score);
      result.push_back({std::move(row), kidnapped});
    }
  };
  add(run.natural, false);
  add(run.kidnapped, true);
  return result;
}

std::optional<RocStudy> study_runs(const PaperOptions& options) {
  const auto runs = score_runs(options);
  if (runs.size() < 2) return std::nullopt;
  const bool recorded = !files(options.data, ".scan.gz").empty();
  RocStudy result{std::string(recorded ? "recorded" : "simulated") +
                      " runs with kidnappings of 3 m and more cut in",
                  runs.size(),
                  {},
                  {},
                  {}};
  for (std::size_t c = 0; c < runs.front().ids.size(); ++c) {
    result.single.push_back(pooled(runs, c));
  }
  std::vector<std::vector<evaluation::Example>> all;
  all.reserve(runs.size());
  for (const auto& run : runs) all.push_back(examples(run));
  regress(all, runs.front().ids, result);
  return result;
}

double auc_of_run(const std::vector<evaluation::Example>& run, std::size_t f, double sign) {
  std::vector<double> natural;
  std::vector<double> lost;
  for (const auto& example : run) {
    (example.kidnapped ? lost : natural).push_back(sign * example.features[f]);
  }
  return natural.empty() || lost.empty() ? 0.5 : evaluation::roc(natural, lost).auc;
}

/// Both ways of a score, and the better of them: nobody says what a column's polarity is.
NamedRoc labelled_roc(const std::vector<std::vector<evaluation::Example>>& runs, std::size_t f,
                      const std::string& id) {
  std::vector<double> natural;
  std::vector<double> lost;
  for (const auto& run : runs) {
    for (const auto& example : run)
      (example.kidnapped ? lost : natural).push_back(example.features[f]);
  }
  auto curve = evaluation::roc(natural, lost);
  const double sign = curve.auc >= 0.5 ? 1.0 : -1.0;
  if (sign < 0.0) {
    for (auto* values : {&natural, &lost}) {
      std::ranges::transform(*values, values->begin(), std::negate<>());
    }
    curve = evaluation::roc(natural, lost);
  }
  std::vector<double> areas;
  areas.reserve(runs.size());
  for (const auto& run : runs) areas.push_back(auc_of_run(run, f, sign));
  return {sign > 0.0 ? id : id + " (falls)", curve, median(areas)};
}

void leave_out(std::string_view id, std::vector<std::string>& ids,
               std::vector<std::vector<evaluation::Example>>& runs) {
  const auto found = std::ranges::find(ids, id);
  if (found == ids.end()) return;
  const auto f = found - ids.begin();
  ids.erase(found);
  for (auto& run : runs) {
    for (auto& example : run) example.features.erase(example.features.begin() + f);
  }
}

std::optional<RocStudy> study_milvus(const PaperOptions& options) {
  const auto tables = files(options.data / "milvus_loss_labels", "_labeled.csv.gz");
  if (tables.size() < 2) return std::nullopt;
  std::vector<std::string> ids;
  std::vector<std::vector<evaluation::Example>> runs;
  for (const auto& file : tables) {
    const auto table = adapters::logs::read_labelled_scores(file);
    ids = table.names;
    auto& run = runs.emplace_back();
    for (const auto& row : table.rows) run.push_back({row.scores, row.lost});
  }
  leave_out(kCounter, ids, runs);
  RocStudy result{"real runs of two robots, labelled by their makers", runs.size(), {}, {}, {}};
  for (std::size_t f = 0; f < ids.size(); ++f) {
    result.single.push_back(labelled_roc(runs, f, ids[f]));
  }
  std::ranges::sort(result.single, std::greater<>(), [](const auto& one) { return one.roc.auc; });
  regress(runs, ids, result);
  return result;
}

}  // namespace

bool PaperOptions::wants(std::initializer_list<int> wanted) const {
  return figures.empty() || std::ranges::any_of(wanted, [&](int figure) {
           return std::ranges::find(figures, figure) != figures.end();
         });
}

PaperResults run_paper(const PaperOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  PaperResults results;
  results.conditions = run_trials(options);
  if (options.wants({13, 15})) {
    results.roc = study_runs(options);
    results.milvus = study_milvus(options);
  }
  results.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return results;
}

}  // namespace kidnapwatch::service
