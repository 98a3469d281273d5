// SPDX-License-Identifier: Apache-2.0
// Incidents from history, newest first, page by page.
#include "api/incidents.hpp"

#include "adapters/codecs/command_json.hpp"
#include "adapters/codecs/history_json.hpp"
#include "api/problem.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::api {
namespace {

using adapters::codecs::evidence_json;
using adapters::codecs::incidents_csv;
using adapters::codecs::json;
using adapters::codecs::Json;

/// A cursor is the id of the last incident of the page before; clients only ever hand it back.
std::string incident_of(const std::string& cursor) {
  if (!core::is_robot_id(cursor)) {
    throw core::BadInput("cursor", "must be taken from the link to the next page");
  }
  return cursor;
}

IncidentQuery query(const Call& call) {
  IncidentQuery query;
  query.robot = parameter(call, "robot");
  if (const auto state = parameter(call, "state")) {
    query.state = core::incident_state(*state, "state");
  }
  if (const auto kind = parameter(call, "kind")) {
    query.kind = core::incident_kind(*kind, "kind");
  }
  if (const auto label = parameter(call, "label")) {
    query.label = core::incident_label(*label, "label");
  }
  query.opened_at = time_range(call);
  if (const auto cursor = parameter(call, "cursor")) {
    query.before_id = incident_of(*cursor);
  }
  return query;
}

/// The first incidents that the caller may see, at most `wanted.limit`.
std::vector<core::Incident> visible(const Call& call, IncidentQuery wanted) {
  std::vector<core::Incident> found;
  while (true) {
    const auto page = call.ports.history.incidents(wanted);
    for (const auto& incident : page) {
      if (call.caller.may_see(incident.robot) && found.size() < wanted.limit) {
        found.push_back(incident);
      }
    }
    if (page.size() < wanted.limit || found.size() == wanted.limit) {
      return found;
    }
    wanted.before_id = page.back().id;
  }
}

std::optional<core::Incident> visible_incident(const Call& call) {
  auto incident = call.ports.history.incident(call.id);
  return incident && call.caller.may_see(incident->robot) ? incident : std::nullopt;
}

Response no_such_incident(const Call& call) {
  return problem(404, "no incident has the id " + call.id);
}

}  // namespace

Response get_incidents(const Call& call) {
  const auto limit = page_limit(call, kDefaultPage);
  auto wanted = query(call);
  wanted.limit = limit + 1;
  auto incidents = visible(call, wanted);
  std::optional<std::string> next;
  if (incidents.size() > limit) {
    incidents.pop_back();
    next = link_with(call, "cursor", incidents.back().id);
  }
  Response response;
  if (prefers(header(call.request, "Accept"), "text/csv", "application/json")) {
    response = {200, "text/csv; charset=utf-8; header=present", incidents_csv(incidents)};
  } else {
    Json body{{"incidents", Json::array()}};
    for (const auto& incident : incidents) body["incidents"].push_back(json(incident));
    adapters::codecs::set(body, "next", next);
    response = ok(body);
  }
  response.headers.push_back({"Vary", "Accept"});
  if (next) link_next(response, *next);
  return response;
}

Response get_incident(const Call& call) {
  const auto incident = visible_incident(call);
  return incident ? ok(json(*incident)) : no_such_incident(call);
}

Response get_evidence(const Call& call) {
  const auto incident = visible_incident(call);
  const auto evidence = incident ? call.ports.history.evidence(call.id) : std::nullopt;
  if (!evidence) {
    return problem(404, "no evidence is kept of an incident " + call.id);
  }
  const auto config = call.ports.fleet.config(incident->robot).effective.config;
  return ok_text(evidence_json(*evidence, core::sight(evidence->scans, config)));
}

Response get_incident_history(const Call& call) {
  if (!visible_incident(call)) {
    return no_such_incident(call);
  }
  Json body{{"history", Json::array()}};
  for (const auto& alert : call.ports.history.alerts_of(call.id)) {
    body["history"].push_back(adapters::codecs::change_json(alert.json));
  }
  return ok(body);
}

Response post_incident(const Call& call) {
  auto command = adapters::codecs::incident_command(
      call.target.segments.back(),
      adapters::codecs::parsed(call.request.body.empty() ? "{}" : call.request.body, "body"));
  command.author = call.caller.name;
  const auto incident = visible_incident(call);
  if (!incident) {
    return no_such_incident(call);
  }
  try {
    const auto changed = call.ports.fleet.change_incident(call.id, command);
    return changed ? ok(json(*changed))
                   : problem(409, "the incident is " + std::string(core::name(incident->state)));
  } catch (const Unavailable& busy) {
    return problem(503, busy.what());
  }
}

}  // namespace kidnapwatch::api
