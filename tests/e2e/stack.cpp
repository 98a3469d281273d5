// SPDX-License-Identifier: Apache-2.0
// Starting the service beside a broker, and asking it as people do.
#include "tests/e2e/stack.hpp"

#include <fstream>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

namespace kidnapwatch::test {

Stack::~Stack() { expect_no_finding(); }

/// Of a sanitizer: a service that is killed cannot tell by its exit code.
void Stack::expect_no_finding() const {
  const std::string log = service_log();
  EXPECT_EQ(log.find("Sanitizer"), std::string::npos) << log;
  EXPECT_EQ(log.find("runtime error:"), std::string::npos) << log;
}

void Stack::start_service(const std::vector<std::string>& more_flags) {
  std::vector<std::string> words = under;
  words.insert(words.end(), {KW_PROGRAM, "serve", "--mqtt-url", broker_url, "--http-port", "0",
                             "--store-file", database().string()});
  words.insert(words.end(), more_flags.begin(), more_flags.end());
  service.reset();
  expect_no_finding();
  service =
      std::make_unique<Process>(words, folder_.path() / "serve.out", folder_.path() / "serve.log");
  ASSERT_TRUE(eventually([&] { return !url().empty(); })) << service_log();
}

void Stack::await_ready() const {
  ASSERT_TRUE(eventually([&] { return status_of("/readyz") == 200; })) << service_log();
}

void Stack::subscribe(const std::string& topic) {
  subscriber_ = std::make_unique<Process>(
      std::vector<std::string>{"mosquitto_sub", "-h", "127.0.0.1", "-p",
                               std::to_string(broker.port()), "-t", topic, "-q", "1", "-c", "-i",
                               "listener", "-F", "%U\t%t\t%p"},
      folder_.path() / "received", folder_.path() / "sub.log");
  // A message of our own, sent until it comes back, shows that the subscription stands.
  ASSERT_TRUE(eventually([&] {
    publish(std::regex_replace(topic, std::regex("[+]"), "listener"), "ping");
    return !received().empty();
  }));
}

Json Stack::robots(std::vector<std::string> words) const {
  words.insert(words.begin(), KW_PROGRAM);
  words.insert(words.end(), {"--broker", broker.url()});
  return Json::parse(output_of(words));
}

std::unique_ptr<Process> Stack::robots_in_background(std::vector<std::string> words) const {
  words.insert(words.begin(), KW_PROGRAM);
  words.insert(words.end(), {"--broker", broker.url()});
  return std::make_unique<Process>(words, folder_.path() / "robots.out",
                                   folder_.path() / "robots.log");
}

void Stack::publish(const std::string& topic, const std::string& payload) const {
  const auto file = folder_.path() / "payload";
  std::ofstream(file, std::ios::binary) << payload;
  (void)output_of({"mosquitto_pub", "-h", "127.0.0.1", "-p", std::to_string(broker.port()), "-t",
                   topic, "-q", "1", "-f", file.string()});
}

std::string Stack::url() const {
  std::smatch found;
  const std::string log = service_log();
  return std::regex_search(log, found, std::regex("serves (http://[^,]*),")) ? found[1].str() : "";
}

std::uint16_t Stack::http_port() const {
  const std::string all = url();
  return static_cast<std::uint16_t>(std::stoi(all.substr(all.rfind(':') + 1)));
}

std::string Stack::get_text(const std::string& path) const {
  return output_of({"curl", "-s", "--max-time", "20", url() + path});
}

Json Stack::get(const std::string& path) const { return Json::parse(get_text(path)); }

Json Stack::post(const std::string& path, const std::string& body) const {
  return ask("POST", path, body);
}

Json Stack::ask(const std::string& method, const std::string& path, const std::string& body) const {
  return Json::parse(output_of({"curl", "-s", "-m", "20", "-X", method, "-H",
                                "Content-Type: application/json", "-d", body, url() + path}));
}

int Stack::status_of(const std::string& path, const std::string& token) const {
  std::vector<std::string> words{"curl",         "-s", "-o", "/dev/null", "-w",
                                 "%{http_code}", "-m", "20", url() + path};
  if (!token.empty()) {
    words.insert(words.end(), {"-H", "Authorization: Bearer " + token});
  }
  return std::stoi(output_of(words));
}

std::uint64_t Stack::counted(const std::string& outcome) const {
  return get("/api/v1/service").at("scans").at(outcome).get<std::uint64_t>();
}

std::uint64_t Stack::counted() const {
  std::uint64_t sum = 0;
  const Json service_status = get("/api/v1/service");
  for (const auto& [outcome, count] : service_status.at("scans").items()) {
    sum += count.get<std::uint64_t>();
  }
  return sum;
}

std::vector<Received> Stack::received() const {
  std::vector<Received> all;
  std::istringstream lines(content_of(folder_.path() / "received"));
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find('\t');
    const auto second = line.find('\t', first + 1);
    if (second != std::string::npos) {
      all.push_back({std::stod(line.substr(0, first)), line.substr(first + 1, second - first - 1),
                     line.substr(second + 1)});
    }
  }
  return all;
}

}  // namespace kidnapwatch::test
