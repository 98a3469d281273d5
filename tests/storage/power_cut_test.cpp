// SPDX-License-Identifier: Apache-2.0
// A power cut at any moment: what was acknowledged is there afterwards, and whole.
#include <atomic>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "storage/archive.hpp"
#include "storage/journal.hpp"
#include "storage/segments.hpp"
#include "storage/upkeep.hpp"
#include "storage/writer.hpp"
#include "tests/storage/fault_vfs.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

namespace fs = std::filesystem;

constexpr int kRuns = 8;
constexpr int kCutsPerRun = 125;
constexpr int kIncidents = 25;
constexpr int kCheckpointEvery = 8;

IncidentChange change(int number) {
  return {.incident = incident_of(number),
          .evidence = core::ScanPair{},
          .alert = OutboxMessage{incident_id(number), "robot-1", "{}"}};
}

constexpr int kScoresEach = 4;  // with an incident, of one minute

/// Writes the incident with this number, and returns once it is acknowledged.
using Write = std::function<void(int number)>;
/// Opens the store and says how to write to it.
using Open = std::function<Write(const fs::path& store)>;

Write through_the_writer(const fs::path& store) {
  const auto writer =
      std::make_shared<Writer>(WriterConfig{.file = store, .segments = {.scores_per_robot = 8}});
  return [writer](int number) {
    for (int i = 0; i < kScoresEach; ++i) {  // hours apart, so that rollups are written, too
      const double t = 2400.0 * number + i;
      writer->add_score("robot-1", score_at(t), at_s(t));
    }
    writer->put_incident(change(number));
    writer->flush().get();
  };
}

Write without_syncing_commits(const fs::path& store) {
  const auto database = std::make_shared<Database>(store, Access::read_write);
  database->execute("PRAGMA synchronous = NORMAL");
  const auto journal = std::make_shared<Journal>(*database);
  return [database, journal](int number) {
    Transaction transaction(*database, Transaction::Kind::write);
    journal->put(change(number));
    transaction.commit();
  };
}

struct Cut {
  fs::path store;
  int acknowledged = 0;
};

struct Toll {
  int cuts = 0;
  int lost = 0;       // incidents that were acknowledged
  int damaged = 0;    // stores
  int separated = 0;  // stores where incidents, alerts, evidence and audit entries differ in number
  int lost_scores = 0;
  int miscounted = 0;  // stores where buckets are not those of the scores
  std::int64_t rollups = 0;
};

void count_scores(Toll& toll, const Cut& cut) {
  const Archive archive(cut.store);
  const auto all = archive.scores("robot-1", core::Stamp::min(), core::Stamp::max(), 10'000);
  for (const auto width : {std::chrono::seconds(60), std::chrono::seconds(3600)}) {
    core::ScoreBuckets expected(width, 10'000);
    for (const auto& score : all) expected.add(score);
    const auto found =
        archive.score_buckets("robot-1", core::Stamp::min(), core::Stamp::max(), width, 10'000);
    toll.miscounted += found == expected.all() ? 0 : 1;
  }
  toll.lost_scores += std::max(0, kScoresEach * cut.acknowledged - static_cast<int>(all.size()));
}

void count(Toll& toll, const Cut& cut) {
  ++toll.cuts;
  if (damage(cut.store, std::chrono::minutes(1))) {
    ++toll.damaged;
    return;
  }
  Database database(cut.store, Access::read_only);
  const auto rows = [&](const std::string& table) {
    return database.integer("SELECT count(*) FROM " + table);
  };
  const auto incidents = rows("incident");
  toll.lost += std::max(0, cut.acknowledged - static_cast<int>(incidents));
  const bool is_one = incidents == rows("alert") && incidents == rows("audit") &&
                      2 * incidents == rows("evidence_scan");
  toll.separated += is_one ? 0 : 1;
  toll.rollups += rows("rollup");
  count_scores(toll, cut);
}

/// One store, written to until the end, and the power cut at kCutsPerRun moments of it.
std::vector<Cut> run(FaultyDisk& disk, const fs::path& folder, const Open& open,
                     std::mt19937& chance) {
  std::vector<Cut> cuts;
  std::atomic<int> acknowledged = 0;
  disk.expect_power_cuts([&] {
    if (cuts.size() >= kCutsPerRun || chance() % 4 != 0) return;
    const auto left_behind = folder / std::to_string(cuts.size());
    fs::create_directory(left_behind);
    disk.cut_power(left_behind, chance);
    cuts.push_back({left_behind / "store.sqlite", acknowledged});
  });
  const auto store = folder / "store.sqlite";
  const Write write = open(store);
  Database other(store, Access::read_write);
  for (int number = 1; number <= kIncidents; ++number) {
    write(number);
    acknowledged = number;
    if (number % kCheckpointEvery == 0) other.execute("PRAGMA wal_checkpoint(PASSIVE)");
  }
  disk.expect_power_cuts(nullptr);
  return cuts;
}

Toll toll_of(const Open& open, int runs) {
  std::mt19937 chance(1);
  Toll toll;
  for (int i = 0; i < runs; ++i) {
    const StoreFolder folder;
    FaultyDisk disk;
    disk.spare_syncs();
    prepare_store(folder.store());
    for (const Cut& cut : run(disk, folder.path(), open, chance)) count(toll, cut);
  }
  return toll;
}

TEST(PowerCut, NothingAcknowledgedIsLostAndNothingTornApart) {
  const auto toll = toll_of(through_the_writer, kRuns);
  RecordProperty("cuts", toll.cuts);
  EXPECT_GE(toll.cuts, 900);
  EXPECT_EQ(toll.lost, 0);
  EXPECT_EQ(toll.damaged, 0);
  EXPECT_EQ(toll.separated, 0);
  EXPECT_EQ(toll.lost_scores, 0);
  EXPECT_EQ(toll.miscounted, 0);
  EXPECT_GT(toll.rollups, 1000);
}

TEST(PowerCut, WithoutSyncedCommitsIncidentsWouldBeLost) {
  const auto toll = toll_of(without_syncing_commits, 2);
  RecordProperty("cuts", toll.cuts);
  RecordProperty("lost", toll.lost);
  EXPECT_GT(toll.lost, 10);  // or the test above proves nothing
  EXPECT_EQ(toll.separated, 0);
}

}  // namespace
}  // namespace kidnapwatch::storage
