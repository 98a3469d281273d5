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
#include <variant>
#include <vector>

#include "storage/journal.hpp"
#include "storage/sqlite.hpp"
#include "storage/upkeep.hpp"

namespace kidnapwatch::storage {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kFirstPause{50};

/// Something that somebody waits for.
struct Awaited {
  std::optional<ConfigText> config;  // nothing: a flush
  std::promise<void> done;
  std::exception_ptr refusal = nullptr;  // by the schema
};

using Command = std::variant<IncidentChange, Awaited>;

/// What one transaction writes.
struct Batch {
  std::vector<ScoreRow> scores;
  std::vector<Command> commands;

  [[nodiscard]] bool empty() const { return scores.empty() && commands.empty(); }
};

template <typename T>
void move_behind(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  from.clear();
}

void write(Journal& journal, const IncidentChange& change) { journal.put(change); }

void write(Journal& journal, Awaited& awaited) {
  awaited.refusal = nullptr;
  if (!awaited.config) return;
  try {
    journal.append(*awaited.config);
  } catch (const StorageError& error) {
    if (!error.is_constraint()) throw;
    awaited.refusal = std::current_exception();
  }
}

void write(Journal& journal, Batch& batch) {
  Transaction transaction = journal.begin();
  for (const ScoreRow& row : batch.scores) journal.append(row);
  for (Command& command : batch.commands) {
    std::visit([&](auto& change) { write(journal, change); }, command);
  }
  transaction.commit();
}

void answer(Awaited& awaited, const std::exception_ptr& failure) {
  const auto& error = failure ? failure : awaited.refusal;
  error ? awaited.done.set_exception(error) : awaited.done.set_value();
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
        quarantined_(prepare_store(config.file)),
        journal_(config.file),
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
        ++lost_;
        return false;
      }
      queue_.scores.push_back(std::move(row));
      if (queue_.scores.size() != 1 && queue_.scores.size() != crowded()) return true;
    }
    changed_.notify_all();
    return true;
  }

  void add(Command command) {
    {
      const std::lock_guard lock(mutex_);
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

 private:
  /// So many scores are not kept waiting.
  [[nodiscard]] std::size_t crowded() const { return config_.max_queued / 2 + 1; }

  void run() {
    Batch batch;
    while (await_work(batch)) {
      if (!try_to_write(batch) && is_stopping()) return;
    }
  }

  /// Adds what is due to the batch, which is empty unless it has to be tried again. False: stopped,
  /// and nothing is left to write.
  bool await_work(Batch& batch) {
    std::unique_lock lock(mutex_);
    if (batch.empty()) {
      changed_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
      changed_.wait_for(lock, config_.commit_every, [this] { return is_urgent(); });
    } else {
      changed_.wait_for(lock, pause_, [this] { return is_urgent(); });
    }
    move_behind(batch.scores, queue_.scores);
    move_behind(batch.commands, queue_.commands);
    writing_ = batch.scores.size();
    return !batch.empty();
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
    try {
      write(journal_, batch);
    } catch (const StorageError& error) {
      journal_.forget_uncommitted();
      failure = std::current_exception();
      problem = error.what();
    }
    if (!failure) batch.scores.clear();
    conclude(batch.scores.size(), problem);
    answer_all(batch, failure);
    if (!failure) batch.commands.clear();
    return !failure;
  }

  void conclude(std::size_t scores_left, const std::string& problem) {
    const std::lock_guard lock(mutex_);
    writing_ = scores_left;
    problem_ = problem;
    pause_ = problem.empty() ? kFirstPause : std::min(2 * pause_, config_.retry_max);
  }

  const WriterConfig config_;
  const std::optional<std::filesystem::path> quarantined_;
  Journal journal_;  // the thread's own

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Batch queue_;
  std::size_t writing_ = 0;  // scores taken from the queue and not yet durable
  bool stopping_ = false;
  std::string problem_;
  std::chrono::milliseconds pause_{kFirstPause};
  std::atomic<std::uint64_t> lost_ = 0;

  std::thread thread_;  // last: it uses all of the above
};

Writer::Writer(const WriterConfig& config) : thread_(std::make_unique<Thread>(config)) {}

Writer::~Writer() = default;

bool Writer::add_score(const std::string& robot, const core::Score& score, core::Stamp arrival) {
  return thread_->add(ScoreRow{robot, score, arrival});
}

void Writer::put_incident(IncidentChange change) { thread_->add(Command(std::move(change))); }

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

bool Writer::healthy() const { return thread_->problem().empty(); }

std::string Writer::problem() const { return thread_->problem(); }

const std::optional<std::filesystem::path>& Writer::quarantined() const {
  return thread_->quarantined();
}

}  // namespace kidnapwatch::storage
