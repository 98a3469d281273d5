// SPDX-License-Identifier: Apache-2.0
// `replay`: a recorded log published as a robot, with kidnappings cut into it on request.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "adapters/logs/log.hpp"
#include "core/evaluation/splice.hpp"
#include "core/robot.hpp"
#include "service/commands/commands.hpp"
#include "service/commands/play.hpp"

namespace kidnapwatch::service {
namespace {

namespace evaluation = core::evaluation;

struct ReplayOptions {
  PlayOptions play;
  std::string log;
  std::string robot;
  std::vector<std::string> kidnaps;
  bool loop = false;
};

/// To a place 3 m away or more; in a log of a smaller room, to the farthest that is 1 m away.
evaluation::Cut far_cut(const core::Recording& recording) {
  if (const auto cut = evaluation::far_jump(recording)) {
    return *cut;
  }
  const auto nearer = evaluation::far_jump(recording, {.min_distance_m = 1.0});
  if (!nearer) {
    throw core::BadInput("--kidnap", "the log has no place 1 m away from its middle");
  }
  std::cerr << "no place in this log is 3 m away; the cut goes to the farthest there is\n";
  return *nearer;
}

evaluation::Cut cut_of(const std::string& text, const core::Recording& recording) {
  if (text == "far") {
    return far_cut(recording);
  }
  evaluation::Cut cut;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf:%lf%c", &cut.at_s, &cut.to_s, &rest) != 2) {
    throw core::BadInput("--kidnap", "must be AT_S:TO_S or far, not '" + text + "'");
  }
  return cut;
}

std::vector<evaluation::Cut> cuts_of(const ReplayOptions& options,
                                     const core::Recording& recording) {
  std::vector<evaluation::Cut> cuts;
  for (const auto& text : options.kidnaps) {
    cuts.push_back(cut_of(text, recording));
  }
  std::ranges::sort(cuts, {}, &evaluation::Cut::at_s);
  return cuts;
}

/// A spliced run, played once, or again and again with its stamps going on.
class Tape {
 public:
  Tape(evaluation::Spliced run, bool loop) : run_(std::move(run)), loop_(loop) {}

  std::optional<Outgoing> next() {
    const auto& scans = run_.recording.scans;
    if (at_ == scans.size()) {
      if (!loop_) {
        return std::nullopt;
      }
      start_ += scans.back().scan.stamp - scans.front().scan.stamp + std::chrono::milliseconds(200);
      at_ = 0;
    }
    Outgoing out{scans[at_].scan, std::ranges::count(run_.first_after, at_) > 0};
    out.scan.stamp = start_ + (out.scan.stamp - scans.front().scan.stamp);
    ++at_;
    return out;
  }

 private:
  evaluation::Spliced run_;
  bool loop_;
  core::Stamp start_{};
  std::size_t at_ = 0;
};

int replay(const ReplayOptions& options) {
  if (!core::is_robot_id(options.robot)) {
    throw core::BadInput("--robot", "must be 1 to 64 of A-Z a-z 0-9 _ . : -");
  }
  const auto log = adapters::logs::read_log(options.log);
  if (log.skipped_lines > 0) {
    std::cerr << "skipped " << log.skipped_lines << " broken lines\n";
  }
  const auto cuts = cuts_of(options, log.recording);
  for (const auto& cut : cuts) {
    std::fprintf(stderr, "cut: at %.1f s to where the log is at %.1f s\n", cut.at_s, cut.to_s);
  }
  auto run = evaluation::splice(log.recording, cuts);
  const auto& scans = run.recording.scans;
  const double span_s = core::elapsed_s(scans.front().scan.stamp, scans.back().scan.stamp);
  const auto tape = std::make_shared<Tape>(std::move(run), options.loop);
  const auto on_kidnap = [](const std::string& robot, core::Stamp stamp) {
    std::cerr << "kidnapped " << robot << " stamp_ns " << core::ns_since_epoch(stamp) << '\n';
  };
  const Played played =
      play({{options.robot, [tape] { return tape->next(); }}}, options.play, span_s, on_kidnap);
  std::cout << to_json(played) << '\n';
  return played.unsent == 0 ? kOk : kFailed;
}

}  // namespace

void add_replay(CLI::App& app, Command& chosen) {
  auto* command = app.add_subcommand("replay", "Publish a recorded log as a robot");
  command->footer(
      "Example: kidnapwatch replay corridor.log.gz --robot r1 --speed 10 --kidnap 60:240");
  const auto options = std::make_shared<ReplayOptions>();
  options->play.add_to(*command);
  command->add_option("LOG", options->log, "A .scan or CARMEN log, gzipped or not")->required();
  command->add_option("--robot", options->robot, "The robot's id")->required();
  command->add_option(
      "--kidnap", options->kidnaps,
      "AT_S:TO_S: at AT_S go on where the log is at TO_S; or far: in the middle, to "
      "the farthest place");
  command->add_flag("--loop", options->loop, "Begin again at the end");
  command->callback([=, &chosen] { chosen = [=] { return replay(*options); }; });
}

}  // namespace kidnapwatch::service
