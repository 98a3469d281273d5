// SPDX-License-Identifier: Apache-2.0
// Certificates by openssl, the shipped files with a test's paths and ports.
#include "tests/e2e/tls_broker.hpp"

#include <fstream>
#include <regex>
#include <stdexcept>
#include <utility>

#include "tests/support/sockets.hpp"

namespace kidnapwatch::test {

TlsBroker::TlsBroker(const std::vector<std::string>& robots) {
  sh("for ca in robots operators strangers; do openssl req -x509 -newkey ec -pkeyopt "
     "ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=$ca -keyout $ca-ca.key -out $ca-ca.crt; "
     "done; cat robots-ca.crt operators-ca.crt > trusted.crt");
  certify("broker", "operators", "127.0.0.1");
  for (const auto& robot : robots) certify(robot, "robots", robot);
  for (const char* user : {"kidnapwatch", "dashboard", "controller"})
    certify(user, "operators", user);
  start();
}

void TlsBroker::sh(const std::string& script) const {
  (void)output_of({"sh", "-c", "cd " + file("") + " && (" + script + ") 2>>sh.log"});
}

void TlsBroker::certify(const std::string& name, const std::string& ca,
                        const std::string& cn) const {
  sh("openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=" + cn +
     " -keyout " + name + ".key -out " + name + ".csr && printf subjectAltName=IP:127.0.0.1 >san" +
     " && openssl x509 -req -in " + name + ".csr -CA " + ca + "-ca.crt -CAkey " + ca +
     "-ca.key -CAcreateserial -days 2 -extfile san -out " + name + ".crt");
}

void TlsBroker::start() {
  std::string text = content_of(KW_DEPLOY "/mosquitto-tls.conf");
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"/etc/mosquitto/certs/", file("")},
           {"/etc/mosquitto/mosquitto.acl", KW_DEPLOY "/mosquitto.acl"},
           {"/var/lib/mosquitto/", file("")},
           {"listener 8883", "listener " + std::to_string(robots_port) + " 127.0.0.1"},
           {"listener 8884", "listener " + std::to_string(operators_port) + " 127.0.0.1"}}) {
    text = std::regex_replace(text, std::regex(from), to);
  }
  std::ofstream(file("mosquitto.conf"))
      << "user root\n"
      << text << "\nlistener " << plain_port_ << " 127.0.0.1\nallow_anonymous true\n";
  const char* program =
      std::filesystem::exists("/usr/sbin/mosquitto") ? "/usr/sbin/mosquitto" : "mosquitto";
  broker_ =
      std::make_unique<Process>(std::vector<std::string>{program, "-c", file("mosquitto.conf")},
                                file("broker.out"), file("broker.log"));
  if (!eventually([&] { return static_cast<bool>(connected_to(operators_port)); })) {
    throw std::runtime_error(content_of(file("broker.log")));
  }
}

std::vector<std::string> TlsBroker::words(const std::string& program, const std::string& user,
                                          std::uint16_t port) const {
  return {program,
          "-h",
          "127.0.0.1",
          "-p",
          std::to_string(port),
          "--cafile",
          file("trusted.crt"),
          "--cert",
          file(user + ".crt"),
          "--key",
          file(user + ".key"),
          "-q",
          "1"};
}

std::vector<std::string> TlsBroker::service_flags(const std::string& ca) const {
  return {"--mqtt-ca-file",        file(ca + "-ca.crt"), "--mqtt-cert-file",
          file("kidnapwatch.crt"), "--mqtt-key-file",    file("kidnapwatch.key")};
}

}  // namespace kidnapwatch::test
