// SPDX-License-Identifier: Apache-2.0
// Threads that take the next piece until none is left.
#include "service/evaluate/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

namespace kidnapwatch::service {
namespace {

using Clock = std::chrono::steady_clock;

/// "trials: 120 of 1200, 4 min left"
class Progress {
 public:
  Progress(std::string_view what, std::size_t count)
      : what_(what), count_(count), shown_(isatty(STDERR_FILENO) == 1) {}
  ~Progress() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void done_one() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (!shown_) return;
    const double spent_s = std::chrono::duration<double>(Clock::now() - start_).count();
    const double left_s =
        spent_s * static_cast<double>(count_ - done_) / static_cast<double>(done_);
    std::fprintf(stderr, "\r\033[K%s: %zu of %zu, %.0f min %02.0f s left", what_.c_str(), done_,
                 count_, std::floor(left_s / 60.0), std::fmod(left_s, 60.0));
  }

 private:
  std::string what_;
  std::size_t count_;
  bool shown_;
  std::mutex mutex_;
  std::size_t done_ = 0;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

void in_parallel(std::size_t count, std::size_t threads, std::string_view what,
                 const std::function<void(std::size_t)>& work) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  Progress progress(what, count);
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto take = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
        progress.done_one();
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::jthread> pool;
  for (std::size_t i = 1; i < std::min(threads, count); ++i) pool.emplace_back(take);
  take();
  pool.clear();  // joins
  if (failure) std::rethrow_exception(failure);
}

}  // namespace kidnapwatch::service
