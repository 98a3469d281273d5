// SPDX-License-Identifier: Apache-2.0
// What every route has in common: finding it, and refusing what it does not take.
#include "api/routes.hpp"

#include "memory_ports.hpp"

namespace kidnapwatch::api {
namespace {

using RoutesTest = ApiTest;

TEST_F(RoutesTest, AnswersAnUnknownAddressWithAProblem) {
  for (const char* target : {"/api", "/assets", "/assets/", "/assets/../x", "/api/v1",
                             "/api/v1/robots/", "/api/v1/robots/a/b", "//",
                             "/api/v1/robots/a/scores/", "/API/v1/robots", "/api/v1/../robots"}) {
    const auto response = get(target);
    EXPECT_EQ(response.status, 404) << target;
    EXPECT_EQ(response.content_type, "application/problem+json");
    EXPECT_EQ(text(body(response)), R"({"type":"about:blank","title":"Not Found","status":404,)"
                                    R"("detail":"nothing is at this address"})");
  }
}

TEST_F(RoutesTest, NamesTheMethodsOfAnAddress) {
  for (const char* method : {"POST", "OPTIONS", "get", "BREW"}) {
    const auto response = call({method, "/api/v1/config", {}, "", ""});
    EXPECT_EQ(response.status, 405) << method;
    EXPECT_EQ(header_of(response, "Allow"), "DELETE, GET, HEAD, PATCH, PUT");
  }
  EXPECT_EQ(header_of(call({"PUT", "/healthz", {}, "", ""}), "Allow"), "GET, HEAD");
}

TEST_F(RoutesTest, AnswersHeadAsGet) {
  const auto response = call({"HEAD", "/healthz", {}, "", ""});
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.body, get("/healthz").body);
}

TEST_F(RoutesTest, RefusesAParameterThatTheAddressDoesNotTake) {
  const auto response = get("/api/v1/incidents?robt=r1");
  EXPECT_EQ(response.status, 400);
  EXPECT_EQ(body(response)["field"], "robt");
  EXPECT_EQ(get("/healthz?from=now").status, 400);
}

TEST_F(RoutesTest, RefusesATargetThatCannotBeDecoded) {
  EXPECT_EQ(body(get("/api/v1/robots/%zz"))["field"], "target");
  EXPECT_EQ(get("*").status, 400);
  EXPECT_EQ(body(get("/api/v1/incidents?robot=a&robot=b"))["field"], "robot");
}

TEST_F(RoutesTest, TakesOnlyJsonAsContent) {
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded"}) {
    EXPECT_EQ(call({"PUT", "/api/v1/config", {{"Content-Type", type}}, "{}", ""}).status, 415);
  }
}

TEST_F(RoutesTest, ReportsAFaultAndKeepsItFromTheClient) {
  fleet.broken = true;
  const auto response = get("/api/v1/robots");
  EXPECT_EQ(response.status, 500);
  EXPECT_EQ(response.body.find("broken"), std::string::npos);
  EXPECT_EQ(report, "GET /api/v1/robots: the fleet is broken");
}

TEST_F(RoutesTest, EchoesBytesThatAreNotUtf8AsReplacements) {
  EXPECT_EQ(body(get("/api/v1/robots/%ff"))["detail"], "no robot is named \xef\xbf\xbd");
}

}  // namespace
}  // namespace kidnapwatch::api
