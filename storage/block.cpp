// SPDX-License-Identifier: Apache-2.0
// The columns of a block of scores, one after the other.
#include "storage/block.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "storage/bytes.hpp"
#include "storage/compression.hpp"
#include "storage/rows.hpp"
#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {
namespace {

using core::ns_since_epoch;
using core::Score;
using Scores = std::span<const Score>;

constexpr std::uint8_t kFormat = 1;
constexpr std::size_t kMaxScores = 1'000'000;
constexpr std::size_t kMaxBytesPerScore = 128;
constexpr double kMaxDivisor = 1'000'000;  // of a cost, in beams
constexpr auto kLastState = static_cast<unsigned>(core::RobotState::stale);

// Flags of a score.
constexpr unsigned kState = 7;  // three bits
constexpr unsigned kStandardized = 1U << 3;
constexpr unsigned kHasThreshold = 1U << 4;
constexpr unsigned kNewThreshold = 1U << 5;  // than the latest before it
constexpr unsigned kOwnReference = 1U << 6;  // not the score before it

// --- costs: the upper three bytes of a float

std::uint32_t short_bits(double value) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  return (bits + 0x80) & ~0xffU;
}

double from_short_bits(std::uint32_t bits) { return std::bit_cast<float>(bits); }

/// The n + m by which cost was divided to give cost_per_beam; nothing if that is no whole number.
std::optional<double> divisor(const core::Dissimilarity& d, double tolerance) {
  const double ratio = std::nearbyint(d.cost / d.cost_per_beam);
  const bool is_whole =
      ratio >= 1 && ratio <= kMaxDivisor &&
      std::abs(d.cost / ratio - d.cost_per_beam) <= tolerance * std::abs(d.cost_per_beam);
  return is_whole ? std::optional(ratio) : std::nullopt;
}

// --- one function a column to write, one to read it

// Differences wrap around, and so do their sums.
std::int64_t difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

std::int64_t difference(core::Stamp a, core::Stamp b) {
  return difference(ns_since_epoch(a), ns_since_epoch(b));
}

core::Stamp moved(core::Stamp stamp, std::uint64_t by) {
  return core::stamp_from_ns(
      static_cast<std::int64_t>(static_cast<std::uint64_t>(ns_since_epoch(stamp)) + by));
}

/// The largest power of ten, up to a second, that divides all differences of consecutive stamps.
std::int64_t common_unit(Scores scores) {
  std::int64_t unit = 1'000'000'000;
  for (std::size_t i = 1; i < scores.size(); ++i) {
    while (difference(scores[i].stamp, scores[i - 1].stamp) % unit != 0) unit /= 10;
  }
  return unit;
}

/// In units, each from the stamp before.
std::vector<std::int64_t> steps(Scores scores, std::int64_t unit) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < scores.size(); ++i) {
    steps.push_back(difference(scores[i].stamp, scores[i - 1].stamp) / unit);
  }
  return steps;
}

std::int64_t median(std::vector<std::int64_t> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// A lidar turns evenly: what differs from the usual step is small.
void put_stamps(ByteWriter& out, Scores scores) {
  const auto unit = common_unit(scores);
  const auto all_steps = steps(scores, unit);
  const auto usual = median(all_steps);
  out.put(ns_since_epoch(scores.front().stamp));
  out.put_signed_varint(unit);
  out.put_signed_varint(usual);
  for (const auto step : all_steps) out.put_signed_varint(difference(step, usual));
}

void get_stamps(ByteReader& in, std::span<Score> scores) {
  scores.front().stamp = core::stamp_from_ns(in.get<std::int64_t>());
  const auto unit = in.get_signed_varint();
  const auto usual = in.get_signed_varint();
  for (std::size_t i = 1; i < scores.size(); ++i) {
    scores[i].stamp = moved(scores[i - 1].stamp, (usual + in.get_signed_varint()) * unit);
  }
}

bool has_own_reference(Scores scores, std::size_t i) {
  return i == 0 || scores[i].reference != scores[i - 1].stamp;
}

void put_flags(ByteWriter& out, Scores scores) {
  std::optional<double> threshold;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Score& score = scores[i];
    const bool is_new = score.threshold && score.threshold != threshold;
    if (is_new) threshold = score.threshold;
    out.put(static_cast<std::uint8_t>((static_cast<unsigned>(score.state) & kState) |
                                      (score.dissimilarity.standardized ? kStandardized : 0) |
                                      (score.threshold ? kHasThreshold : 0) |
                                      (is_new ? kNewThreshold : 0) |
                                      (has_own_reference(scores, i) ? kOwnReference : 0)));
  }
}

