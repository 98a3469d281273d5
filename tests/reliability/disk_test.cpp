// SPDX-License-Identifier: Apache-2.0
// A disk that is full, in several ways: alerts go out all the same, and nothing stored is lost.
#include <csignal>

#include <sys/mount.h>

#include "tests/reliability/promise.hpp"

namespace kidnapwatch::test {
namespace {

class Disk : public Promise {
 protected:
  void drive(const std::string& name, int seed) {
    sent_ += stack_
                 .robots({"simulate", "--robots", "2", "--rate", "5", "--duration", "60",
                          "--kidnap-every", "50", "--speed", "10", "--name", name, "--seed",
                          std::to_string(seed)})
                 .at("scans")
                 .get<std::uint64_t>();
  }
  /// The robots that an alert told of.
  [[nodiscard]] bool heard_of(const std::string& name) const {
    const auto robots = received("robotId");
    return robots.contains(name + "-0001") && robots.contains(name + "-0002");
  }

  /// `spoil` makes the disk fail, `mend` works again.
  template <typename Spoil, typename Mend>
  void expect_to_live_through(Spoil spoil, Mend mend) {
    drive("before", 1);
    ASSERT_TRUE(eventually([&] { return number("SELECT count(*) FROM incident") == 2; }));
    spoil();
    drive("meanwhile", 2);
    EXPECT_TRUE(eventually([&] { return heard_of("meanwhile"); }));
    EXPECT_TRUE(eventually([&] { return degraded().contains("store"); }));
    EXPECT_EQ(stack_.status_of("/readyz"), 503);
    EXPECT_EQ(stack_.get("/api/v1/incidents").at("incidents").size(), 2U);  // reading goes on
    mend();
    EXPECT_TRUE(eventually([&] { return stack_.status_of("/readyz") == 200; }));
    EXPECT_TRUE(eventually([&] { return number("SELECT count(*) FROM incident") == 4; }));
    EXPECT_EQ(number("SELECT count(*) FROM evidence_scan"), 8);
    EXPECT_EQ(stack_.get("/api/v1/service").at("lostWrites"), 0);
    EXPECT_TRUE(eventually([&] { return all_delivered(); }));
    EXPECT_EQ(rows("PRAGMA integrity_check"), std::vector<std::string>{"ok"});
  }

  std::uint64_t sent_ = 0;
};

TEST_F(Disk, AFileThatMayNotGrowLosesNothing) {
  stack_.subscribe("kidnapwatch/v1/+/alert");
  start_service();
  const auto limit = [&](const std::string& bytes) {
    (void)output_of(
        {"prlimit", "--pid", std::to_string(stack_.service->pid()), "--fsize=" + bytes});
  };
  expect_to_live_through([&] { limit("4096:unlimited"); }, [&] { limit("unlimited:unlimited"); });
}

TEST_F(Disk, AFullFileSystemLosesNothing) {
  const TemporaryFolder small;
  if (::mount("tmpfs", small.path().c_str(), "tmpfs", 0, "size=4m") != 0) {
    GTEST_SKIP() << "may not mount a tmpfs";
  }
  stack_.subscribe("kidnapwatch/v1/+/alert");
  stack_.store_file = small.path() / "store.db";
  start_service();
  const auto filler = (small.path() / "filler").string();
  expect_to_live_through(
      [&] {
        (void)output_of({"sh", "-c", "cat /dev/zero > " + filler + " 2>/dev/null; true"});
      },
      [&] { std::filesystem::remove(filler); });
  stack_.service.reset();
  ::umount2(small.path().c_str(), MNT_DETACH);
}

TEST_F(Disk, WritesThatFailWithENOSPCLoseNothing) {
  if (!std::string(KW_SANITIZED).empty())
    GTEST_SKIP() << "libfiu cannot be loaded before a sanitizer";
  stack_.subscribe("kidnapwatch/v1/+/alert");
  stack_.under = {"fiu-run", "-x"};
  start_service();
  const auto control = [&](const std::string& command) {
    (void)output_of({"fiu-ctrl", "-c", command, std::to_string(stack_.service->pid())});
  };
  expect_to_live_through([&] { control("enable name=posix/io/rw/pwrite,failinfo=28"); },  // ENOSPC
                         [&] { control("disable name=posix/io/rw/pwrite"); });
}

}  // namespace
}  // namespace kidnapwatch::test
