// SPDX-License-Identifier: Apache-2.0
// What the reliability tests share: the whole service, its store, and the figures they report.
#pragma once

#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/e2e/stack.hpp"

namespace kidnapwatch::test {

class Promise : public ::testing::Test {
 protected:
  void start_service(const std::vector<std::string>& more_flags = {}) {
    stack_.start_service(more_flags);
    stack_.await_ready();
  }

  void kill_service() {
    stack_.service->signal(SIGKILL);
    (void)stack_.service->wait();
  }

  /// Rows of a query on the store, columns separated by |.
  [[nodiscard]] std::vector<std::string> rows(const std::string& query) const {
    std::istringstream lines(
        output_of({"sqlite3", "-cmd", ".timeout 5000", stack_.database().string(), query}));
    std::vector<std::string> all;
    for (std::string line; std::getline(lines, line);) all.push_back(line);
    return all;
  }
  [[nodiscard]] std::int64_t number(const std::string& query) const {
    return std::stoll(rows(query).at(0));
  }

  /// How often each alert was received, by its member `key`.
  [[nodiscard]] std::map<std::string, int> received(const std::string& key) const {
    std::map<std::string, int> counts;
    for (const auto& message : stack_.received()) {
      const Json alert = Json::parse(message.payload, nullptr, false);
      if (alert.is_object() && alert.contains(key)) ++counts[alert.at(key).get<std::string>()];
    }
    return counts;
  }

  [[nodiscard]] bool all_delivered() const {
    return number("SELECT count(*) FROM alert WHERE NOT delivered") == 0;
  }

  /// The names of what the service calls degraded now.
  [[nodiscard]] std::set<std::string> degraded() const {
    std::set<std::string> names;
    const Json service = stack_.get("/api/v1/service");
    for (const auto& one : service.at("degraded")) {
      names.insert(one.at("name").get<std::string>());
    }
    return names;
  }

  /// For tests/reliability/run, which puts it into its report.
  static void report(const std::string& figure) { std::cout << "figure: " << figure << "\n"; }

  Stack stack_;
};

}  // namespace kidnapwatch::test