void put_references(ByteWriter& out, Scores scores) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (has_own_reference(scores, i)) {
      out.put_signed_varint(difference(scores[i].reference, scores[i].stamp));
    }
  }
}

void get_references(ByteReader& in, std::span<const std::byte> flags, std::span<Score> scores) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const bool is_own = i == 0 || (std::to_integer<unsigned>(flags[i]) & kOwnReference) != 0;
    scores[i].reference =
        is_own ? moved(scores[i].stamp, in.get_signed_varint()) : scores[i - 1].stamp;
  }
}

void put_thresholds(ByteWriter& out, Scores scores) {
  std::optional<double> threshold;
  for (const Score& score : scores) {
    if (!score.threshold || score.threshold == threshold) continue;
    threshold = score.threshold;
    out.put(*threshold);
  }
}

void get_thresholds(ByteReader& in, std::span<const std::byte> flags, std::span<Score> scores) {
  double threshold = 0.0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const auto flag = std::to_integer<unsigned>(flags[i]);
    if ((flag & kNewThreshold) != 0) threshold = in.get<double>();
    if ((flag & kHasThreshold) != 0) scores[i].threshold = threshold;
  }
}

/// Byte by byte: the sign and exponents of all, which hardly differ, compress next to each other.
template <typename Value>
void put_planes(ByteWriter& out, Scores scores, const Value& value) {
  for (const unsigned shift : {24U, 16U, 8U}) {
    for (const Score& score : scores) {
      out.put(static_cast<std::uint8_t>(short_bits(value(score)) >> shift));
    }
  }
}

template <typename Set>
void get_planes(ByteReader& in, std::span<Score> scores, Set set) {
  const std::array planes{in.take(scores.size()), in.take(scores.size()), in.take(scores.size())};
  for (std::size_t i = 0; i < scores.size(); ++i) {
    std::uint32_t bits = 0;
    for (const auto& plane : planes) bits = (bits | std::to_integer<std::uint32_t>(plane[i])) << 8;
    set(scores[i], from_short_bits(bits));
  }
}

void put_costs(ByteWriter& out, Scores scores) {
  put_planes(out, scores, [](const Score& score) { return score.dissimilarity.cost; });
}

void get_costs(ByteReader& in, std::span<Score> scores) {
  get_planes(in, scores, [](Score& score, double cost) { score.dissimilarity.cost = cost; });
}

/// What the cost was divided by, or 0 followed by the quotient.
void put_beams(ByteWriter& out, Scores scores) {
  std::int64_t previous = 0;
  for (const Score& score : scores) {
    const auto beams = static_cast<std::int64_t>(divisor(score.dissimilarity, 0.0).value_or(0));
    out.put_signed_varint(beams - previous);
    if (beams == 0) out.put(short_bits(score.dissimilarity.cost_per_beam));
    previous = beams;
  }
}

void get_beams(ByteReader& in, std::span<Score> scores) {
  std::uint64_t beams = 0;
  for (Score& score : scores) {
    auto& d = score.dissimilarity;
    beams += in.get_signed_varint();
    d.cost_per_beam =
        beams == 0 ? from_short_bits(in.get<std::uint32_t>()) : d.cost / static_cast<double>(beams);
  }
}

/// What `detector` said of the score's scan.
std::optional<float> other(const Score& score, core::DetectorId detector) {
  const auto found = std::ranges::find(score.others, detector, &core::DetectorScore::detector);
  return found == score.others.end() ? std::nullopt : std::optional(found->score);
}

/// Whose scores there are; of each of these which scans it had an opinion of, and which.
void put_others(ByteWriter& out, Scores scores) {
  std::set<core::DetectorId> detectors;
  for (const Score& score : scores) {
    for (const auto& one : score.others) detectors.insert(one.detector);
  }
  out.put(static_cast<std::uint8_t>(detectors.size()));
  for (const auto detector : detectors) {
    out.put(detector);
    for (const Score& score : scores) out.put(other(score, detector).has_value());
    put_planes(out, scores, [&](const Score& one) { return other(one, detector).value_or(0.0F); });
  }
}

void get_others(ByteReader& in, std::span<Score> scores) {
  for (int left = in.get<std::uint8_t>(); left > 0; --left) {
    const auto detector = known_detector(in.get<std::uint8_t>());
    const auto present = in.take(scores.size());
    get_planes(in, scores, [&, i = std::size_t{0}](Score& score, double value) mutable {
      if (present[i++] != std::byte{}) {
        score.others.push_back({detector, static_cast<float>(value)});
      }
    });
  }
}

