// SPDX-License-Identifier: Apache-2.0
// The service without its threads: what a simulation drives from one thread, by one seed.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "adapters/codecs/messages.hpp"
#include "service/ids.hpp"
#include "service/outbox.hpp"
#include "service/watch.hpp"
#include "storage/archive.hpp"
#include "storage/crash_mark.hpp"
#include "storage/journal.hpp"
#include "storage/segments.hpp"
#include "storage/upkeep.hpp"

namespace kidnapwatch::service::test {

using core::Stamp;

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : random_(seed) {}
  bool happens(double probability) { return uniform_(random_) < probability; }
  int up_to(int most) { return static_cast<int>(random_() % static_cast<unsigned>(most + 1)); }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
};

/// The broker, the line to it, and who listens behind it.
class Broker {
 public:
  explicit Broker(Chance& chance) : chance_(chance) {}

  void publish(const storage::OutboxMessage& alert, std::function<void()> on_delivered) {
    line_.push_back({alert.event_id, std::move(on_delivered)});
  }
  /// Passes some on. A connection may be lost between a message and its confirmation; then the
  /// message is sent again, or is gone with the session.
  void step() {
    while (up_ && !line_.empty() && chance_.happens(0.5)) {
      ++heard_[line_.front().event_id];
      const bool is_confirmed = chance_.happens(0.8);
      if (!is_confirmed && chance_.happens(0.5)) return;
      const auto message = std::move(line_.front());
      line_.pop_front();
      if (is_confirmed) message.on_delivered();
    }
  }
  void cut() { up_ = false; }
  void restore() { up_ = true; }
  void forget_line() { line_.clear(); }
  [[nodiscard]] bool up() const { return up_; }
  [[nodiscard]] const std::map<std::string, int>& heard() const { return heard_; }

 private:
  struct Message {
    std::string event_id;
    std::function<void()> on_delivered;
  };

  Chance& chance_;
  bool up_ = true;
  std::deque<Message> line_;
  std::map<std::string, int> heard_;
};

/// A real store, written as the Writer does but when the simulation says so.
class Store {
 public:
  explicit Store(const std::filesystem::path& file)
      : database_(opened(file)),
        segments_(database_, {.scores_per_robot = 50}),
        journal_(database_),
        mark_(database_) {}

  void add(storage::ScoreRow row) { scores_.push_back(std::move(row)); }
  void add(storage::IncidentChange change) {
    commands_.emplace_back([change = std::move(change)](auto& journal) { journal.put(change); });
  }
  void confirm(const std::string& event_id) {
    commands_.emplace_back([event_id](auto& journal) { journal.confirm(event_id); });
  }
  /// One transaction; undone and kept for the next time if the disk is full.
  void flush(bool disk_is_full) {
    storage::Transaction transaction(database_, storage::Transaction::Kind::write);
    if (!scores_.empty()) mark_.set(scores_.front().arrival);
    segments_.write(scores_);
    for (const auto& command : commands_) command(journal_);
    if (disk_is_full) {
      segments_.undone();
      mark_.undone();
      return;
    }
    transaction.commit();
    segments_.committed();
    mark_.committed();
    scores_.clear();
    commands_.clear();
  }
  [[nodiscard]] std::size_t waiting_scores() const { return scores_.size(); }

 private:
  static storage::Database opened(const std::filesystem::path& file) {
    storage::prepare_store(file);
    storage::Database database(file, storage::Access::read_write);
    database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = OFF");  // nobody cuts power
    return database;
  }

  storage::Database database_;
  storage::Segments segments_;
  storage::Journal journal_;
  storage::CrashMark mark_;
  std::vector<storage::ScoreRow> scores_;
  std::vector<std::function<void(storage::Journal&)>> commands_;
};

/// What one life of the service is made of.
class Life final : public Announcer {
 public:
  struct Outside {
    Broker& broker;
    const std::filesystem::path& file;
    std::function<Stamp()> now;
    std::function<Stamp()> uptime;
    Ids& ids;
  };

  explicit Life(const Outside& outside)
      : store_(outside.file),
        archive_(outside.file),
        outbox_({.publish = [&broker = outside.broker](
                                const auto& alert,
                                auto done) { broker.publish(alert, std::move(done)); },
                 .confirm = [this](const auto& event_id) { store_.confirm(event_id); },
                 .stored = [this] { return archive_.outbox(); }}),
        around_{.announcer = *this,
                .now = outside.now,
                .uptime = outside.uptime,
                .new_id = [&ids = outside.ids](Stamp at) { return ids.next(at); },
                .config = [](const auto&) { return config(); },
                .log_refusal = [](const auto&, const auto&) {}} {
    std::map<std::string, Past> pasts;
    for (auto& robot : archive_.robots(config()->config.calibration.window_pairs)) {
      pasts[robot.robot].natural_scores = std::move(robot.natural_scores);
    }
    for (const auto& incident : archive_.unresolved_incidents()) {
      pasts[incident.robot].open_incident = incident;
    }
    for (const auto& [robot, past] : pasts) watch(robot).resume(past);
  }

  void take(const std::string& robot, const Message& message) {
    watch(robot).take(message, bench_);
    ++taken_;
  }
  void announce_state(const core::RobotStatus&, Stamp) override {}
  void announce_alert(const core::Alert& alert, std::optional<core::ScanPair> evidence) override {
    const storage::OutboxMessage message{.event_id = alert.event_id,
                                         .robot = alert.incident.robot,
                                         .payload = adapters::codecs::alert_message(alert)};
    store_.add({.incident = alert.incident,
                .evidence = std::move(evidence),
                .alert = message,
                .changed_at = alert.timestamp});
    outbox_.send(message);
  }
  void announce_score(const std::string& robot, const core::Score& score, Stamp arrival) override {
    store_.add({robot, storage::as_stored(score), arrival});
    ++scored_;
  }

  void keep_learned(const std::string&, std::vector<float>) override {}

  [[nodiscard]] Store& store() { return store_; }
  [[nodiscard]] Outbox& outbox() { return outbox_; }
  [[nodiscard]] std::uint64_t scored() const { return scored_; }
  /// Every scan was counted once, and none failed.
  [[nodiscard]] bool is_accounted() const {
    std::uint64_t sum = 0;
    std::uint64_t failed = 0;
    for (const auto& [id, watch] : watches_) {
      const auto& counts = watch->status().counts;
      for (const auto count : counts) sum += count;
      failed += counts.at(static_cast<std::size_t>(core::Outcome::failed));
    }
    return sum == taken_ && failed == 0;
  }

 private:
  static std::shared_ptr<const core::ConfigVersion> config() {
    static const auto kConfig = [] {
      auto version = std::make_shared<core::ConfigVersion>();
      version->config.calibration.warmup_pairs = 60;
      version->config.resolve_after_s = 5.0;
      return version;
    }();
    return kConfig;
  }
  Watch& watch(const std::string& robot) {
    auto& found = watches_[robot];
    if (!found) found = std::make_unique<Watch>(robot, around_);
    return *found;
  }

  Store store_;
  const storage::Archive archive_;
  Outbox outbox_;
  Surroundings around_;
  Bench bench_{{}};
  std::map<std::string, std::unique_ptr<Watch>> watches_;
  std::uint64_t taken_ = 0;
  std::uint64_t scored_ = 0;
};

}  // namespace kidnapwatch::service::test
