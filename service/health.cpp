// SPDX-License-Identifier: Apache-2.0
// From signs to words.
#include "service/health.hpp"

#include <cmath>

namespace kidnapwatch::service {
namespace {

constexpr double kJump_s = 2.0;  // NTP slews what is less
constexpr std::chrono::minutes kRememberJump{10};
constexpr std::chrono::seconds kRememberOverload{60};

}  // namespace

std::vector<core::Degradation> Health::look(const Signs& signs) {
  look_at_clock(signs);
  look_at_load(signs);
  before_ = signs;
  std::vector<core::Degradation> wrong;
  if (!signs.broker_connected) wrong.push_back({"broker", "the broker is not connected"});
  if (!signs.store_problem.empty()) {
    wrong.push_back({"store", "the store does not take writes: " + signs.store_problem});
  }
  if (!signs.quarantined.empty()) {
    wrong.push_back({"quarantine", "the store was damaged and a fresh one started; the damaged " +
                                       ("one is " + signs.quarantined)});
  }
  if (clock_) wrong.push_back(*clock_);
  if (overload_) wrong.push_back(*overload_);
  return wrong;
}

/// The wall's clock against the one that only ever goes on.
void Health::look_at_clock(const Signs& signs) {
  if (signs.time >= clock_until_) clock_.reset();
  if (!before_) return;
  const double jump_s = core::elapsed_s(before_->clock, signs.clock) -
                        std::chrono::duration<double>(signs.time - before_->time).count();
  if (std::abs(jump_s) < kJump_s) return;
  clock_ = {"clock", "the clock jumped by " + std::to_string(std::lround(jump_s)) + " s"};
  clock_until_ = signs.time + kRememberJump;
}

void Health::look_at_load(const Signs& signs) {
  if (signs.time >= overload_until_) overload_.reset();
  const auto lost = [](const Signs& at) { return at.dropped + at.lost_writes; };
  if (lost(signs) == (before_ ? lost(*before_) : 0)) return;
  overload_ = {"overload",
               "more came than could be judged or stored: " + std::to_string(signs.dropped) +
                   " scans dropped, " + std::to_string(signs.lost_writes) +
                   " records not stored since the start"};
  overload_until_ = signs.time + kRememberOverload;
}

}  // namespace kidnapwatch::service
