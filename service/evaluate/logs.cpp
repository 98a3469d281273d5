// SPDX-License-Identifier: Apache-2.0
// `evaluate logs`: would the detectors fit these robots? Kidnappings and confounders cut from
// recorded runs, each judged after a first half of the run that it learned from.
#include "service/evaluate/logs.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "adapters/logs/log.hpp"
#include "core/evaluation/tunings.hpp"
#include "service/evaluate/logs_report.hpp"
#include "service/evaluate/parallel.hpp"

namespace kidnapwatch::service {
namespace {

namespace evaluation = core::evaluation;
namespace fs = std::filesystem;
using evaluation::DetectorKind;

struct EvaluateLogsOptions {
  std::vector<std::string> paths;
  std::string out;
  bool json = false;
  bool leave_one_out = false;
  double target_rate = 1e-3;
  evaluation::TrialConfig trial;
  std::size_t rehearsal_episodes = 2;
  std::vector<std::string> detectors;
  std::size_t jobs = 0;  ///< 0: one per core
};

/// The files themselves; of a folder the logs below it that are told by their name.
std::vector<fs::path> files_of(const std::vector<std::string>& paths) {
  std::vector<fs::path> files;
  for (const fs::path path : paths) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      const std::string file = entry.path().filename();
      if (entry.is_regular_file() && (file.ends_with(".scan.gz") || file.ends_with(".scan")))
        files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);
  return files;
}

bool has_odometry(const core::Recording& recording) {
  return std::ranges::any_of(
      recording.scans, [](const auto& recorded) { return recorded.scan.odometry.has_value(); });
}

bool is_wanted(const EvaluateLogsOptions& options, DetectorKind kind) {
  return options.detectors.empty() ||
         std::ranges::count(options.detectors, evaluation::name(kind)) > 0;
}

/// What is fixed before a log is looked at.
struct Given {
  core::MotionTuning tuning;
  std::string tuning_name = "as shipped";
  double floor = core::MotionConfig{}.threshold_min;
};

evaluation::SubjectConfig config_of(const EvaluateLogsOptions& options, const Given& given) {
  evaluation::SubjectConfig config;
  config.calibration.false_alarm_rate = options.target_rate;
  config.motion.false_alarm_rate = options.target_rate;
  config.motion.threshold_min = given.floor;
  config.motion.tuning = given.tuning;
  return config;
}

/// Drives every detector that is wanted through the log.
evaluation::LogTrial tried(const core::Recording& recording, const EvaluateLogsOptions& options,
                           const Given& given) {
  evaluation::LogTrial result{recording.name, {}};
  const auto plan = evaluation::plan(recording, options.trial);
  for (const DetectorKind kind : evaluation::kDetectors) {
    if (!is_wanted(options, kind)) continue;
    result.results[kind] =
        evaluation::trial(recording, plan, options.trial, subject(kind, config_of(options, given)));
  }
  return result;
}

std::string folder_of(const fs::path& file) { return file.parent_path().filename().string(); }

/// Reads a log and judges it.
void judge(const fs::path& file, const EvaluateLogsOptions& options, const Given& given,
           JudgedLog& log) {
  log.file = file.string();
  log.folder = folder_of(file);
  log.fleet_threshold = given.floor;
  log.tuning = given.tuning_name;
  try {
    const auto read = adapters::logs::read_log(file);
    log.scans = read.recording.scans.size();
    log.skipped_lines = read.skipped_lines;
    log.has_odometry = has_odometry(read.recording);
    log.trial = tried(read.recording, options, given);
  } catch (const core::BadInput& e) {
    log.error = e.what();
  }
}

/// Tries every candidate on the log, on few episodes, and others than it will be judged on.
evaluation::Rehearsal rehearsed(const fs::path& file, const EvaluateLogsOptions& options) {
  evaluation::Rehearsal rehearsal{folder_of(file), {}};
  evaluation::TrialConfig few = options.trial;
  few.episodes = options.rehearsal_episodes;
  few.seed = ~options.trial.seed;
  try {
    const auto recording = adapters::logs::read_log(file).recording;
    const auto plan = evaluation::plan(recording, few);
    for (const auto& candidate : evaluation::candidates()) {
      const auto config = config_of(options, {.tuning = candidate.tuning});
      rehearsal.results.push_back(evaluation::trial(
          recording, plan, few, subject(DetectorKind::motion_consistency, config)));
    }
  } catch (const core::BadInput&) {
    rehearsal.results.clear();  // judge() tells why
  }
  return rehearsal;
}

/// For each log the tuning and the fleet's threshold, by the logs of all other folders.
std::vector<Given> given(const std::vector<fs::path>& files, const EvaluateLogsOptions& options) {
  std::vector<Given> all(files.size());
  if (!options.leave_one_out) return all;
  std::vector<evaluation::Rehearsal> rehearsals(files.size());
  in_parallel(files.size(), options.jobs, "rehearsals",
              [&](std::size_t i) { rehearsals[i] = rehearsed(files[i], options); });
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto choice = evaluation::chosen(rehearsals, folder_of(files[i]), options.target_rate);
    const auto& candidate = evaluation::candidates()[choice.candidate];
    all[i] = {candidate.tuning, std::string(candidate.name), choice.floor};
  }
  return all;
}

