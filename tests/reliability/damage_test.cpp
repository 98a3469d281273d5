// SPDX-License-Identifier: Apache-2.0
// A store or a configuration that was scribbled on.
#include <chrono>
#include <fstream>
#include <random>

#include "tests/reliability/promise.hpp"

namespace kidnapwatch::test {
namespace {

using Damage = Promise;

/// Random bytes over one page, the first page spared: that one is another test's.
void spoil(const std::filesystem::path& file, std::mt19937& chance) {
  constexpr std::uintmax_t kPage = 4096;
  const auto pages = std::filesystem::file_size(file) / kPage;
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(static_cast<std::streamoff>((1 + chance() % (pages - 1)) * kPage));
  for (std::uintmax_t i = 0; i < kPage; ++i) stream.put(static_cast<char>(chance()));
}

TEST_F(Damage, ADamagedStoreIsPutAsideAndAFreshOneStartedWithinTenSeconds) {
  start_service();
  (void)stack_.robots({"simulate", "--robots", "5", "--rate", "5", "--duration", "60",
                       "--kidnap-every", "50", "--speed", "10"});
  stack_.service->signal(SIGTERM);
  (void)stack_.service->wait();
  std::mt19937 chance(1);
  for (int page = 0; page < 3; ++page) spoil(stack_.database(), chance);
  const auto begin = std::chrono::steady_clock::now();
  start_service();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
  EXPECT_TRUE(degraded().contains("quarantine"));
  EXPECT_TRUE(std::filesystem::exists(stack_.database().string() + ".damaged-1"));
  EXPECT_EQ(stack_.status_of("/readyz"), 200);  // degraded, and at work
}

TEST_F(Damage, AMutatedConfigurationIsRefusedByTheNameOfItsKey) {
  const auto file = stack_.database().parent_path() / "kidnapwatch.toml";
  for (const auto& [text, key] : std::map<std::string, std::string>{
           {"[service]\nlanes = -3\n", "service.lanes"},
           {"[service]\nlanse = 3\n", "service.lanse"},
           {"[detection]\nstale_after_s = \"soon\"\n", "detection.stale_after_s"},
           {"[mqtt\nurl = 1", "config"}}) {
    std::ofstream(file) << text;
    Process service({KW_PROGRAM, "serve", "--config", file.string()}, file.string() + ".out",
                    file.string() + ".err");
    EXPECT_EQ(service.wait(), 78) << text;
    EXPECT_NE(content_of(file.string() + ".err").find(key), std::string::npos)
        << content_of(file.string() + ".err");
  }
}

}  // namespace
}  // namespace kidnapwatch::test
