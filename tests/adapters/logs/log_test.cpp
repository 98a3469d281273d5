// SPDX-License-Identifier: Apache-2.0
// Files that are no logs are refused, by name and line, and cheaply.
#include "adapters/logs/log.hpp"

#include <random>

#include "tests/adapters/logs/log_file.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using LogTest = LogFileTest;

constexpr std::string_view kScans =
    "# hall 0 0.1 2 5\n"
    "0 0 0 0 0 0 0 1 2\n"
    "1 0 0 0 0 0 0 1 2\n";

TEST_F(LogTest, NamesAFileThatIsNoLog) {
  EXPECT_NE(refused(plain("empty", "")).find("empty: "), std::string::npos);
  EXPECT_NE(refused(plain("prose", "Dear robot,\n")).find("prose: "), std::string::npos);
  EXPECT_NE(refused(directory_ / "absent").find("absent: "), std::string::npos);
  EXPECT_NE(refused(directory_), "");
}

TEST_F(LogTest, RefusesAnyGarbage) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    std::string garbage(1 + random() % 100'000, '\0');
    for (char& byte : garbage) byte = static_cast<char>(random());
    EXPECT_NE(refused(plain("garbage", garbage)), "") << trial;
  }
}

TEST_F(LogTest, SurvivesAnyDamageToAGoodLog) {
  std::string good(kScans);
  for (int i = 2; i < 50; ++i) good += std::to_string(i) + " 1 2 3 4 5 6 1.25 2.5\n";
  std::mt19937 random(2);
  for (int trial = 0; trial < 300; ++trial) {
    std::string damaged = good;
    for (int hit = 0; hit < 3; ++hit) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    damaged.resize(random() % damaged.size());
    const std::string said = refusal([&] {
      const Log log = read_log(plain("damaged", damaged));
      for (std::size_t i = 0; i < log.recording.scans.size(); ++i) {
        ASSERT_NO_THROW(check(log.recording.scans[i].scan));
        if (i == 0) continue;
        ASSERT_LT(log.recording.scans[i - 1].scan.stamp, log.recording.scans[i].scan.stamp);
      }
    });
    if (!said.empty()) {
      EXPECT_NE(said.find("damaged"), std::string::npos) << said;
    }
  }
}

TEST_F(LogTest, NamesTheLineWhereACompressedFileEndsEarly) {
  std::mt19937 random(3);
  std::string text(kScans);
  for (int i = 2; i < 5'000; ++i) {
    text += std::to_string(i) + " 0 0 0 0 0 0 " + std::to_string(random() % 1000) + " 2\n";
  }
  const auto file = gzipped("run.scan.gz", text);
  const auto whole = std::filesystem::file_size(file);
  for (const auto size : {whole - 1, whole - 8, whole / 2}) {
    std::filesystem::resize_file(gzipped("run.scan.gz", text), size);
    const std::string said = refused(file);
    EXPECT_EQ(said.find(file.string() + ":"), 0U) << said;
  }
}

TEST_F(LogTest, SkipsALineOfTenMegabytes) {
  const Log log = read_log(gzipped(
      "long", std::string(kScans) + std::string(10 << 20, '1') + "\n" + "3 0 0 0 0 0 0 1 2\n"));
  EXPECT_EQ(log.recording.scans.size(), 3U);
  EXPECT_EQ(log.skipped_lines, 1U);
}

TEST_F(LogTest, GivesUpOnALogThatIsMostlyBroken) {
  std::string text(kScans);
  for (int i = 0; i < 20'000; ++i) text += "x\n";
  const std::string said = refused(plain("broken", text));
  EXPECT_NE(said.find("broken:10003: too many broken lines"), std::string::npos) << said;
}

TEST_F(LogTest, SaysWhyNoScanIsUsable) {
  EXPECT_NE(
      refused(plain("bad", "# hall 0 0.1 2 5\n0 0 0 0 0 0 0 1\n")).find("bad:2: ranges: missing"),
      std::string::npos);
  EXPECT_NE(refused(plain("none", "ODOM 0 0 0 0 0 0 1 h 1\n")).find("no scan"), std::string::npos);
}

}  // namespace
}  // namespace kidnapwatch::adapters::logs