constexpr std::array kMotionParts{&core::MotionScore::score, &core::MotionScore::carry};
constexpr std::array kMotionOptions{&core::MotionScore::confirmed, &core::MotionScore::threshold};

/// A byte for each score that says which parts there are, then the parts.
void put_motion(ByteWriter& out, Scores scores) {
  for (const Score& score : scores) out.put(motion_flags(score.motion));
  for (const auto part : kMotionParts) {
    put_planes(out, scores,
               [&](const Score& one) { return one.motion ? (*one.motion).*part : 0.0; });
  }
  for (const auto part : kMotionOptions) {
    put_planes(out, scores, [&](const Score& one) {
      return one.motion ? ((*one.motion).*part).value_or(0.0) : 0.0;
    });
  }
}

void get_motion(ByteReader& in, std::span<Score> scores) {
  const auto flags = in.take(scores.size());
  for (std::size_t i = 0; i < scores.size(); ++i) {
    scores[i].motion = motion_with(std::to_integer<std::uint8_t>(flags[i]));
  }
  for (const auto part : kMotionParts) {
    get_planes(in, scores, [&](Score& one, double value) {
      if (one.motion) (*one.motion).*part = value;
    });
  }
  for (const auto part : kMotionOptions) {
    get_planes(in, scores, [&](Score& one, double value) {
      if (one.motion && (*one.motion).*part) (*one.motion).*part = value;
    });
  }
}

[[noreturn]] void refuse(const char* reason) {
  throw StorageError::damage(std::string("a block of scores ") + reason);
}

}  // namespace

Score as_stored(Score score) {
  auto& d = score.dissimilarity;
  const auto beams = divisor(d, 1e-9);
  d.cost = from_short_bits(short_bits(d.cost));
  d.cost_per_beam = beams ? d.cost / *beams : from_short_bits(short_bits(d.cost_per_beam));
  for (auto& one : score.others) {
    one.score = static_cast<float>(from_short_bits(short_bits(one.score)));
  }
  if (score.motion) {
    const auto shorten = [](double& value) { value = from_short_bits(short_bits(value)); };
    for (const auto part : kMotionParts) shorten((*score.motion).*part);
    for (const auto part : kMotionOptions) {
      if (auto& value = (*score.motion).*part) shorten(*value);
    }
  }
  return score;
}

std::vector<std::byte> packed(Scores scores) {
  ByteWriter out;
  out.put(kFormat);
  out.put_varint(scores.size());
  if (!scores.empty()) {
    put_flags(out, scores);
    put_stamps(out, scores);
    put_references(out, scores);
    put_thresholds(out, scores);
    put_costs(out, scores);
    put_beams(out, scores);
    put_others(out, scores);
    put_motion(out, scores);
  }
  return compressed(out.bytes());
}

std::vector<Score> unpacked(std::span<const std::byte> data) {
  const auto bytes = decompressed(data, kMaxScores * kMaxBytesPerScore);
  ByteReader in(bytes);
  if (in.get<std::uint8_t>() != kFormat) refuse("has an unknown format");
  const auto count = in.get_varint();
  if (count > kMaxScores) refuse("is too long");
  std::vector<Score> scores(count);
  if (scores.empty()) return scores;
  const auto flags = in.take(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto flag = std::to_integer<unsigned>(flags[i]);
    scores[i].state = static_cast<core::RobotState>(std::min(flag & kState, kLastState));
    scores[i].dissimilarity.standardized = (flag & kStandardized) != 0;
  }
  get_stamps(in, scores);
  get_references(in, flags, scores);
  get_thresholds(in, flags, scores);
  get_costs(in, scores);
  get_beams(in, scores);
  get_others(in, scores);
  get_motion(in, scores);
  return scores;
}

std::vector<Block> blocks(std::span<const ArrivedScore> scores) {
  std::vector<Block> blocks;
  std::vector<Score> gathered;
  const auto finish = [&](core::Stamp arrival) {
    blocks.push_back({.first = gathered.front().stamp,
                      .last = gathered.back().stamp,
                      .arrival = arrival,
                      .scores = gathered.size(),
                      .data = packed(gathered)});
    gathered.clear();
  };
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const auto stamp = scores[i].score.stamp;
    const bool fits = gathered.empty() || (stamp > gathered.back().stamp &&
                                           stamp - gathered.front().stamp <= kMaxBlockSpan);
    if (!fits) finish(scores[i - 1].arrival);
    gathered.push_back(scores[i].score);
  }
  if (!gathered.empty()) finish(scores.back().arrival);
  return blocks;
}

}  // namespace kidnapwatch::storage
