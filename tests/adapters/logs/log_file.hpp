// SPDX-License-Identifier: Apache-2.0
// Log files for tests: written for one test, gone after it.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include "adapters/logs/log.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {

/// A directory of its own for every test.
class LogFileTest : public ::testing::Test {
 public:
  ~LogFileTest() override { std::filesystem::remove_all(directory_); }

 protected:
  LogFileTest() {
    std::string path = (std::filesystem::temp_directory_path() / "kidnapwatch-log-XXXXXX").string();
    EXPECT_NE(mkdtemp(path.data()), nullptr);
    directory_ = path;
  }

  [[nodiscard]] std::filesystem::path plain(const std::string& name, std::string_view text) const {
    std::ofstream(directory_ / name, std::ios::binary) << text;
    return directory_ / name;
  }

  [[nodiscard]] std::filesystem::path gzipped(const std::string& name,
                                              std::string_view text) const {
    auto file = directory_ / name;
    gzFile gz = gzopen(file.c_str(), "wb6");
    EXPECT_EQ(gzwrite(gz, text.data(), static_cast<unsigned>(text.size())),
              static_cast<int>(text.size()));
    gzclose(gz);
    return file;
  }

  std::filesystem::path directory_;
};

/// What BadInput says that `action` throws; empty if it throws none.
template <typename Action>
std::string refusal(Action action) {
  try {
    action();
  } catch (const core::BadInput& error) {
    return error.what();
  }
  return "";
}

/// What read_log says against the file.
inline std::string refused(const std::filesystem::path& file) {
  return refusal([&] { static_cast<void>(read_log(file)); });
}

}  // namespace kidnapwatch::adapters::logs
