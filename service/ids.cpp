// SPDX-License-Identifier: Apache-2.0
// UUIDv7: 48 bits of milliseconds, a 12-bit counter, 62 random bits. RFC 9562, section 5.7.
#include "service/ids.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

namespace kidnapwatch::service {

std::uint64_t random_seed() {
  std::random_device device;
  return (std::uint64_t{device()} << 32U) | device();
}

std::string Ids::next(core::Stamp now) {
  const std::lock_guard lock(mutex_);
  const auto since_epoch = std::chrono::floor<std::chrono::milliseconds>(now).time_since_epoch();
  const auto ms = static_cast<std::uint64_t>(std::max<std::int64_t>(0, since_epoch.count()));
  last_tick_ = std::max(last_tick_ + 1, ms << 12U);
  const std::uint64_t tick_ms = last_tick_ >> 12U;
  const std::uint64_t counter = last_tick_ & 0xfffU;
  const std::uint64_t noise = random_();
  std::array<char, 37> text{};
  std::snprintf(text.data(), text.size(), "%08x-%04x-7%03x-%04x-%012llx",
                static_cast<unsigned>(tick_ms >> 16U), static_cast<unsigned>(tick_ms & 0xffffU),
                static_cast<unsigned>(counter), static_cast<unsigned>(0x8000U | (noise >> 50U)),
                static_cast<unsigned long long>(noise & 0xffff'ffff'ffffU));
  return text.data();
}

}  // namespace kidnapwatch::service
