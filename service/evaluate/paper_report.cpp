// SPDX-License-Identifier: Apache-2.0
// The report and its tables.
#include "service/evaluate/paper_report.hpp"

#include <fstream>

#include "adapters/codecs/json.hpp"
#include "adapters/report/html.hpp"
#include "adapters/report/svg.hpp"
#include "core/bad_input.hpp"
#include "core/study/claims.hpp"
#include "core/study/systems.hpp"
#include "service/evaluate/paper_figures.hpp"

namespace kidnapwatch::service {
namespace {

namespace report = adapters::report;
namespace study = core::study;
namespace evaluation = core::evaluation;
using adapters::codecs::Json;
using report::fixed;
using report::number;

std::string three(double value) { return fixed(value, 3); }

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw core::BadInput("--out", "cannot write " + file.string());
}

std::string setting(const study::Condition& condition) {
  return condition.map + "," + number(condition.range_max_m, 1) + "," +
         number(condition.noise_variance_m2, 4);
}

/// Calls visit(condition, evaluator name, summary) for all of them.
template <typename Visit>
void for_each_summary(const PaperResults& results, Visit visit) {
  for (const auto& condition : results.conditions) {
    for (const auto& [id, summary] : condition.prior) visit(condition, "prior", summary);
    for (const auto& [id, summary] : condition.all) visit(condition, "all", summary);
  }
}

std::string summary_csv(const PaperResults& results) {
  std::string csv =
      "map,range_max_m,noise_variance_m2,evaluator,detector,mean_eta,undetected,black_steps,"
      "auc,auc_low,auc_high,tpr_at_fpr_0.01\n";
  for_each_summary(results, [&](const auto& condition, const char* evaluator, const auto& s) {
    csv += setting(condition) + "," + evaluator + "," + s.id;
    for (const double value : {s.performance.mean, s.performance.undetected, s.dips, s.roc.auc,
                               s.roc.auc_low, s.roc.auc_high, evaluation::tpr_at(s.roc, 0.01)}) {
      csv += "," + number(value, 6);
    }
    csv += "\n";
  });
  return csv;
}

std::string eta_csv(const PaperResults& results) {
  std::string csv =
      "map,range_max_m,noise_variance_m2,evaluator,detector,t_k,mean_eta,undetected\n";
  for_each_summary(results, [&](const auto& condition, const char* evaluator, const auto& s) {
    for (std::size_t k = 0; k < s.eta.size(); ++k) {
      csv += setting(condition) + "," + evaluator + "," + s.id + "," +
             std::to_string(k + study::kFirstTk) + "," + number(s.eta[k], 6) + "," +
             number(s.undetected[k], 6) + "\n";
    }
  });
  return csv;
}

std::vector<const NamedRoc*> curves(const RocStudy& roc) {
  std::vector<const NamedRoc*> all;
  if (roc.regression) all.push_back(&*roc.regression);
  for (const auto& one : roc.single) all.push_back(&one);
  return all;
}

std::string roc_csv(const PaperResults& results) {
  std::string csv = "study,detector,threshold,fpr,tpr\n";
  const auto add = [&](const char* name, const std::optional<RocStudy>& roc) {
    if (!roc) return;
    for (const NamedRoc* one : curves(*roc)) {
      for (const auto& point : one->roc.points) {
        csv += std::string(name) + "," + one->id + "," + number(point.threshold, 6) + "," +
               number(point.fpr, 6) + "," + number(point.tpr, 6) + "\n";
      }
    }
  };
  add("figures_13_15", results.roc);
  add("milvus", results.milvus);
  return csv;
}

Json json_of(const RocStudy& roc) {
  Json object{{"of", roc.of}, {"runs", roc.runs}, {"curves", Json::array()}};
  for (const NamedRoc* one : curves(roc)) {
    object["curves"].push_back({{"detector", one->id},
                                {"auc", one->roc.auc},
                                {"aucLow", one->roc.auc_low},
                                {"aucHigh", one->roc.auc_high},
                                {"medianAucOfRuns", one->median_auc},
                                {"tprAtFpr0.01", evaluation::tpr_at(one->roc, 0.01)},
                                {"natural", one->roc.natural},
                                {"kidnapped", one->roc.kidnapped}});
  }
  for (const auto& [id, models] : roc.selected) object["selected"][id] = models;
  return object;
}

Json claims_of(const PaperResults& results, const PaperOptions& options) {
  Json list = Json::array();
  for (const auto& claim : study::claims(results.conditions, options.reading)) {
    list.push_back({{"figure", claim.figure},
                    {"claim", claim.text},
                    {"measured", claim.measured},
                    {"verdict", study::name(claim.verdict)},
                    {"why", claim.why}});
  }
  return list;
}

Json json_of(const PaperResults& results, const PaperOptions& options, const std::string& command,
             const std::string& date) {
  Json object{{"schema", "kidnapwatch/paper/1"},
              {"command", command},
              {"date", date},
              {"trials", options.trials},
              {"steps", options.steps},
              {"particles", options.particles},
              {"seed", options.seed},
              {"seconds", results.seconds},
              {"claims", claims_of(results, options)},
              {"summaries", Json::array()}};
  for_each_summary(results, [&](const auto& condition, const char* evaluator, const auto& s) {
    object["summaries"].push_back({{"map", condition.map},
                                   {"rangeMaxM", condition.range_max_m},
                                   {"noiseVarianceM2", condition.noise_variance_m2},
                                   {"evaluator", evaluator},
                                   {"detector", s.id},
                                   {"meanEta", s.performance.mean},
                                   {"undetected", s.performance.undetected},
                                   {"blackSteps", s.dips},
                                   {"auc", s.roc.auc}});
  });
  if (results.roc) object["roc"] = json_of(*results.roc);
  if (results.milvus) object["milvus"] = json_of(*results.milvus);
  return object;
}

void add_claims(const PaperResults& results, const PaperOptions& options, report::Html& page) {
  report::Table table{{"Figure", "The paper's claim", "Measured", "", "Why"}, {}};
  for (const auto& claim : study::claims(results.conditions, options.reading)) {
    table.rows.push_back({claim.figure, claim.text, claim.measured,
                          std::string(study::name(claim.verdict)), claim.why});
  }
  if (table.rows.empty()) return;
  page.heading("What holds");
  page.table(table);
}

/// Mean of a figure over the maps at the paper's reach and noise.
template <typename Value>
std::string over_maps(const PaperResults& results, evaluation::Evaluator evaluator,
                      const std::string& id, Value value) {
  std::string text;
  for (const auto& condition : results.conditions) {
    const auto& found = study::summaries(condition, evaluator);
    if (!study::is_main(condition) || !found.contains(id)) continue;
    text += (text.empty() ? "" : " / ") + fixed(value(found.at(id)), 2);
  }
  return text;
}

void add_readings(const PaperResults& results, const PaperOptions& options, report::Html& page) {
  report::Table table{{"Reading", "mean η", "share with η ≤ 0", "black steps", "AUC"}, {}};
  for (const auto& config : study::readings()) {
    const std::string id = study::id_of(config);
    const auto row = [&](auto value) {
      return over_maps(results, options.reading.evaluator, id, value);
    };
    if (row([](const auto& s) { return s.dips; }).empty()) return;
    table.rows.push_back({id, row([](const auto& s) { return s.performance.mean; }),
                          row([](const auto& s) { return s.performance.undetected; }),
                          row([](const auto& s) { return s.dips; }),
                          row([](const auto& s) { return s.roc.auc; })});
  }
  page.heading("Which reading gives what");
  page.paragraph(
      "The paper can be read in several ways: the gate of Algorithm 3 (1 < V < c as printed, or "
      "V < c), the test of equal variances, and what a beam without an echo is (dropped, or put "
      "at the lidar's reach). Values are for the maps turns / tee / ring, reach 3.5 m, noise "
      "variance 0.1.");
  page.table(table);
}

void add_conditions(const PaperResults& results, const PaperOptions& options, report::Html& page) {
  using core::Dimension;
  using core::Gate;
  const std::vector<std::string> ids{options.reading.id(Dimension::points, Gate::never),
                                     options.reading.id(Dimension::points, Gate::paper),
                                     options.reading.id(Dimension::points, Gate::homogeneous),
                                     "ndt_qe",
                                     "ndt_qs",
                                     "ndt_qh",
                                     "ndt_qo"};
  report::Table table{{"Map", "Reach m", "Noise variance"}, {}};
  table.head.insert(table.head.end(), ids.begin(), ids.end());
  for (const auto& condition : results.conditions) {
    std::vector<std::string> row{condition.map, number(condition.range_max_m, 1),
                                 number(condition.noise_variance_m2, 4)};
    const auto& found = study::summaries(condition, options.reading.evaluator);
    for (const auto& id : ids) {
      row.push_back(found.contains(id) ? fixed(found.at(id).performance.mean, 2) + ", " +
                                             fixed(found.at(id).performance.undetected, 2)
                                       : "–");
    }
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) return;
  page.heading("Reach and noise");
  page.paragraph("Mean η, and the share of kidnappings with η ≤ 0.");
  page.table(table);
}

void add_roc(const std::string& title, const std::optional<RocStudy>& roc, report::Html& page) {
  if (!roc) return;
  report::Table table{
      {"Score", "AUC", "95 % (DeLong)", "median AUC of the runs", "TPR at FPR 0.01"}, {}};
  for (const NamedRoc* one : curves(*roc)) {
    table.rows.push_back({one->id, three(one->roc.auc),
                          three(one->roc.auc_low) + " to " + three(one->roc.auc_high),
                          three(one->median_auc), three(evaluation::tpr_at(one->roc, 0.01))});
  }
  page.heading(title);
  const auto& any = curves(*roc).front()->roc;
  page.paragraph(std::to_string(roc->runs) + " runs: " + roc->of + "; " +
                 std::to_string(any.natural) + " natural scores and " +
                 std::to_string(any.kidnapped) +
                 " of kidnappings. The intervals take scores for independent; those of "
                 "one run are not, so that the truth is wider.");
  page.table(table);
  if (roc->selected.empty()) return;
  std::string selected;
  for (const auto& [id, models] : roc->selected) {
    selected += (selected.empty() ? "" : ", ") + id + " (" + std::to_string(models) + ")";
  }
  page.paragraph("Selected by stepwise regression, in so many of the models: " + selected + ".");
}

constexpr std::string_view kAbout =
    "Z. H. Ismail and I. Bukhori, Efficient Detection of Robot Kidnapping in Range Finder-Based "
    "Indoor Localization Using Quasi-Standardized 2D Dynamic Time Warping, Applied Sciences 11(4), "
    "1580, 2021, run anew. The maps, lidars and paths are this project's own: corridors of 2 m "
    "without features, in the paper's set-up of 360 beams, 3.5 m reach, range noise of variance "
    "0.1 and T = 100. Figures 6 to 9 are taken as: particle weights without and with "
    "relocalization, metric-based detectors against the steps before t_k and against all. "
    "Absolute values are not comparable with the paper's; signs and orders are.";

std::string page_of(const PaperResults& results, const PaperOptions& options,
                    const std::vector<Figure>& figures, const std::string& command,
                    const std::string& date) {
  report::Html page("Kidnapping detection by QS-2DDTW: the paper, run anew");
  page.paragraph(kAbout);
  page.paragraph(date + ", " + number(results.seconds, 0) + " s: " + command);
  add_claims(results, options, page);
  if (!figures.empty()) page.heading("Figures");
  for (const Figure& figure : figures) page.figure(figure.svg, figure.caption);
  add_readings(results, options, page);
  add_conditions(results, options, page);
  add_roc("Section 5: ROC and logistic regression", results.roc, page);
  add_roc("Labelled localization losses (Milvus Robotics)", results.milvus, page);
  return page.str();
}

}  // namespace

void write_report(const PaperResults& results, const PaperOptions& options,
                  const std::string& command, const std::string& date) {
  std::error_code failed;
  std::filesystem::create_directories(options.out, failed);
  if (failed) throw core::BadInput("--out", failed.message());
  const auto figures = paper_figures(results, options);
  for (const Figure& figure : figures) {
    write(options.out / ("figure-" + std::to_string(figure.number) + ".svg"), figure.svg);
  }
  write(options.out / "summary.csv", summary_csv(results));
  write(options.out / "eta.csv", eta_csv(results));
  write(options.out / "roc.csv", roc_csv(results));
  write(options.out / "paper.json",
        adapters::codecs::text(json_of(results, options, command, date)) + "\n");
  write(options.out / "report.html", page_of(results, options, figures, command, date));
}

std::string claims_json(const PaperResults& results, const PaperOptions& options) {
  return adapters::codecs::text(claims_of(results, options));
}

}  // namespace kidnapwatch::service
