// SPDX-License-Identifier: Apache-2.0
// Reads ROS 1 bags: records, chunks, connections, messages.
#include "adapters/logs/ros1_bag.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>

#include <bzlib.h>

#include "adapters/logs/bytes.hpp"
#include "adapters/logs/odometry.hpp"
#include "adapters/logs/stamps.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using core::BadInput;

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::size_t kLongestHeader = std::size_t{1} << 20U;
constexpr std::size_t kMostUnpacked = std::size_t{512} << 20U;

enum class Op : std::uint8_t { message = 2, chunk = 5, connection = 7 };  // those that we read

struct TimedScan {
  double time_s = 0.0;
  core::Scan scan;
};

struct Bag {
  std::map<std::uint32_t, std::string> scan_topics;  // by connection
  std::map<std::uint32_t, std::string> odom_topics;
  std::map<std::string, std::vector<TimedScan>> scans;  // by topic
  std::map<std::string, std::vector<TimedPose>> odometry;
  std::size_t unpacked = 0;  // bytes
  Log log;
};

/// A value of a record's header: "name=value", each with its length before it.
std::string_view header_field(std::string_view header, std::string_view name) {
  Bytes fields(header);
  while (!fields.empty()) {
    const std::string_view field = fields.block("header");
    if (field.starts_with(name) && field.substr(name.size()).starts_with('=')) {
      return field.substr(name.size() + 1);
    }
  }
  throw BadInput(std::string(name), "missing in a record's header");
}

Op op(std::string_view header) {
  return Op{Bytes(header_field(header, "op")).value<std::uint8_t>("op")};
}

std::uint32_t connection(std::string_view header) {
  return Bytes(header_field(header, "conn")).value<std::uint32_t>("conn");
}

/// std_msgs/Header: seq, stamp, frame_id.
double stamp_s(Bytes& message) {
  message.take(sizeof(std::uint32_t), "seq");
  const auto seconds = message.value<std::uint32_t>("stamp");
  const auto nanoseconds = message.value<std::uint32_t>("stamp");
  message.block("frame_id");
  return static_cast<double>(seconds) + 1e-9 * static_cast<double>(nanoseconds);
}

/// sensor_msgs/LaserScan.
TimedScan laser_scan(Bytes message) {
  TimedScan timed;
  timed.time_s = stamp_s(message);
  core::ScanGeometry& geometry = timed.scan.geometry;
  geometry.angle_min_rad = static_cast<double>(message.value<float>("angle_min"));
  message.take(sizeof(float), "angle_max");
  geometry.angle_increment_rad = static_cast<double>(message.value<float>("angle_increment"));
  message.take(2 * sizeof(float), "scan_time");
  geometry.range_min_m = static_cast<double>(message.value<float>("range_min"));
  geometry.range_max_m = static_cast<double>(message.value<float>("range_max"));
  const std::size_t beams = message.value<std::uint32_t>("ranges");
  const std::string_view ranges = message.take(beams * sizeof(float), "ranges");
  timed.scan.ranges_m.resize(beams);
  std::memcpy(timed.scan.ranges_m.data(), ranges.data(), ranges.size());
  core::check(timed.scan);
  return timed;
}

/// nav_msgs/Odometry, without twist and covariances.
TimedPose odometry(Bytes message) {
  TimedPose timed;
  timed.time_s = stamp_s(message);
  message.block("child_frame_id");
  timed.T_odom_base.x_m = message.value<double>("position");
  timed.T_odom_base.y_m = message.value<double>("position");
  message.take(sizeof(double), "position");
  const auto x = message.value<double>("orientation");
  const auto y = message.value<double>("orientation");
  const auto z = message.value<double>("orientation");
  const auto w = message.value<double>("orientation");
  timed.T_odom_base.theta_rad = std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
  const core::Pose& pose = timed.T_odom_base;
  if (!std::isfinite(pose.x_m + pose.y_m + pose.theta_rad)) throw BadInput("pose", "not finite");
  return timed;
}

void read_connection(std::string_view header, std::string_view data, Bag& bag) {
  const std::string topic(header_field(header, "topic"));
  const std::string_view type = header_field(data, "type");
  if (type == "sensor_msgs/LaserScan") bag.scan_topics[connection(header)] = topic;
  if (type == "nav_msgs/Odometry") bag.odom_topics[connection(header)] = topic;
}

void read_message(std::string_view header, std::string_view data, Bag& bag) {
  const auto scans = bag.scan_topics.find(connection(header));
  if (scans != bag.scan_topics.end()) {
    bag.scans[scans->second].push_back(laser_scan(Bytes(data)));
  }
  const auto poses = bag.odom_topics.find(connection(header));
  if (poses != bag.odom_topics.end()) {
    bag.odometry[poses->second].push_back(odometry(Bytes(data)));
  }
}

void skip_message(const BadInput& why, const std::string& where, Log& log) {
  if (log.skipped_lines++ == 0) log.first_skipped = where + ": " + why.what();
}

