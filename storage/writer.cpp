// SPDX-License-Identifier: Apache-2.0
// The queue and the thread behind Writer.
#include "storage/writer.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "storage/batch.hpp"
#include "storage/crash_mark.hpp"
#include "storage/file_lock.hpp"
#include "storage/journal.hpp"
#include "storage/retention.hpp"
#include "storage/sqlite.hpp"
#include "storage/upkeep.hpp"

namespace kidnapwatch::storage {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kFirstPause{50};
constexpr std::size_t kMaxWaitingEvidence = 1000;  // pairs of scans, about 10 kB each
constexpr std::chrono::minutes kSlack{10};         // between two clocks that run as they should

/// FULL: with NORMAL a power cut loses what was acknowledged since the last checkpoint (1,204 of
/// 21,663 rows in a test), with FULL none.
Database open_for_writing(const std::filesystem::path& file) {
  Database database(file, Access::read_write);
  database.execute(
      "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA secure_delete = OFF;"
      "PRAGMA journal_size_limit = 67108864; PRAGMA cache_size = -16000");
  return database;
}

template <typename T>
void move_behind(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  from.clear();
}

void write(Journal& journal, const IncidentChange& change) { journal.put(change); }

void write(Journal& journal, const AuditEntry& entry) { journal.add(entry); }

void write(Journal& journal, const Gap& gap) { journal.add(gap); }

void write(Journal& journal, const Delivery& delivery) { journal.confirm(delivery.event_id); }

void write(Journal& journal, Awaited& awaited) {
  awaited.refusal = nullptr;
  if (!awaited.config) return;
  try {
    journal.add(*awaited.config);
  } catch (const StorageError& error) {
    if (!error.is_constraint()) throw;
    awaited.refusal = std::current_exception();
  }
}

void answer(Awaited& awaited, const std::exception_ptr& failure) {
  const auto& error = failure ? failure : awaited.refusal;
  error ? awaited.done.set_exception(error) : awaited.done.set_value();
}

/// Those that are tried again after a failure.
std::size_t kept_commands(const Batch& batch) {
  return static_cast<std::size_t>(std::ranges::count_if(
      batch.commands, [](const auto& each) { return !std::holds_alternative<Awaited>(each); }));
}

/// Tells all who wait, and forgets them.
void answer_all(Batch& batch, const std::exception_ptr& failure) {
  std::erase_if(batch.commands, [&](Command& command) {
    auto* awaited = std::get_if<Awaited>(&command);
    if (awaited != nullptr) answer(*awaited, failure);
    return awaited != nullptr;
  });
}

}  // namespace

class Writer::Thread {
 public:
  explicit Thread(const WriterConfig& config)
      : config_(config),
        lock_(config.file),
        quarantined_(prepare_store(config.file)),
        database_(open_for_writing(config.file)),
        segments_(database_, config.segments),
        journal_(database_),
        retention_(database_, config.retention),
        crash_mark_(database_),
        thread_([this] { run(); }) {}

  ~Thread() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;

  bool add(ScoreRow row) {
    {
      const std::lock_guard lock(mutex_);
      if (queue_.scores.size() + writing_ >= config_.max_queued) {
        lose(row.arrival);
        return false;
      }
      queue_.scores.push_back(std::move(row));
      if (queue_.scores.size() != 1 && queue_.scores.size() != crowded()) return true;
    }
    changed_.notify_all();
    return true;
  }

  void put_learned(const std::string& robot, std::vector<float> numbers) {
    {
      const std::lock_guard lock(mutex_);
      queue_.learned[robot] = std::move(numbers);
    }
    changed_.notify_all();
  }

  void add(Command command) {
    {
      const std::lock_guard lock(mutex_);
      const std::size_t waiting = queue_.commands.size() + writing_commands_;
      if (waiting >= config_.max_changes && !std::holds_alternative<Awaited>(command)) {
        refuse(command);
        return;
      }
      auto* change = std::get_if<IncidentChange>(&command);
      if (change != nullptr && waiting >= kMaxWaitingEvidence) change->evidence.reset();
      queue_.commands.push_back(std::move(command));
    }
    changed_.notify_all();
  }

  [[nodiscard]] std::uint64_t queued() const {
    const std::lock_guard lock(mutex_);
    return queue_.scores.size() + writing_;
  }

  [[nodiscard]] std::uint64_t lost() const { return lost_; }

