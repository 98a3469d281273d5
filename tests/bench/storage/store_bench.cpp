// SPDX-License-Identifier: Apache-2.0
// What the store takes and gives on this disk: run `store_bench FOLDER [SECONDS]`.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>
#include <vector>

#include "storage/archive.hpp"
#include "storage/schema.hpp"
#include "storage/segments.hpp"
#include "storage/upkeep.hpp"
#include "storage/writer.hpp"
#include "tests/bench/storage/drive.hpp"
#include "tests/bench/storage/years.hpp"

namespace kidnapwatch::storage {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

/// Of this process, to the disk.
double written_mb() {
  std::ifstream io("/proc/self/io");
  std::string key;
  double value = 0;
  while (io >> key >> value) {
    if (key == "write_bytes:") return value / 1e6;
  }
  return 0;
}

void fresh(const fs::path& file) {
  for (const char* suffix : {"", "-wal", "-shm"}) fs::remove(file.string() + suffix);
  migrate(file);
}

void commits_by_batch(const fs::path& file) {
  auto drives = fleet();
  for (const std::size_t batch : {1U, 100U, 5000U}) {
    fresh(file);
    Database database(file, Access::read_write);
    database.execute("PRAGMA synchronous = FULL");
    Segments segments(database, {});
    std::vector<ScoreRow> rows;
    for (std::size_t i = 0; i < batch; ++i) {
      const auto robot = static_cast<int>(i % kRobots);
      rows.push_back({name_of(robot), drives[static_cast<std::size_t>(robot)].next(), kBegin});
    }
    std::size_t commits = 0;
    const auto begin = Clock::now();
    for (; seconds_since(begin) < 5.0; ++commits) {
      Transaction transaction(database, Transaction::Kind::write);
      segments.write(rows);
      transaction.commit();
      segments.committed();
    }
    const double seconds = seconds_since(begin);
    std::printf("batch %5zu: %8.0f rows/s, %6.2f ms a commit\n", batch,
                static_cast<double>(commits * batch) / seconds,
                1e3 * seconds / static_cast<double>(commits));
  }
}

/// Days of `robots` robots, as blocks among each other.
void fill_a_day(const fs::path& file, int robots) {
  fresh(file);
  Database database(file, Access::read_write);
  RobotIds ids(database);
  Rollups rollups(database);
  Statement add(database,
                "INSERT INTO block (robot, segment, arrival, first_stamp, last_stamp, data) "
                "VALUES (?1, ?2, ?3, ?4, ?5, ?6)");
  auto drives = fleet();
  double bytes = 0;
  double packing_s = 0;
  double rolling_s = 0;
  std::vector<ArrivedScore> minute(300);
  database.execute("PRAGMA synchronous = OFF");
  for (int segment = -1440; segment < 0; ++segment) {
    Transaction transaction(database, Transaction::Kind::write);
    for (int robot = 0; robot < robots; ++robot) {
      for (auto& arrived : minute) {
        arrived.score = drives[static_cast<std::size_t>(robot)].next();
        arrived.arrival = arrived.score.stamp;
      }
      auto begin = Clock::now();
      const auto packed = blocks(minute);
      packing_s += seconds_since(begin);
      begin = Clock::now();
      rollups.add(ids.of(name_of(robot)), segment, minute);
      rolling_s += seconds_since(begin);
      for (const auto& block : packed) {
        bytes += static_cast<double>(block.data.size());
        add.bind(ids.of(name_of(robot)), segment, core::ns_since_epoch(block.arrival),
                 core::ns_since_epoch(block.first), core::ns_since_epoch(block.last), block.data)
            .run();
      }
    }
    transaction.commit();
  }
  const double scores = 1440.0 * 300 * robots;
  database.execute("PRAGMA wal_checkpoint(TRUNCATE)");
  std::printf("%d robot-days: %.2f B a score packed, %.2f in the file with rollups\n", robots,
              bytes / scores, static_cast<double>(fs::file_size(file)) / scores);
  std::printf("%.1f us to pack a robot's minute, %.1f us to sum it up and store that\n",
              1e6 * packing_s / (1440.0 * robots), 1e6 * rolling_s / (1440.0 * robots));
}

struct Figures {
  Quantiles incident_ms;  // until it is durable
  Quantiles minute_ms;    // the latest 300 scores of a robot, while writing
  Quantiles day_ms;       // a robot's day, while writing
  Quantiles thousand_ms;  // 1000 scores within the day, while writing
};

void read_once(const Archive& archive, int days, Figures& figures) {
  static std::mt19937 random(9);
  const auto robot = name_of(static_cast<int>(random() % static_cast<unsigned>(days)));
  const auto day = kBegin + std::chrono::hours(24);
  const auto at = kBegin + std::chrono::seconds(random() % 86'000);
  time(figures.thousand_ms, [&] { (void)archive.scores(robot, at, day, 1000); });
  time(figures.minute_ms, [&] { (void)archive.scores(robot, day, core::Stamp::max(), 1000); });
  time(figures.day_ms, [&] { (void)archive.scores(robot, kBegin, day, 1'000'000); });
}

void put_incidents(Writer& writer, const std::atomic<bool>& stop, Figures& figures) {
  for (int i = 0; !stop; ++i) {
    core::Incident incident{
        .id = std::to_string(1'000'000 + i), .robot = name_of(i % kRobots), .seq = 1};
    core::Scan scan{.ranges_m = std::vector<float>(360, 1.0F)};
    time(figures.incident_ms, [&] {
      writer.put_incident({.incident = incident, .evidence = core::ScanPair{scan, scan}});
      writer.flush().get();
    });
    std::this_thread::sleep_for(milliseconds(200));
  }
}

/// 1000 robots at 5 Hz, an incident five times a second and one reader.
void drive(const fs::path& file, int days, double seconds) {
  Figures figures;
  Writer writer({.file = file});
  const Archive archive(file, writer.recent());
  std::atomic<bool> stop = false;
  std::thread reader([&] {
    for (; !stop; std::this_thread::sleep_for(milliseconds(50))) {
      read_once(archive, days, figures);
    }
  });
  std::thread incidents([&] { put_incidents(writer, stop, figures); });
  auto drives = fleet();
  const double before_mb = written_mb();
  const auto begin = Clock::now();
  std::size_t sent = 0;
  std::size_t wal_bytes = 0;
  while (seconds_since(begin) < seconds) {
    const auto due = static_cast<std::size_t>(seconds_since(begin) * kRobots * kRateHz);
    for (; sent < due; ++sent) {
      const auto robot = sent % kRobots;
      auto score = drives[robot].next();
      score.stamp += std::chrono::hours(24);
      score.reference += std::chrono::hours(24);
      writer.add_score(name_of(static_cast<int>(robot)), score, score.stamp);
    }
    wal_bytes = std::max<std::size_t>(wal_bytes, fs::file_size(file.string() + "-wal"));
    std::this_thread::sleep_for(milliseconds(2));
  }
  stop = true;
  reader.join();
  incidents.join();
  std::printf("%.0f rows/s for %.0f s: %.2f MB/s written, WAL at most %.1f MB, lost %lu\n",
              static_cast<double>(sent) / seconds, seconds, (written_mb() - before_mb) / seconds,
              static_cast<double>(wal_bytes) / 1e6, writer.lost());
  say("an incident is durable after", figures.incident_ms);
  say("read the latest minutes of a robot", figures.minute_ms);
  say("read 1000 scores of a robot's day", figures.thousand_ms);
  say("read a robot's day (432,000 scores)", figures.day_ms);
}

void read_alone(const fs::path& file, int days) {
  Figures figures;
  const Archive archive(file);
  const auto until = Clock::now() + std::chrono::seconds(5);
  while (Clock::now() < until) read_once(archive, days, figures);
  say("alone: read 1000 scores of a robot's day", figures.thousand_ms);
  say("alone: read a robot's day (432,000 scores)", figures.day_ms);
}

void start_again(const fs::path& file) {
  const auto begin = Clock::now();
  const Writer writer({.file = file});
  const double open_s = seconds_since(begin);
  const Archive archive(file, writer.recent());
  const auto robots = archive.robots(1000).size();
  std::printf("start: %.2f s to open, %.2f s until the calibration of %zu robots is known\n",
              open_s, seconds_since(begin), robots);
}

}  // namespace
}  // namespace kidnapwatch::storage

int main(int argc, char** argv) {
  using namespace kidnapwatch::storage;
  if (argc < 2) return std::fputs("usage: store_bench FOLDER [SECONDS [PHASES]]\n", stderr), 2;
  const auto file = fs::path(argv[1]) / "bench.sqlite";
  const double seconds = argc > 2 ? std::stod(argv[2]) : 150;
  const std::string phases = argc > 3 ? argv[3] : "cfyrds";
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  constexpr int kDays = 100;
  for (const char phase : phases) {
    if (phase == 'c') commits_by_batch(file);
    if (phase == 'f') fill_a_day(file, kDays);
    if (phase == 'y') add_years(file, kDays);
    if (phase == 'r') read_years(file, kDays);
    if (phase == 'r') read_alone(file, kDays);
    if (phase == 'd') drive(file, kDays, seconds);
    if (phase == 's') start_again(file);
  }
  return 0;
}
