// SPDX-License-Identifier: Apache-2.0
// `simulate`: robots that tour simulated worlds, and are kidnapped now and then.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>

#include "core/sim/drive.hpp"
#include "service/commands/commands.hpp"
#include "service/commands/play.hpp"

namespace kidnapwatch::service {
namespace {

namespace sim = core::sim;

struct SimulateOptions {
  PlayOptions play;
  std::size_t robots = 1;
  double rate_hz = 5.0;
  std::size_t beams = 360;
  double range_noise_sd_m = 0.01;
  double duration_s = 0.0;
  double kidnap_every_s = 0.0;
  std::uint64_t seed = 1;
  std::string name = "sim";
  std::string truth_file;
};

/// One simulated robot: its drive, and when it is carried off next.
class Robot {
 public:
  Robot(const sim::World& world, const SimulateOptions& options, std::size_t number,
        core::Stamp start)
      : drive_(world, model(options), options.seed * 1'000'003 + number, start),
        step_s_(1.0 / options.rate_hz),
        steps_left_(options.duration_s > 0.0
                        ? static_cast<std::int64_t>(std::floor(options.duration_s / step_s_ + 0.5))
                        : -1),
        kidnap_steps_(static_cast<std::int64_t>(std::llround(options.kidnap_every_s / step_s_))),
        until_kidnap_(first_kidnap(options, number)) {}

  std::optional<Outgoing> next() {
    if (steps_left_ == 0) {
      return std::nullopt;
    }
    --steps_left_;
    const bool kidnapped = kidnap_steps_ > 0 && until_kidnap_-- == 0;
    if (kidnapped) {
      drive_.kidnap_far();
      until_kidnap_ = kidnap_steps_ - 1;
    }
    return Outgoing{drive_.next(step_s_).scan, kidnapped};
  }

 private:
  static sim::RobotModel model(const SimulateOptions& options) {
    sim::RobotModel robot;
    robot.beams = options.beams;
    robot.range_noise_sd_m = options.range_noise_sd_m;
    return robot;
  }

  /// Spread over half a period, so that a fleet is not kidnapped all at once.
  [[nodiscard]] std::int64_t first_kidnap(const SimulateOptions& options,
                                          std::size_t number) const {
    const double share = static_cast<double>(number) / static_cast<double>(options.robots);
    return std::llround((1.0 - 0.5 * share) * static_cast<double>(kidnap_steps_));
  }

  sim::Drive drive_;
  double step_s_;
  std::int64_t steps_left_;
  std::int64_t kidnap_steps_;
  std::int64_t until_kidnap_;
};

std::string robot_name(const std::string& name, std::size_t number) {
  char text[32];
  std::snprintf(text, sizeof text, "-%04zu", number);
  return name + text;
}

std::vector<Player> fleet(const SimulateOptions& options) {
  static const std::array<sim::World, 2> kWorlds{sim::corridor_world(), sim::room_world()};
  const double step_s = 1.0 / options.rate_hz;
  std::vector<Player> players;
  for (std::size_t i = 0; i < options.robots; ++i) {
    const double phase = static_cast<double>(i) / static_cast<double>(options.robots);
    const auto start = core::later_by_s(core::Stamp{}, (phase - 1.0) * step_s);
    const auto robot = std::make_shared<Robot>(kWorlds.at(i % kWorlds.size()), options, i, start);
    players.push_back({robot_name(options.name, i + 1), [robot] { return robot->next(); }});
  }
  return players;
}

int simulate(const SimulateOptions& options) {
  std::ofstream truth;
  if (!options.truth_file.empty()) {
    truth.open(options.truth_file);
    if (!truth) {
      throw core::BadInput("--truth", "cannot write " + options.truth_file);
    }
  }
  const auto on_kidnap = [&](const std::string& robot, core::Stamp stamp) {
    std::cerr << "kidnapped " << robot << '\n';
    truth << R"({"robotId":")" << robot << R"(","stamp_ns":)" << core::ns_since_epoch(stamp)
          << "}\n"
          << std::flush;
  };
  const Played played = play(fleet(options), options.play, options.duration_s, on_kidnap);
  std::cout << to_json(played) << '\n';
  return played.unsent == 0 ? kOk : kFailed;
}

void add_options(CLI::App& command, SimulateOptions& options) {
  options.play.add_to(command);
  command.add_option("--robots", options.robots, "How many")->check(CLI::Range(1, 100'000));
  command.add_option("--rate", options.rate_hz, "Scans per second and robot")
      ->check(CLI::Range(0.01, 1000.0));
  command.add_option("--beams", options.beams, "Beams per scan")->check(CLI::Range(20, 65'536));
  command.add_option("--range-noise", options.range_noise_sd_m, "Standard deviation in metres")
      ->check(CLI::Range(0.0, 10.0));
  command
      .add_option("--duration", options.duration_s, "Simulated seconds; 0 goes on until stopped")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--kidnap-every", options.kidnap_every_s,
                  "Carry each robot off every so many simulated seconds; 0 never does")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--seed", options.seed, "The same seed drives the same tours");
  command.add_option("--name", options.name, "Robots are called NAME-0001, NAME-0002, ...");
  command.add_option("--truth", options.truth_file,
                     "Write each kidnapping there, a JSON line each");
}

}  // namespace

void add_simulate(CLI::App& app, Command& chosen) {
  auto* command = app.add_subcommand("simulate", "Publish the scans of simulated robots");
  command->footer("Example: kidnapwatch simulate --robots 50 --rate 5 --kidnap-every 40");
  const auto options = std::make_shared<SimulateOptions>();
  add_options(*command, *options);
  command->callback([=, &chosen] { chosen = [=] { return simulate(*options); }; });
}

}  // namespace kidnapwatch::service
