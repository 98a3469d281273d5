// SPDX-License-Identifier: Apache-2.0
// The columns of a run of buckets, one after the other.
#include "storage/rollup.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

#include "storage/bytes.hpp"
#include "storage/compression.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {
namespace {

using core::Int128;
using core::ScoreBucket;
using core::Spread;
using Buckets = std::span<const ScoreBucket>;

constexpr std::uint8_t kFormat = 1;
constexpr std::size_t kMaxRun = 60;  // buckets
constexpr std::size_t kMaxBytesPerBucket = 256;
constexpr auto kLastState = static_cast<unsigned>(core::RobotState::stale);

// Flags of a bucket.
constexpr unsigned kState = 7;  // three bits
constexpr unsigned kHasThreshold = 1U << 3;
constexpr unsigned kHasMotionThreshold = 1U << 4;

constexpr std::array kSpreads{&ScoreBucket::cost, &ScoreBucket::cost_per_beam, &ScoreBucket::motion,
                              &ScoreBucket::confirmed, &ScoreBucket::carry};
constexpr std::array kEnds{&Spread::min, &Spread::max};

/// Byte by byte, lowest first: bytes that are alike compress next to each other.
template <typename Value>
void put_planes(ByteWriter& out, Buckets buckets, const Value& value) {
  for (std::size_t i = 0; i < sizeof(value(buckets.front())); ++i) {
    for (const auto& bucket : buckets) {
      const auto number = value(bucket);
      out.put(std::as_bytes(std::span(&number, 1))[i]);
    }
  }
}

template <typename Number, typename Set>
void get_planes(ByteReader& in, std::span<ScoreBucket> buckets, Set set) {
  const auto bytes = in.take(sizeof(Number) * buckets.size());
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    std::array<std::byte, sizeof(Number)> of_one{};
    for (std::size_t plane = 0; plane < of_one.size(); ++plane) {
      of_one.at(plane) = bytes[plane * buckets.size() + i];
    }
    set(buckets[i], std::bit_cast<Number>(of_one));
  }
}

/// How many widths each begins after the one before.
void put_begins(ByteWriter& out, Buckets buckets, const RollupLevel& level) {
  auto previous = buckets.front().from;
  out.put(core::ns_since_epoch(previous));
  for (const auto& bucket : buckets) {
    out.put_varint(static_cast<std::uint64_t>((bucket.from - previous) / level.width));
    previous = bucket.from;
  }
}

void get_begins(ByteReader& in, std::span<ScoreBucket> buckets, const RollupLevel& level) {
  const ScoreBucket run{.from = core::stamp_from_ns(in.get<std::int64_t>()), .width = level.span};
  for (std::uint64_t i = 0; auto& bucket : buckets) {
    i += std::min<std::uint64_t>(in.get_varint(), kMaxRun);
    bucket.width = level.width;
    bucket.from = ScoreBucket{.from = run.from, .width = i * level.width}.end();
    if (!run.holds(bucket.from)) throw StorageError::damage("a rollup is too long");
  }
}

void put_counts(ByteWriter& out, Buckets buckets) {
  for (const auto& bucket : buckets) {
    out.put_varint(bucket.scores);
    for (const auto spread : kSpreads) out.put_varint(bucket.scores - (bucket.*spread).count);
  }
}

void get_counts(ByteReader& in, std::span<ScoreBucket> buckets) {
  for (auto& bucket : buckets) {
    bucket.scores = in.get_varint();
    for (const auto spread : kSpreads) (bucket.*spread).count = bucket.scores - in.get_varint();
  }
}

void put_flags(ByteWriter& out, Buckets buckets) {
  for (const auto& bucket : buckets) {
    out.put(static_cast<std::uint8_t>((static_cast<unsigned>(bucket.state) & kState) |
                                      (bucket.threshold ? kHasThreshold : 0) |
                                      (bucket.motion_threshold ? kHasMotionThreshold : 0)));
  }
}

void get_flags(ByteReader& in, std::span<ScoreBucket> buckets) {
  for (auto& bucket : buckets) {
    const unsigned flags = in.get<std::uint8_t>();
    bucket.state = static_cast<core::RobotState>(std::min(flags & kState, kLastState));
    if ((flags & kHasThreshold) != 0) bucket.threshold = 0.0;
    if ((flags & kHasMotionThreshold) != 0) bucket.motion_threshold = 0.0;
  }
}

constexpr std::array kThresholds{&ScoreBucket::threshold, &ScoreBucket::motion_threshold};

void put_numbers(ByteWriter& out, Buckets buckets) {
  for (const auto spread : kSpreads) {
    for (const auto end : kEnds) {
      put_planes(out, buckets, [&](const ScoreBucket& one) { return (one.*spread).*end; });
    }
    put_planes(out, buckets, [&](const ScoreBucket& one) { return (one.*spread).sum; });
  }
  for (const auto threshold : kThresholds) {
    put_planes(out, buckets, [&](const ScoreBucket& one) { return (one.*threshold).value_or(0); });
  }
}

void get_numbers(ByteReader& in, std::span<ScoreBucket> buckets) {
  for (const auto spread : kSpreads) {
    for (const auto end : kEnds) {
      get_planes<float>(in, buckets,
                        [&](ScoreBucket& one, float value) { (one.*spread).*end = value; });
    }
    get_planes<Int128>(in, buckets,
                       [&](ScoreBucket& one, Int128 value) { (one.*spread).sum = value; });
  }
  for (const auto threshold : kThresholds) {
    get_planes<double>(in, buckets, [&](ScoreBucket& one, double value) {
      if (one.*threshold) one.*threshold = value;
    });
  }
}

}  // namespace

std::chrono::seconds nesting(std::chrono::seconds resolution) {
  const auto unit = resolution <= kMinutes.width ? std::chrono::seconds(1)
                    : resolution <= kHours.width ? kMinutes.width
                                                 : kHours.width;
  const auto whole = resolution <= kMinutes.width ? kMinutes.width : kHours.width;
  auto nested = (resolution + unit - std::chrono::seconds(1)) / unit * unit;
  while (nested < whole && whole % nested != std::chrono::seconds(0)) nested += unit;
  return nested;
}

std::vector<std::byte> packed(Buckets buckets, const RollupLevel& level) {
  assert(buckets.size() <= kMaxRun);
  ByteWriter out;
  out.put(kFormat);
  out.put_varint(buckets.size());
  if (!buckets.empty()) {
    put_begins(out, buckets, level);
    put_counts(out, buckets);
    put_flags(out, buckets);
    put_numbers(out, buckets);
  }
  return compressed(out.bytes());
}

std::vector<ScoreBucket> unpacked(std::span<const std::byte> data, const RollupLevel& level) {
  const auto bytes = decompressed(data, (kMaxRun + 1) * kMaxBytesPerBucket);
  ByteReader in(bytes);
  if (in.get<std::uint8_t>() != kFormat) throw StorageError::damage("a rollup's format is unknown");
  const auto count = in.get_varint();
  if (count > kMaxRun) throw StorageError::damage("a rollup is too long");
  std::vector<ScoreBucket> buckets(count);
  if (buckets.empty()) return buckets;
  get_begins(in, buckets, level);
  get_counts(in, buckets);
  get_flags(in, buckets);
  get_numbers(in, buckets);
  return buckets;
}

}  // namespace kidnapwatch::storage