  [[nodiscard]] std::string problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
  }

  [[nodiscard]] const std::optional<std::filesystem::path>& quarantined() const {
    return quarantined_;
  }

  [[nodiscard]] std::shared_ptr<const RecentScores> recent() const { return segments_.recent(); }

  [[nodiscard]] core::Durations commits() const {
    const std::lock_guard lock(mutex_);
    return commits_;
  }

 private:
  void lose(core::Stamp arrival) {
    ++lost_;
    if (!losing_) losing_ = Gap{.since = arrival, .until = {}, .reason = "overload", .scores = 0};
    losing_->until = arrival;
    ++*losing_->scores;
  }

  void refuse(const Command& command) {
    const auto* change = std::get_if<IncidentChange>(&command);
    const auto* entry = std::get_if<AuditEntry>(&command);
    if (change == nullptr && entry == nullptr) return;  // it will be delivered again
    ++lost_;
    ++refused_;
    refused_at_ = change != nullptr ? change->changed_at : entry->at;
  }

  /// What was lost since the last batch, for the record.
  void confess(Batch& batch) {
    if (losing_) batch.commands.emplace_back(*std::exchange(losing_, std::nullopt));
    if (refused_ == 0) return;
    batch.commands.emplace_back(AuditEntry{
        .at = refused_at_,
        .actor = "kidnapwatch",
        .action = "store.refused",
        .subject = "incidents",
        .detail = std::to_string(std::exchange(refused_, 0)) + " records, the last one then"});
  }

  /// So many scores are not kept waiting.
  [[nodiscard]] std::size_t crowded() const { return config_.max_queued / 2 + 1; }

  void run() {
    Batch batch;
    while (await_work(batch)) {
      if (!try_to_write(batch) && is_stopping()) return;  // with the mark set: some may be missing
    }
    try {
      crash_mark_.clear();
    } catch (const StorageError&) {  // then a gap is told where none is
    }
  }

  /// Adds what is due to the batch, which is empty unless it has to be tried again. False: stopped,
  /// and nothing is left to write.
  bool await_work(Batch& batch) {
    std::unique_lock lock(mutex_);
    const bool is_new = batch.empty();
    if (!is_new || (has_chores() && !problem_.empty())) {
      changed_.wait_for(lock, pause_, [this] { return is_urgent(); });
    } else {
      changed_.wait(lock, [this] { return is_due(); });
      changed_.wait_for(lock, config_.commit_every, [this] { return is_urgent(); });
    }
    move_behind(batch.scores, queue_.scores);
    move_behind(batch.commands, queue_.commands);
    queue_.learned.merge(batch.learned);  // what is newer stays
    batch.learned = std::exchange(queue_.learned, {});
    if (is_new) confess(batch);
    writing_ = batch.scores.size();
    writing_commands_ = batch.commands.size();
    return !batch.empty() || !stopping_;
  }

  [[nodiscard]] bool is_due() const { return stopping_ || !queue_.empty() || has_chores(); }

  [[nodiscard]] bool has_chores() const {
    return segments_.is_packing() || retention_.is_cleaning();
  }

  [[nodiscard]] bool is_urgent() const {
    return stopping_ || !queue_.commands.empty() || queue_.scores.size() >= crowded();
  }

  [[nodiscard]] bool is_stopping() const {
    const std::lock_guard lock(mutex_);
    return stopping_;
  }

  /// Empties the batch, but for what has to be tried again; nobody waits any longer for either.
  bool try_to_write(Batch& batch) {
    std::exception_ptr failure;
    std::string problem;
    const auto begin = Clock::now();
    try {
      write(batch);
      const std::chrono::duration<double> took = Clock::now() - begin;
      const std::lock_guard lock(mutex_);
      commits_.add(took.count());
    } catch (const StorageError& error) {
      segments_.undone();
      crash_mark_.undone();
      retention_.undone();
      if (error.is_full()) retention_.begin(age_base());
      failure = std::current_exception();
      problem = error.what();
    }
    if (!failure) batch.scores.clear();
    conclude(batch.scores.size(), failure ? kept_commands(batch) : 0, problem);
    answer_all(batch, failure);
    if (!failure) batch.commands.clear();
    if (!failure) batch.learned.clear();
    return !failure;
  }

  void write(Batch& batch) {
    const bool was_packing = segments_.is_packing();
    Transaction transaction(database_, Transaction::Kind::write);
    if (retention_.is_cleaning()) retention_.clean_some();  // first: it makes room for the rest
    if (!batch.scores.empty()) crash_mark_.set(batch.scores.front().arrival);
    segments_.write(batch.scores);
    for (const auto& [robot, numbers] : batch.learned) journal_.put_learned(robot, numbers);
    for (Command& command : batch.commands) {
      std::visit([this](auto& change) { storage::write(journal_, change); }, command);
    }
    transaction.commit();
    segments_.committed();
    crash_mark_.committed();
    if (!batch.scores.empty()) note_arrivals(batch.scores);
    if (was_packing && !segments_.is_packing()) retention_.begin(age_base());
  }

  void note_arrivals(std::span<const ScoreRow> rows) {
    if (!first_arrival_) {
      first_arrival_ = rows.front().arrival;
      first_committed_ = Clock::now();
    }
    latest_arrival_ = std::max(latest_arrival_, rows.back().arrival);
  }

  /// The time that age counts from: a clock that jumps ahead deletes nothing before its time.
  [[nodiscard]] core::Stamp age_base() const {
    if (!first_arrival_) return {};
    return std::min(latest_arrival_, *first_arrival_ + (Clock::now() - first_committed_) + kSlack);
  }

  void conclude(std::size_t scores_left, std::size_t commands_left, const std::string& problem) {
    const std::lock_guard lock(mutex_);
    writing_ = scores_left;
    writing_commands_ = commands_left;
    problem_ = problem;
    pause_ = problem.empty() ? kFirstPause : std::min(2 * pause_, config_.retry_max);
  }

  const WriterConfig config_;
  const FileLock lock_;
  const std::optional<std::filesystem::path> quarantined_;
  Database database_;  // this and what follows: the thread's own
  Segments segments_;
  Journal journal_;
  Retention retention_;
  CrashMark crash_mark_;
  std::optional<core::Stamp> first_arrival_;
  Clock::time_point first_committed_;
  core::Stamp latest_arrival_{};

  mutable std::mutex mutex_;
  core::Durations commits_;
  std::condition_variable changed_;
  Batch queue_;
  std::size_t writing_ = 0;  // scores taken from the queue and not yet durable
  std::size_t writing_commands_ = 0;
  bool stopping_ = false;
  std::optional<Gap> losing_;  // refused scores that the store does not know of yet
  std::uint64_t refused_ = 0;  // changes and entries that it does not know of
  core::Stamp refused_at_;     // the latest of them
  std::string problem_;
  std::chrono::milliseconds pause_{kFirstPause};
  std::atomic<std::uint64_t> lost_ = 0;

  std::thread thread_;  // last: it uses all of the above
};

