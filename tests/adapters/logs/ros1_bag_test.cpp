// SPDX-License-Identifier: Apache-2.0
// ROS 1 bags, written here record by record as the format's description has them.
#include "adapters/logs/ros1_bag.hpp"

#include <cmath>
#include <cstdint>
#include <random>

#include <bzlib.h>

#include "tests/adapters/logs/log_file.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

template <typename Value>
std::string bytes(Value value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string block(const std::string& content) {
  return bytes(static_cast<std::uint32_t>(content.size())) + content;
}

std::string record(char op, const std::string& more_fields, const std::string& data) {
  return block(block(std::string("op=") + op) + more_fields) + block(data);
}

std::string conn(std::uint32_t id) { return block("conn=" + bytes(id)); }

std::string connection(std::uint32_t id, const std::string& topic, const std::string& type) {
  return record(7, conn(id) + block("topic=" + topic),
                block("topic=" + topic) + block("type=" + type));
}

std::string message(std::uint32_t id, const std::string& data) {
  return record(2, conn(id) + block("time=12345678"), data);
}

std::string header(std::uint32_t sec, std::uint32_t nsec) {
  return bytes(0U) + bytes(sec) + bytes(nsec) + block("frame");
}

std::string laser_scan(std::uint32_t sec, const std::vector<float>& ranges,
                       float range_max = 5.0F) {
  std::string scan = header(sec, 500'000'000);
  for (const float value : {-0.5F, 0.5F, 0.5F, 0.0F, 0.1F, 0.125F, range_max}) scan += bytes(value);
  scan += bytes(static_cast<std::uint32_t>(ranges.size()));
  for (const float range : ranges) scan += bytes(range);
  return scan + bytes(0U);
}

std::string odometry(std::uint32_t sec, double x_m, double theta_rad) {
  std::string odometry = header(sec, 0) + block("base");
  for (const double value :
       {x_m, 0.0, 0.0, 0.0, 0.0, std::sin(theta_rad / 2), std::cos(theta_rad / 2)}) {
    odometry += bytes(value);
  }
  return odometry + std::string(2 * 36 * 8 + 6 * 8, '\0');
}

std::string chunk(const std::string& records, const std::string& compression = "none",
                  std::size_t size = 0) {
  const auto plain = static_cast<std::uint32_t>(size > 0 ? size : records.size());
  return record(5, block("compression=" + compression) + block("size=" + bytes(plain)), records);
}

std::string bzip2(std::string plain) {
  std::string packed(plain.size() + 1000, '\0');
  auto size = static_cast<unsigned>(packed.size());
  EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, plain.data(),
                                     static_cast<unsigned>(plain.size()), 9, 0, 0),
            BZ_OK);
  packed.resize(size);
  return packed;
}

std::string bag(const std::string& chunks) {
  return "#ROSBAG V2.0\n" + record(3, block("index_pos=12345678"), std::string(100, ' ')) + chunks +
         record(4, block("ver=1"), "an index") + record(6, block("ver=1"), "a chunk's description");
}

std::string two_scans() {
  return connection(1, "/scan", "sensor_msgs/LaserScan") +
         connection(2, "/odom", "nav_msgs/Odometry") + connection(3, "/tf", "tf2_msgs/TFMessage") +
         message(2, odometry(100, 1.0, 0.0)) + message(1, laser_scan(100, {1, 2, INFINITY})) +
         message(3, "whatever") + message(2, odometry(101, 2.0, 1.0)) +
         message(1, laser_scan(101, {3, 4, 5}));
}

using Ros1BagTest = LogFileTest;

