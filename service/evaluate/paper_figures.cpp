// SPDX-License-Identifier: Apache-2.0
// Which systems are in which figure, and what is said below it.
#include "service/evaluate/paper_figures.hpp"

#include <utility>

#include "adapters/report/lines.hpp"
#include "adapters/report/strips.hpp"
#include "core/study/systems.hpp"

namespace kidnapwatch::service {
namespace {

namespace report = adapters::report;
namespace study = core::study;

using core::Dimension;
using core::Gate;
using core::baselines::Relocalization;
using core::evaluation::Evaluator;

using Labels = std::vector<std::pair<std::string, std::string>>;  // id, as shown

std::string two(double value) { return report::fixed(value, 2); }

report::Strip strip(const std::string& label, const study::Summary& summary) {
  return {
      label,
      summary.eta,
      {two(summary.performance.mean), two(summary.performance.undetected), two(summary.roc.auc)}};
}

/// A group of strips per map, at the paper's reach and noise.
report::StripFigure strips(const std::string& title, const PaperResults& results,
                           Evaluator evaluator, const Labels& systems) {
  report::StripFigure figure{title,
                             "t_k: the step of the kidnapping",
                             static_cast<double>(study::kFirstTk),
                             "mean η over the trials",
                             {"mean η", "η ≤ 0", "AUC"},
                             {}};
  for (const auto& condition : results.conditions) {
    if (!study::is_main(condition)) continue;
    report::StripGroup group{"map: " + condition.map, {}};
    const auto& found = study::summaries(condition, evaluator);
    for (const auto& [id, label] : systems) {
      const auto summary = found.find(id);
      if (summary != found.end()) group.strips.push_back(strip(label, summary->second));
    }
    if (!group.strips.empty()) figure.groups.push_back(std::move(group));
  }
  return figure;
}

std::string evaluator_words(Evaluator evaluator) {
  return evaluator == Evaluator::prior ? "against the steps before t_k" : "against all other steps";
}

Labels of_dtw(const study::Reading& reading, std::initializer_list<Gate> gates) {
  Labels labels;
  for (const auto dimension : {Dimension::ranges, Dimension::points}) {
    for (const auto gate : gates) {
      const std::string form = dimension == Dimension::points ? "2-D" : "1-D";
      const std::string name = gate == Gate::never         ? form + " raw"
                               : gate == Gate::always      ? form + " standardized"
                               : gate == Gate::homogeneous ? "QS " + form + ", V < c"
                                                           : "QS " + form + ", 1 < V < c";
      labels.emplace_back(reading.id(dimension, gate), name);
    }
  }
  return labels;
}

std::pair<std::string, std::string> ours(const study::Reading& reading) {
  return {reading.id(Dimension::points, reading.dissimilarity.gate),
          reading.dissimilarity.gate == Gate::homogeneous ? "QS-2DDTW, V < c" : "QS-2DDTW"};
}

Labels of_weights(const study::Reading& reading, std::initializer_list<Relocalization> hows) {
  Labels labels{ours(reading)};
  const std::string me = reading.me_polarity == core::Polarity::lptf ? "ME (LPTF)" : "ME (HPTF)";
  for (const auto how : hows) {
    const std::string name = how == Relocalization::none     ? ", lost"
                             : how == Relocalization::global ? ", global reloc."
                                                             : ", perfect reloc.";
    labels.emplace_back(study::mcw_id(how), "MCW" + name);
    labels.emplace_back(study::me_id(reading.me_polarity, how), me + name);
  }
  return labels;
}

Labels of_metrics(const study::Reading& reading) {
  return {ours(reading),
          {"ndt_qe", "NDT Qe"},
          {"ndt_qs", "NDT Qs"},
          {"ndt_qh", "NDT Qh"},
          {"ndt_qo", "NDT Qo"}};
}

const std::string kStripNote =
    "Each strip is a detector, each cell a t_k; black where the mean of η is 0 or less. Right of "
    "it: the mean over all trials and t_k, the share of them with η ≤ 0, and the area under the "
    "ROC curve of the scores at t_k against those of undisturbed runs.";

void add_strips(int number, const std::string& what, const PaperResults& results,
                const PaperOptions& options, Evaluator evaluator, const Labels& labels,
                std::vector<Figure>& figures) {
  if (!options.wants({number})) return;
  const std::string title = "Figure " + std::to_string(number) + ". " + what;
  const auto figure = strips(title, results, evaluator, labels);
  if (figure.groups.empty() || figure.groups.front().strips.empty()) return;
  figures.push_back(
      {number, report::drawn(figure), "η " + evaluator_words(evaluator) + ". " + kStripNote});
}

report::Line curve(const NamedRoc& one) {
  report::Line line{one.id + "  " + report::fixed(one.roc.auc, 3), {}};
  for (const auto& point : one.roc.points) {
    if (!line.points.empty() && &point != &one.roc.points.back() &&
        point.fpr - line.points.back().x < 2e-4 && point.tpr - line.points.back().y < 2e-3) {
      continue;  // closer than a pixel
    }
    line.points.push_back({point.fpr, point.tpr});
  }
  return line;
}

void add_curves(int number, const std::string& what, const std::vector<const NamedRoc*>& curves,
                const std::string& caption, const PaperOptions& options,
                std::vector<Figure>& figures) {
  if (!options.wants({number}) || curves.empty()) return;
  report::LineFigure figure{"Figure " + std::to_string(number) + ". " + what,
                            {"false alarms: share of natural pairs", 1e-3},
                            {"kidnappings found", 0.0},
                            {}};
  for (const NamedRoc* one : curves) figure.lines.push_back(curve(*one));
  figures.push_back({number, report::drawn(figure), caption});
}

void add_roc_figures(const RocStudy& roc, const PaperOptions& options,
                     std::vector<Figure>& figures) {
  const std::string of = roc.of + " (" + std::to_string(roc.runs) + ")";
  std::vector<const NamedRoc*> single;
  for (const auto& one : roc.single) single.push_back(&one);
  add_curves(13, "ROC of the single detectors", single,
             "Scores of " + of +
                 ", pooled: one threshold for all of them. Behind each name the "
                 "area under its curve.",
             options, figures);
  if (!roc.regression) return;
  std::vector<const NamedRoc*> both{&*roc.regression};
  for (const auto& one : roc.single) {
    if (one.id == options.reading.id(Dimension::points, options.reading.dissimilarity.gate) ||
        one.id.starts_with("ndt_q") || one.id == "mcw" || one.id == "me") {
      both.push_back(&one);
    }
  }
  add_curves(15, "ROC of their logistic regression", both,
             "Scores of " + of +
                 ". Each run is judged by a model that was selected stepwise and "
                 "fitted on the other runs.",
             options, figures);
}

}  // namespace

std::vector<Figure> paper_figures(const PaperResults& results, const PaperOptions& options) {
  const auto& reading = options.reading;
  std::vector<Figure> figures;
  const auto add = [&](int number, const std::string& what, Evaluator evaluator,
                       const Labels& labels) {
    add_strips(number, what, results, options, evaluator, labels, figures);
  };
  add(2, "Standardizing, in one dimension and in two", reading.evaluator,
      of_dtw(reading, {Gate::never, Gate::always}));
  add(3, "Quasi-standardizing, by either reading of the gate", reading.evaluator,
      of_dtw(reading, {Gate::never, Gate::paper, Gate::homogeneous}));
  add(6, "Beside the particles' weights, without relocalization", Evaluator::all,
      of_weights(reading, {Relocalization::none}));
  add(7, "Beside the particles' weights, with relocalization", Evaluator::all,
      of_weights(reading, {Relocalization::perfect, Relocalization::global}));
  add(8, "Beside the metric-based detectors", reading.evaluator, of_metrics(reading));
  add(9, "Beside the metric-based detectors, in the relocalization test", Evaluator::all,
      of_metrics(reading));
  if (results.roc) add_roc_figures(*results.roc, options, figures);
  return figures;
}

}  // namespace kidnapwatch::service
