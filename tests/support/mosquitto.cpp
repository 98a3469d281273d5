// SPDX-License-Identifier: Apache-2.0
// Starts and ends mosquitto processes.
#include "tests/support/mosquitto.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/sockets.hpp"

namespace kidnapwatch::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 10s;

[[nodiscard]] std::string contents(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// `user root` only matters to root: mosquitto would become a user who cannot write the folder.
[[nodiscard]] std::string configuration(const std::filesystem::path& folder, std::uint16_t port,
                                        const std::string& options) {
  std::ostringstream text;
  text << "listener " << port << " 127.0.0.1\n"
       << "user root\n"
       << "log_dest file " << (folder / "mosquitto.log").string() << "\n"
       << "persistence true\n"
       << "persistence_location " << folder.string() << "/\n"
       << "autosave_interval 1\n"
       << "max_queued_messages 100000\n"
       << "max_inflight_messages 0\n"
       << "set_tcp_nodelay true\n"
       << options << "\n";
  return text.str();
}

[[noreturn]] void become_mosquitto(const std::string& config_file) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::execlp("mosquitto", "mosquitto", "-c", config_file.c_str(), nullptr);
  ::execl("/usr/sbin/mosquitto", "mosquitto", "-c", config_file.c_str(), nullptr);
  ::_exit(127);
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "kidnapwatch-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::system_error(errno, std::generic_category(), "mkdtemp");
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::uint16_t free_port() { return port_of(listening(0)); }

Mosquitto::Mosquitto(const std::string& options) : port_(free_port()) {
  std::ofstream(folder() / "mosquitto.conf") << configuration(folder(), port_, options);
}

Mosquitto::~Mosquitto() { kill(); }

void Mosquitto::start() {
  const std::string config_file = folder() / "mosquitto.conf";
  pid_ = ::fork();
  if (pid_ == 0) {
    become_mosquitto(config_file);
  }
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!accepts()) {
    const bool ended = ::waitpid(pid_, nullptr, WNOHANG) == pid_;
    if (ended || std::chrono::steady_clock::now() > deadline) {
      throw std::runtime_error("mosquitto did not start: " + contents(folder() / "mosquitto.log"));
    }
    std::this_thread::sleep_for(2ms);  // nothing tells of a port that opens
  }
}

void Mosquitto::kill() { end(SIGKILL); }

void Mosquitto::stop() { end(SIGTERM); }

void Mosquitto::end(int signal) {
  if (pid_ > 0) {
    ::kill(pid_, signal);
    ::waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }
}

bool Mosquitto::accepts() const { return static_cast<bool>(connected_to(port_)); }

}  // namespace kidnapwatch::test