void expect_two_scans(const Log& log) {
  EXPECT_EQ(log.skipped_lines, 0U);
  ASSERT_EQ(log.recording.scans.size(), 2U);
  const core::Scan& first = log.recording.scans[0].scan;
  EXPECT_EQ(first.geometry, (core::ScanGeometry{-0.5, 0.5, 0.125, 5.0}));
  EXPECT_EQ(first.ranges_m, (std::vector<float>{1, 2, INFINITY}));
  EXPECT_EQ(core::ns_since_epoch(first.stamp), 100'500'000'000);
  ASSERT_TRUE(first.odometry);
  EXPECT_NEAR(first.odometry->x_m, 1.5, 1e-9);
  EXPECT_NEAR(first.odometry->theta_rad, 0.5, 1e-9);
  EXPECT_EQ(log.recording.scans[1].scan.ranges_m, (std::vector<float>{3, 4, 5}));
}

TEST_F(Ros1BagTest, IsReadPlain) {
  const Log log = read_log(plain("run.bag", bag(chunk(two_scans()))));
  EXPECT_EQ(log.recording.name, "run");
  expect_two_scans(log);
}

TEST_F(Ros1BagTest, IsReadPackedByBzip2) {
  const std::string records = two_scans();
  expect_two_scans(read_log(plain("run.bag", bag(chunk(bzip2(records), "bz2", records.size())))));
}

TEST_F(Ros1BagTest, SaysWhatToDoWithLz4) {
  EXPECT_NE(refused(plain("run.bag", bag(chunk("?", "lz4")))).find("packed by lz4; `rosbag"),
            std::string::npos);
}

TEST_F(Ros1BagTest, PrefersTheTopicCalledScan) {
  const auto scans = [](std::uint32_t id, const std::string& topic, float range, int count) {
    std::string records = connection(id, topic, "sensor_msgs/LaserScan");
    for (int i = 0; i < count; ++i) {
      records += message(id, laser_scan(static_cast<std::uint32_t>(100 + i), {range}));
    }
    return records;
  };
  const std::string few = scans(1, "/front", 1.0F, 2);
  const std::string many = scans(2, "/back", 2.0F, 3);
  const std::string named = scans(3, "scan", 3.0F, 1);
  const auto first_range = [&](const std::string& records) {
    return read_log(plain("a", bag(chunk(records)))).recording.scans[0].scan.ranges_m[0];
  };
  EXPECT_EQ(first_range(few + many), 2.0F);
  EXPECT_EQ(first_range(few + many + named), 3.0F);
}

TEST_F(Ros1BagTest, SkipsAndCountsBrokenMessages) {
  const std::string good = laser_scan(102, {1, 2, 3});
  std::string false_count = good;
  false_count.replace(good.size() - 20, 4, bytes(0xFFFFFFFFU));
  const Log log = read_log(
      plain("a", bag(chunk(two_scans() + message(1, good.substr(0, 30)) + message(1, false_count) +
                           message(1, "") + message(1, laser_scan(103, {1}, 0.0F)) +
                           message(2, odometry(104, NAN, 0.0))))));
  EXPECT_EQ(log.recording.scans.size(), 2U);
  EXPECT_EQ(log.skipped_lines, 5U);
  EXPECT_NE(log.first_skipped.find("a:byte "), std::string::npos) << log.first_skipped;
}

TEST_F(Ros1BagTest, RefusesAChunkThatIsABomb) {
  const std::string little = bzip2(std::string(1000, '\0'));
  std::string chunks;
  for (int i = 0; i < 3; ++i) chunks += chunk(little, "bz2", std::size_t{600} << 20U);
  EXPECT_NE(refused(plain("bomb.bag", bag(chunks))).find("unpacks to too much"), std::string::npos);
  EXPECT_NE(refused(plain("liar.bag", bag(chunk(little, "bz2", 10)))).find("bzip2"),
            std::string::npos);
}

TEST_F(Ros1BagTest, RefusesABagThatIsCutOffWhereverThatIs) {
  const std::string whole = bag(chunk(two_scans()));
  for (std::size_t size = 14; size < whole.size(); size += 7) {
    const std::string said = refusal([&] {
      const Log log = read_log(plain("cut.bag", whole.substr(0, size)));
      EXPECT_EQ(log.recording.scans.size(), 2U) << size;  // cut between records, after the chunk
    });
    if (!said.empty()) {
      EXPECT_NE(said.find("cut.bag"), std::string::npos) << said;
    }
  }
}

TEST_F(Ros1BagTest, SurvivesAnyDamage) {
  const std::string records = two_scans();
  std::mt19937 random(4);
  for (const std::string& whole :
       {bag(chunk(records)), bag(chunk(bzip2(records), "bz2", records.size()))}) {
    for (int trial = 0; trial < 500; ++trial) {
      std::string damaged = whole;
      for (int hit = 0; hit < 3; ++hit) {
        damaged[13 + random() % (damaged.size() - 13)] = static_cast<char>(random());
      }
      static_cast<void>(refused(plain("damaged.bag", damaged)));
    }
  }
}

}  // namespace
}  // namespace kidnapwatch::adapters::logs