std::vector<JudgedLog> judged(const std::vector<fs::path>& files,
                              const EvaluateLogsOptions& options) {
  const auto fixed = given(files, options);
  std::vector<JudgedLog> logs(files.size());
  in_parallel(files.size(), options.jobs, "logs",
              [&](std::size_t i) { judge(files[i], options, fixed[i], logs[i]); });
  return logs;
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

int evaluate(const EvaluateLogsOptions& options) {
  const auto files = files_of(options.paths);
  if (files.empty()) throw core::BadInput("PATH", "no .scan or .scan.gz file there");
  LogsReport report{options.target_rate, options.leave_one_out, judged(files, options), {}};
  std::vector<evaluation::LogTrial> trials;
  for (const JudgedLog& log : report.logs) {
    if (!log.error.empty()) std::cerr << log.error << '\n';
    trials.push_back(log.trial);
  }
  report.rows = evaluation::rows(trials);
  fs::create_directories(options.out);
  write(fs::path(options.out) / "results.json", to_json(report));
  write(fs::path(options.out) / "report.html", to_html(report));
  std::cout << (options.json ? to_json(report) : to_text(report));
  return report.rows.empty() ? kFailed : kOk;
}

}  // namespace

void add_evaluate_logs(CLI::App& app, Command& chosen) {
  auto* command = app.add_subcommand("logs", "On recorded logs: do the detectors fit my robots?");
  command->footer("Example: kidnapwatch evaluate logs recordings/ --out report");
  const auto options = std::make_shared<EvaluateLogsOptions>();
  command->add_option("PATH", options->paths, "Logs, or folders with .scan and .scan.gz files")
      ->required()
      ->check(CLI::ExistingPath);
  command->add_option("--out", options->out, "Folder for results.json and report.html")->required();
  command->add_flag("--json", options->json, "Print results.json instead of a table");
  command->add_flag("--leave-one-out", options->leave_one_out,
                    "Tuning and fleet's threshold for each folder (sensor) are those that are best "
                    "on all other folders: most kidnappings found, less 5 times the share of "
                    "confounders that alarm, at the targeted rate of natural false alarms");
  command->add_option("--rehearsal-episodes", options->rehearsal_episodes,
                      "Of each kind and log, to choose by; others than those that are judged");
  command->add_option("--target", options->target_rate, "False alarms per pair of scans")
      ->check(CLI::Range(1e-6, 0.04));
  command->add_option("--episodes", options->trial.episodes, "Of each kind and log, at most");
  command->add_option("--seed", options->trial.seed, "Other episodes");
  command->add_option("--detector", options->detectors, "Only these; all of them otherwise");
  command->add_option("--jobs", options->jobs, "Threads; 0 for one per core");
  command->callback([=, &chosen] { chosen = [=] { return evaluate(*options); }; });
}

}  // namespace kidnapwatch::service
