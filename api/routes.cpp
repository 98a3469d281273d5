// SPDX-License-Identifier: Apache-2.0
// Every address of the API on one page.
#include "api/routes.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "api/assets.hpp"
#include "api/config.hpp"
#include "api/events.hpp"
#include "api/incidents.hpp"
#include "api/problem.hpp"
#include "api/robots.hpp"
#include "api/service.hpp"
#include "api/tuning.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::api {
namespace {

constexpr std::nullopt_t kAnybody = std::nullopt;

constexpr std::array kRoutes{
    Route{"GET", "/api/v1/robots", "", Role::viewer, get_robots},
    Route{"GET", "/api/v1/robots/{id}", "", Role::viewer, get_robot},
    Route{"GET", "/api/v1/robots/{id}/scans", "", Role::viewer, get_scans},
    Route{"GET", "/api/v1/robots/{id}/scores", "from to resolution limit", Role::viewer,
          get_scores},
    Route{"GET", "/api/v1/incidents", "robot state kind label from to cursor limit", Role::viewer,
          get_incidents},
    Route{"GET", "/api/v1/incidents/{id}", "", Role::viewer, get_incident},
    Route{"GET", "/api/v1/incidents/{id}/evidence", "", Role::viewer, get_evidence},
    Route{"GET", "/api/v1/incidents/{id}/history", "", Role::viewer, get_incident_history},
    Route{"POST", "/api/v1/incidents/{id}/ack", "", Role::operator_, post_incident},
    Route{"POST", "/api/v1/incidents/{id}/unack", "", Role::operator_, post_incident},
    Route{"POST", "/api/v1/incidents/{id}/resolve", "", Role::operator_, post_incident},
    Route{"POST", "/api/v1/incidents/{id}/shelve", "", Role::operator_, post_incident},
    Route{"POST", "/api/v1/incidents/{id}/label", "", Role::operator_, post_incident},
    Route{"GET", "/api/v1/config", "", Role::viewer, get_config},
    Route{"PUT", "/api/v1/config", "", Role::admin, put_config},
    Route{"PATCH", "/api/v1/config", "", Role::admin, patch_config},
    Route{"DELETE", "/api/v1/config", "", Role::admin, delete_config},
    Route{"GET", "/api/v1/config/history", "robot cursor limit", Role::viewer, get_config_history},
    Route{"POST", "/api/v1/config/history/{id}/restore", "", Role::admin, restore_config},
    Route{"GET", "/api/v1/robots/{id}/config", "", Role::viewer, get_config},
    Route{"PUT", "/api/v1/robots/{id}/config", "", Role::admin, put_config},
    Route{"PATCH", "/api/v1/robots/{id}/config", "", Role::admin, patch_config},
    Route{"DELETE", "/api/v1/robots/{id}/config", "", Role::admin, delete_config},
    Route{"POST", "/api/v1/thresholds:preview", "", Role::operator_, preview_threshold},
    Route{"POST", "/api/v1/thresholds:calibrate", "", Role::operator_, calibrate_threshold},
    Route{"GET", "/api/v1/evaluation/roc", "detector robot from to", Role::viewer, get_roc},
    Route{"GET", "/api/v1/me", "", Role::viewer, get_me},
    Route{"GET", "/api/v1/events", "robot", Role::viewer, get_events},
    Route{"GET", "/api/v1/service", "", Role::viewer, get_service},
    Route{"GET", "/api/v1/openapi.json", "", kAnybody, get_openapi},
    Route{"GET", "/", "", kAnybody, get_page},
    Route{"GET", "/assets/{id}", "", kAnybody, get_asset},
    Route{"GET", "/api/v1/asyncapi.json", "", kAnybody, get_asyncapi},
    Route{"GET", "/healthz", "", kAnybody, get_health},
    Route{"GET", "/readyz", "", kAnybody, get_readiness},
    Route{"GET", "/metrics", "", Role::viewer, get_metrics},
};

/// What stands for {id} (empty if nothing does), or nothing if the path is another one.
std::optional<std::string> match(std::string_view pattern,
                                 const std::vector<std::string>& segments) {
  std::string id;
  pattern.remove_prefix(1);
  for (const auto& segment : segments) {
    const auto expected = take_until(pattern, '/');
    if (expected == "{id}" && !segment.empty()) {
      id = segment;
    } else if (expected.empty() || expected != segment) {
      return std::nullopt;
    }
  }
  return pattern.empty() ? std::optional(id) : std::nullopt;
}

void refuse_unknown_parameters(const Call& call, std::string_view known) {
  for (const auto& [name, value] : call.target.query) {
    bool found = false;
    for (auto rest = known; !rest.empty();) {
      found |= take_until(rest, ' ') == name;
    }
    if (!found) {
      throw core::BadInput(name, "is not a parameter of this address");
    }
  }
}

/// Whether the content, where the method has some, is what routes take.
bool has_json(const Call& call, std::string_view method) {
  const auto type = header(call.request, "Content-Type");
  return method == "GET" || method == "DELETE" || is_media_type(type, "application/json") ||
         (method == "PATCH" && is_media_type(type, "application/merge-patch+json"));
}

Response call_route(const Route& route, const Call& call) {
  if (route.needs && call.caller.role < *route.needs) {
    return problem(403, "this takes the role " + std::string(name(*route.needs)));
  }
  if (!has_json(call, route.method)) {
    return problem(415, "the content type must be application/json");
  }
  refuse_unknown_parameters(call, route.parameters);
  return route.answer(call);
}

/// Calls the route for whoever the guard lets in.
Response admitted(const Ports& ports, const Route& route, const Request& request,
                  const Target& target, const std::string& id) {
  if (!route.needs) {
    return call_route(route, Call{ports, request, target, id, Caller{.name = request.peer}});
  }
  const auto admission = ports.guard.admit(request);
  if (const auto* refusal = std::get_if<Response>(&admission)) {
    return *refusal;
  }
  return call_route(route, Call{ports, request, target, id, std::get<Caller>(admission)});
}

Response not_allowed(std::set<std::string_view> methods) {
  if (methods.contains("GET")) {
    methods.insert("HEAD");
  }
  std::string allow;
  for (const auto method : methods) {
    allow += (allow.empty() ? "" : ", ") + std::string(method);
  }
  Response response = problem(405, "the methods of this address are " + allow);
  response.headers.push_back({"Allow", allow});
  return response;
}

Response dispatch(const Ports& ports, const Request& request) {
  const Target target = parsed_target(request.target);
  const std::string_view method =
      request.method == "HEAD" ? std::string_view("GET") : request.method;
  std::set<std::string_view> methods;
  for (const auto& route : kRoutes) {
    const auto id = match(route.pattern, target.segments);
    if (id && route.method == method) {
      return admitted(ports, route, request, target, *id);
    }
    if (id) {
      methods.insert(route.method);
    }
  }
  return methods.empty() ? problem(404, "nothing is at this address") : not_allowed(methods);
}

}  // namespace

std::span<const Route> routes() { return kRoutes; }

Response answer(const Ports& ports, const Request& request, const Report& report) {
  try {
    return dispatch(ports, request);
  } catch (const core::BadInput& error) {
    return problem(error);
  } catch (const std::exception& error) {
    report(request.method + " " + request.target + ": " + error.what());
    return problem(500, "the service failed; its log says more");
  }
}

}  // namespace kidnapwatch::api