Writer::Writer(const WriterConfig& config) : thread_(std::make_unique<Thread>(config)) {}

Writer::~Writer() = default;

bool Writer::add_score(const std::string& robot, const core::Score& score, core::Stamp arrival) {
  return thread_->add(ScoreRow{robot, as_stored(score), arrival});
}

void Writer::put_incident(IncidentChange change) { thread_->add(Command(std::move(change))); }

void Writer::put_learned(const std::string& robot, std::vector<float> numbers) {
  thread_->put_learned(robot, std::move(numbers));
}

void Writer::confirm_delivery(std::string event_id) {
  thread_->add(Command(Delivery{std::move(event_id)}));
}

void Writer::add_audit(AuditEntry entry) { thread_->add(Command(std::move(entry))); }

std::future<void> Writer::add_config(ConfigText config) {
  Awaited awaited{.config = std::move(config), .done = {}};
  auto done = awaited.done.get_future();
  thread_->add(Command(std::move(awaited)));
  return done;
}

std::future<void> Writer::flush() {
  Awaited awaited;
  auto done = awaited.done.get_future();
  thread_->add(Command(std::move(awaited)));
  return done;
}

std::uint64_t Writer::queued() const { return thread_->queued(); }

std::uint64_t Writer::lost() const { return thread_->lost(); }

core::Durations Writer::commits() const { return thread_->commits(); }

bool Writer::healthy() const { return thread_->problem().empty(); }

std::string Writer::problem() const { return thread_->problem(); }

const std::optional<std::filesystem::path>& Writer::quarantined() const {
  return thread_->quarantined();
}

std::shared_ptr<const RecentScores> Writer::recent() const { return thread_->recent(); }

}  // namespace kidnapwatch::storage