/// The records of a chunk. A broken message is skipped, a broken record thrown.
void read_chunk(std::string_view chunk, const std::string& where, Bag& bag) {
  Bytes records(chunk);
  while (!records.empty()) {
    const std::string_view header = records.block("record header");
    const std::string_view data = records.block("record data");
    if (op(header) == Op::connection) read_connection(header, data, bag);
    if (op(header) != Op::message) continue;
    try {
      read_message(header, data, bag);
    } catch (const BadInput& error) {
      skip_message(error, where, bag.log);
    }
  }
}

std::string unpacked_bzip2(std::string packed, std::uint32_t size, Bag& bag) {
  bag.unpacked += size;
  if (bag.unpacked > kMostUnpacked) throw BadInput("chunk", "unpacks to too much");
  std::string plain(size, '\0');
  unsigned got = size;
  const int error = BZ2_bzBuffToBuffDecompress(plain.data(), &got, packed.data(),
                                               static_cast<unsigned>(packed.size()), 0, 0);
  if (error != BZ_OK || got != size) throw BadInput("chunk", "cannot be unpacked by bzip2");
  return plain;
}

std::string unpacked(std::string_view header, std::string data, Bag& bag) {
  const std::string_view packed_by = header_field(header, "compression");
  if (packed_by == "none") return data;
  if (packed_by != "bz2") {
    throw BadInput("chunk", "packed by " + std::string(packed_by) +
                                "; `rosbag decompress` makes a bag that can be read");
  }
  const auto size = Bytes(header_field(header, "size")).value<std::uint32_t>("size");
  return unpacked_bzip2(std::move(data), size, bag);
}

/// The bag's outermost records, one at a time.
class File {
 public:
  explicit File(const std::filesystem::path& path)
      : path_(path), size_(std::filesystem::file_size(path)), stream_(path, std::ios::binary) {
    take(kMagic.size());
  }

  [[nodiscard]] bool at_end() const { return at_ == size_; }
  [[nodiscard]] std::string where() const {
    return path_.string() + ":byte " + std::to_string(at_);
  }

  std::uint32_t length() {
    return Bytes(take(sizeof(std::uint32_t))).value<std::uint32_t>("length");
  }
  std::string take(std::size_t size) {
    expect(size);
    std::string bytes(size, '\0');
    if (!stream_.read(bytes.data(), static_cast<std::streamsize>(size))) {
      throw BadInput("record", "cannot be read");
    }
    at_ += size;
    return bytes;
  }
  void skip(std::size_t size) {
    expect(size);
    at_ += size;
    stream_.seekg(static_cast<std::streamoff>(at_));
  }

 private:
  void expect(std::size_t size) const {
    if (size > size_ - at_) throw BadInput("record", "cut off");
  }

  std::filesystem::path path_;
  std::size_t size_;
  std::ifstream stream_;
  std::size_t at_ = 0;
};

void read_record(File& file, Bag& bag) {
  const std::string where = file.where();
  const std::size_t header_size = file.length();
  if (header_size > kLongestHeader) throw BadInput("record header", "too long");
  const std::string header = file.take(header_size);
  const std::size_t data_size = file.length();
  if (op(header) != Op::chunk) return file.skip(data_size);
  read_chunk(unpacked(header, file.take(data_size), bag), where, bag);
}

void read_records(const std::filesystem::path& path, Bag& bag) {
  File file(path);
  std::string where = file.where();
  try {
    while (!file.at_end()) {
      where = file.where();
      read_record(file, bag);
    }
  } catch (const BadInput& error) {
    throw BadInput(where, error.what());
  }
}

/// The messages of the topic called `wanted`, else those of the topic with the most of them.
template <typename Message>
std::vector<Message> chosen(std::map<std::string, std::vector<Message>>& topics,
                            const std::string& wanted) {
  if (topics.empty()) return {};
  for (const std::string& topic : {wanted, "/" + wanted}) {
    if (topics.contains(topic)) return std::move(topics[topic]);
  }
  const auto fewer = [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); };
  return std::move(std::max_element(topics.begin(), topics.end(), fewer)->second);
}

}  // namespace

bool is_ros1_bag(std::string_view head) { return head.starts_with(kMagic); }

Log read_ros1_bag(Lines& lines) {
  Bag bag;
  read_records(lines.file(), bag);
  std::vector<TimedPose> poses = chosen(bag.odometry, "odom");
  std::ranges::stable_sort(poses, {}, &TimedPose::time_s);
  std::vector<double> times_s;
  for (TimedScan& timed : chosen(bag.scans, "scan")) {
    timed.scan.odometry = pose_at(poses, timed.time_s);
    times_s.push_back(timed.time_s);
    bag.log.recording.scans.push_back({std::move(timed.scan), std::nullopt});
  }
  set_stamps(bag.log.recording, times_s, lines.file().string());
  return std::move(bag.log);
}

}  // namespace kidnapwatch::adapters::logs
