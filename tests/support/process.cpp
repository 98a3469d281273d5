// SPDX-License-Identifier: Apache-2.0
// Programs run by tests.
#include "tests/support/process.hpp"

#include <cerrno>
#include <csignal>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include "tests/support/mosquitto.hpp"

namespace kidnapwatch::test {
namespace {

int exit_code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

pid_t start(const std::vector<std::string>& argv, const std::filesystem::path& out,
            const std::filesystem::path& err) {
  std::vector<char*> words;
  words.reserve(argv.size() + 1);
  for (const auto& word : argv) {
    words.push_back(const_cast<char*>(word.c_str()));
  }
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  constexpr int kWrite = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, out.c_str(), kWrite, 0644);
  posix_spawn_file_actions_addopen(&files, 2, err.c_str(), kWrite, 0644);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, words[0], &files, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) {
    throw std::system_error(error, std::generic_category(), argv[0]);
  }
  return pid;
}

}  // namespace

Process::Process(const std::vector<std::string>& argv, const std::filesystem::path& out,
                 const std::filesystem::path& err)
    : pid_(start(argv, out, err)) {}

Process::~Process() {
  if (running()) {
    signal(SIGKILL);
    wait();
  }
}

bool Process::running() {
  int status = 0;
  if (exit_code_ < 0 && waitpid(pid_, &status, WNOHANG) == pid_) {
    exit_code_ = exit_code_of(status);
  }
  return exit_code_ < 0;
}

void Process::signal(int number) const { ::kill(pid_, number); }

int Process::wait() {
  int status = 0;
  while (exit_code_ < 0) {
    if (waitpid(pid_, &status, 0) == pid_) {
      exit_code_ = exit_code_of(status);
    }
  }
  return exit_code_;
}

std::string output_of(const std::vector<std::string>& argv) {
  const TemporaryFolder folder;
  Process process(argv, folder.path() / "out", folder.path() / "err");
  const int code = process.wait();
  if (code != 0) {
    ADD_FAILURE() << argv[0] << " exited with " << code << ": "
                  << content_of(folder.path() / "err");
  }
  return content_of(folder.path() / "out");
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

bool eventually(const std::function<bool()>& holds, std::chrono::seconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

}  // namespace kidnapwatch::test
