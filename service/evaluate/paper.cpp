// SPDX-License-Identifier: Apache-2.0
// `evaluate paper`: its command line, and what it prints.
#include "service/evaluate/paper.hpp"

#include <array>
#include <chrono>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "adapters/codecs/rfc3339.hpp"
#include "core/names.hpp"
#include "core/study/claims.hpp"
#include "service/evaluate/paper_report.hpp"
#include "service/evaluate/paper_study.hpp"

namespace kidnapwatch::service {
namespace {

using core::named;

/// The switches as they are given.
struct PaperFlags {
  PaperOptions options;
  std::string gate = "paper";
  std::string variance_test = "bartlett";
  std::string invalid = "drop";
  std::string me_polarity = "lptf";
  std::string evaluator = "prior";
};

core::study::Reading reading_of(const PaperFlags& flags) {
  using Names2 = std::array<std::string_view, 2>;
  using Names3 = std::array<std::string_view, 3>;
  core::study::Reading reading;
  reading.dissimilarity.gate =
      named<core::Gate>(Names2{"paper", "homogeneous"}, flags.gate, "--gate");
  reading.dissimilarity.variance_test = named<core::VarianceTest>(
      Names3{"bartlett", "levene", "brown_forsythe"}, flags.variance_test, "--variance-test");
  reading.dissimilarity.invalid =
      named<core::InvalidPolicy>(Names2{"drop", "clamp"}, flags.invalid, "--invalid");
  reading.me_polarity =
      named<core::Polarity>(Names2{"hptf", "lptf"}, flags.me_polarity, "--me-polarity");
  reading.evaluator =
      named<core::evaluation::Evaluator>(Names2{"prior", "all"}, flags.evaluator, "--evaluator");
  return reading;
}

std::string command_line(const PaperFlags& flags) {
  const PaperOptions& options = flags.options;
  std::string line = "kidnapwatch evaluate paper --trials " + std::to_string(options.trials) +
                     " --steps " + std::to_string(options.steps) + " --particles " +
                     std::to_string(options.particles) + " --seed " + std::to_string(options.seed) +
                     " --gate " + flags.gate + " --variance-test " + flags.variance_test +
                     " --invalid " + flags.invalid + " --me-polarity " + flags.me_polarity +
                     " --evaluator " + flags.evaluator;
  for (const int figure : options.figures) line += " --figure " + std::to_string(figure);
  return line;
}

int evaluate_paper(PaperFlags flags) {
  flags.options.reading = reading_of(flags);
  const PaperOptions& options = flags.options;
  const auto now =
      std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  const PaperResults results = run_paper(options);
  write_report(results, options, command_line(flags), adapters::codecs::rfc3339(now));
  if (options.json) {
    std::cout << claims_json(results, options) << '\n';
    return kOk;
  }
  for (const auto& claim : core::study::claims(results.conditions, options.reading)) {
    std::cout << "figure " << claim.figure << ": " << claim.text << "\n  "
              << core::study::name(claim.verdict) << ": " << claim.measured << '\n';
  }
  std::cout << "report: " << (options.out / "report.html").string() << '\n';
  return kOk;
}

void add_switches(CLI::App& command, PaperFlags& flags) {
  command.add_option("--gate", flags.gate, "Algorithm 3, line 4: paper (1 < V < c), homogeneous");
  command.add_option("--variance-test", flags.variance_test, "bartlett, levene, brown_forsythe");
  command.add_option("--invalid", flags.invalid, "Beams without an echo: drop, clamp");
  command.add_option("--me-polarity", flags.me_polarity, "Measurement entropy: lptf, hptf");
  command.add_option("--evaluator", flags.evaluator,
                     "Compare t_k with the steps before it (prior) or with all");
}

void add_options(CLI::App& command, PaperFlags& flags) {
  PaperOptions& options = flags.options;
  command.add_option("--out", options.out, "Folder for the report")->required();
  command.add_option("--trials", options.trials, "Per t_k, map, reach and noise")
      ->check(CLI::Range(1, 10'000));
  command.add_option("--steps", options.steps, "T")->check(CLI::Range(3, 1000));
  command.add_option("--particles", options.particles, "Of Monte Carlo localization")
      ->check(CLI::Range(1, 1'000'000));
  command.add_option("--kidnappings", options.kidnappings, "Cut into each recorded run")
      ->check(CLI::Range(2, 10'000));
  command.add_option("--figure", options.figures, "Only this one; may be given again")
      ->check(CLI::IsMember({2, 3, 6, 7, 8, 9, 13, 15}));
  command.add_option("--data", options.data, "Folder of recorded runs, .scan.gz");
  command.add_option("--seed", options.seed, "The same seed gives the same numbers");
  command.add_option("--threads", options.threads, "0: one per core");
  command.add_flag("--json", options.json, "Print the claims as JSON");
}

}  // namespace

void add_evaluate_paper(CLI::App& evaluate, Command& chosen) {
  auto* paper = evaluate.add_subcommand("paper", "Run the paper's experiments anew");
  paper->footer("Example: kidnapwatch evaluate paper --out paper-out --trials 20");
  const auto flags = std::make_shared<PaperFlags>();
  add_options(*paper, *flags);
  add_switches(*paper, *flags);
  paper->callback([=, &chosen] { chosen = [=] { return evaluate_paper(*flags); }; });
}

}  // namespace kidnapwatch::service
