// SPDX-License-Identifier: Apache-2.0
// `serve`: the service, from its start to SIGTERM or SIGINT.
#include <csignal>
#include <ctime>
#include <memory>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include "service/commands/commands.hpp"
#include "service/commands/settings_flags.hpp"
#include "service/service.hpp"

namespace kidnapwatch::service {
namespace {

void log_to_stderr(const std::string& level) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("kidnapwatch"));
  spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %^%l%$ %v", spdlog::pattern_time_type::utc);
  spdlog::set_level(spdlog::level::from_str(level));
  spdlog::flush_on(spdlog::level::info);
}

sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  return signals;
}

/// Waits for one of the signals; feeds systemd's watchdog, where there is one, meanwhile.
int wait_for(const sigset_t& signals) {
  const timespec second{1, 0};
  while (true) {
    const int signal = sigtimedwait(&signals, nullptr, &second);
    if (signal > 0) {
      return signal;
    }
    sd_notify(0, "WATCHDOG=1");
  }
}

int serve(const Settings& settings) {
  log_to_stderr(settings.service_log_level);
  (void)std::signal(SIGXFSZ, SIG_IGN);  // a file at its limit is an error to live with
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // in all threads, which are started after this
  Service service(settings);
  spdlog::info("kidnapwatch {} serves {}://{}:{}, robots on {} under {}", KW_VERSION,
               settings.http_cert_file.empty() ? "http" : "https", settings.http_host,
               service.http_port(), settings.mqtt_url, settings.mqtt_prefix);
  sd_notify(0, "READY=1");
  const int signal = wait_for(signals);
  sd_notify(0, "STOPPING=1");
  spdlog::info("stopping on signal {}", signal);
  service.stop();
  spdlog::info("stopped; nothing is queued");
  return kOk;
}

}  // namespace

void add_serve(CLI::App& app, Command& chosen) {
  auto* command = app.add_subcommand("serve", "Watch the robots of a broker, until stopped");
  command->footer("Example: kidnapwatch serve --mqtt-url mqtt://broker:1883 --store-file kw.db");
  const auto flags = std::make_shared<SettingsFlags>();
  flags->add_to(*command);
  command->callback([=, &chosen] { chosen = [=] { return serve(flags->load().settings); }; });
}

}  // namespace kidnapwatch::service
