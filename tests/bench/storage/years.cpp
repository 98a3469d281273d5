// SPDX-License-Identifier: Apache-2.0
// Rollups of a year, out of those of a day.
#include "tests/bench/storage/years.hpp"

#include <array>

#include "storage/archive.hpp"
#include "storage/rollups.hpp"
#include "tests/bench/storage/drive.hpp"

namespace kidnapwatch::storage {
namespace {

using core::ScoreBucket;
using std::chrono::hours;
using std::chrono::seconds;
using Day = std::vector<ScoreBucket>;

constexpr int kMinuteDays = 60;
constexpr int kHourDays = 365;
constexpr double kRawDays = 30;
constexpr auto kDay = hours(24);

double bytes_in_use(Database& database) {
  const auto pages =
      database.integer("PRAGMA page_count") - database.integer("PRAGMA freelist_count");
  return static_cast<double>(pages * database.integer("PRAGMA page_size"));
}

/// Of every robot, that which is in the store.
std::vector<Day> days_of(const Archive& archive, int robots, const RollupLevel& level) {
  std::vector<Day> days;
  for (int robot = 0; robot < robots; ++robot) {
    days.push_back(
        archive.score_buckets(name_of(robot), kBegin, kBegin + kDay, level.width, 10'000));
  }
  return days;
}

/// The day, so much earlier, in runs.
void add_day(Statement& add, int robot, const Day& day, const RollupLevel& level, hours earlier) {
  for (auto begin = day.begin(); begin != day.end();) {
    const ScoreBucket span{.from = core::begin_of(level.span, begin->from), .width = level.span};
    Day run;
    for (; begin != day.end() && span.holds(begin->from); ++begin) {
      run.push_back(*begin);
      run.back().from -= earlier;
    }
    const auto at = span.from - earlier;
    add.bind(robot + 1, level.width.count(), at, at, packed(run, level)).run();
  }
}

/// Returns the bytes that a robot's day takes in the file.
double add_days(Database& database, const std::vector<Day>& days, const RollupLevel& level,
                int count) {
  Statement add(database,
                "INSERT INTO rollup (robot, width, begin, arrival, data) "
                "VALUES (?1, ?2, ?3, ?4, ?5)");
  const double before = bytes_in_use(database);
  for (int day = count; day > 0; --day) {
    Transaction transaction(database, Transaction::Kind::write);
    for (std::size_t robot = 0; robot < days.size(); ++robot) {
      add_day(add, static_cast<int>(robot), days[robot], level, day * kDay);
    }
    transaction.commit();
  }
  return (bytes_in_use(database) - before) / (count * static_cast<double>(days.size()));
}

}  // namespace

void add_years(const std::filesystem::path& file, int robots) {
  const Archive archive(file);
  Database database(file, Access::read_write);
  database.execute("PRAGMA synchronous = OFF");
  const double of_scores = static_cast<double>(database.integer(
                               "SELECT sum(pgsize) FROM dbstat WHERE name LIKE 'block%'")) /
                           robots;
  const auto of_minutes =
      add_days(database, days_of(archive, robots, kMinutes), kMinutes, kMinuteDays);
  const auto of_hours = add_days(database, days_of(archive, robots, kHours), kHours, kHourDays);
  std::printf("a robot-day in the file: scores %.0f B, minutes %.0f B, hours %.0f B\n", of_scores,
              of_minutes, of_hours);
  std::printf("a robot-year: scores %.1f MB, minutes %.2f MB, hours %.3f MB\n", 365e-6 * of_scores,
              365e-6 * of_minutes, 365e-6 * of_hours);
  std::printf(
      "%d robots at %g Hz: %g days of scores %.1f GB, %d of minutes %.2f GB, "
      "%d of hours %.2f GB\n",
      kRobots, kRateHz, kRawDays, 1e-9 * kRobots * kRawDays * of_scores, kMinuteDays,
      1e-9 * kRobots * kMinuteDays * of_minutes, kHourDays, 1e-9 * kRobots * kHourDays * of_hours);
}

void read_years(const std::filesystem::path& file, int robots) {
  struct Look {
    const char* what;
    hours back;
    seconds resolution;
    Quantiles ms = {};
  };
  std::array looks{Look{"1000 buckets of 10 s, of scores", hours(0), seconds(10)},
                   Look{"a robot-day by the minute", hours(0), seconds(60)},
                   Look{"a robot-month by the hour", 30 * kDay, seconds(3600)},
                   Look{"a robot-month by the minute", 30 * kDay, seconds(60)},
                   Look{"a robot-year by the hour", 364 * kDay, seconds(3600)},
                   Look{"a robot-year by the day", 364 * kDay, seconds(86'400)}};
  const Archive archive(file);
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    const auto robot = name_of(static_cast<int>(random() % static_cast<unsigned>(robots)));
    for (auto& look : looks) {
      const std::size_t limit = look.resolution < seconds(60) ? 1000 : 100'000;
      time(look.ms, [&] {
        (void)archive.score_buckets(robot, kBegin - look.back, kBegin + kDay, look.resolution,
                                    limit);
      });
    }
  }
  for (auto& look : looks) say(look.what, look.ms);
}

}  // namespace kidnapwatch::storage
