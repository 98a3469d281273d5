// SPDX-License-Identifier: Apache-2.0
// The service's state in Prometheus' words, counted when it is asked for.
#include <limits>
#include <map>
#include <sstream>

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include "api/service.hpp"

namespace kidnapwatch::api {
namespace {

using Labels = std::vector<prometheus::ClientMetric::Label>;
using prometheus::MetricFamily;
using prometheus::MetricType;

/// How many robots are in each state, states without any included.
std::map<core::RobotState, std::uint64_t> robots_by_state(
    const std::vector<core::RobotStatus>& robots) {
  std::map<core::RobotState, std::uint64_t> counts;
  for (const auto state :
       {core::RobotState::unknown, core::RobotState::normal, core::RobotState::suspect,
        core::RobotState::kidnapped, core::RobotState::degraded, core::RobotState::stale}) {
    counts[state] = 0;
  }
  for (const auto& robot : robots) {
    ++counts[robot.state];
  }
  return counts;
}

void add(MetricFamily& family, Labels labels, double value) {
  auto& metric = family.metric.emplace_back();
  metric.label = std::move(labels);
  if (family.type == MetricType::Counter) {
    metric.counter.value = value;
  } else {
    metric.gauge.value = value;
  }
}

MetricFamily family(MetricType type, const char* name, const char* help) {
  return {name, help, type, {}};
}

MetricFamily single(MetricType type, const char* name, const char* help, double value) {
  auto result = family(type, name, help);
  add(result, {}, value);
  return result;
}

MetricFamily scans(const core::OutcomeCounts& counts) {
  auto result = family(MetricType::Counter, "kidnapwatch_scans_total",
                       "Scans that arrived, by what became of them.");
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto outcome = core::name(static_cast<core::Outcome>(i));
    add(result, {{"outcome", std::string(outcome)}}, static_cast<double>(counts.at(i)));
  }
  return result;
}

MetricFamily commands(const core::CommandCounts& counts) {
  auto result = family(MetricType::Counter, "kidnapwatch_commands_total",
                       "Commands that arrived by MQTT, by what became of them.");
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto name = core::name(static_cast<core::CommandResult>(i));
    add(result, {{"result", std::string(name)}}, static_cast<double>(counts.at(i)));
  }
  return result;
}

MetricFamily robots(const std::vector<core::RobotStatus>& robots) {
  auto result = family(MetricType::Gauge, "kidnapwatch_robots", "Robots, by state.");
  for (const auto& [state, count] : robots_by_state(robots)) {
    add(result, {{"state", std::string(core::name(state))}}, static_cast<double>(count));
  }
  return result;
}

MetricFamily histogram(const char* name, const char* help, const core::Durations& durations) {
  auto result = family(MetricType::Histogram, name, help);
  auto& histogram = result.metric.emplace_back().histogram;
  histogram.sample_sum = durations.sum_s();
  for (std::size_t i = 0; i < durations.counts().size(); ++i) {
    histogram.sample_count += durations.counts().at(i);
    const bool is_last = i == core::Durations::kBounds_s.size();
    histogram.bucket.push_back(
        {histogram.sample_count,
         is_last ? std::numeric_limits<double>::infinity() : core::Durations::kBounds_s.at(i)});
  }
  return result;
}

MetricFamily build(const std::string& version) {
  auto result =
      family(MetricType::Gauge, "kidnapwatch_build_info", "Always 1; which version this is.");
  add(result, {{"version", version}}, 1.0);
  return result;
}

double number(auto value) { return static_cast<double>(value); }

std::vector<MetricFamily> families(const Fleet& fleet) {
  const auto status = fleet.status();
  const auto gauge = MetricType::Gauge;
  return {
      build(status.version),
      single(gauge, "kidnapwatch_start_time_seconds", "When the service started, in Unix time.",
             core::elapsed_s(core::Stamp{}, status.started)),
      scans(status.counts),
      commands(status.commands),
      robots(fleet.robots()),
      histogram("kidnapwatch_scan_judging_seconds",
                "From a scan's arrival until it is judged and its alert on its way.",
                status.judging),
      histogram("kidnapwatch_store_commit_seconds", "Commits of the store.", status.commits),
      single(gauge, "kidnapwatch_queued_scans", "Scans that wait to be scored.",
             number(status.queued_scans)),
      single(gauge, "kidnapwatch_queued_writes", "Records that wait to be stored.",
             number(status.queued_writes)),
      single(MetricType::Counter, "kidnapwatch_lost_writes_total",
             "Records refused because the store's queue was full.", number(status.lost_writes)),
      single(gauge, "kidnapwatch_store_bytes", "Size of the store on the disk.",
             number(status.store_bytes)),
      single(gauge, "kidnapwatch_broker_connected", "1 while the MQTT broker is connected.",
             number(status.broker_connected)),
      single(gauge, "kidnapwatch_store_healthy", "1 while the store takes writes.",
             number(status.store_healthy)),
      single(gauge, "kidnapwatch_config_version", "Version of the detection configuration.",
             number(fleet.config("").effective.version)),
  };
}

}  // namespace

Response get_metrics(const Call& call) {
  std::ostringstream text;
  prometheus::TextSerializer().Serialize(text, families(call.ports.fleet));
  return {200, "text/plain; version=0.0.4; charset=utf-8", text.str()};
}

}  // namespace kidnapwatch::api
