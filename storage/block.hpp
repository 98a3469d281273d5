// SPDX-License-Identifier: Apache-2.0
// Scores in few bytes: columns of deltas, compressed with zstd; 3.5-5.5 bytes each.
#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <vector>

#include "core/session.hpp"

namespace kidnapwatch::storage {

/// A score and when its scan arrived, by the service's clock.
struct ArrivedScore {
  core::Score score;
  core::Stamp arrival;
};

/// `score` as exactly as the store keeps it: its costs rounded to 16 significant bits (a relative
/// error of at most 2^-16, 1.5e-5), all else as it is.
[[nodiscard]] core::Score as_stored(core::Score score);

/// Some scores of one robot with ascending stamps that span at most kMaxBlockSpan.
struct Block {
  core::Stamp first;    ///< stamp
  core::Stamp last;     ///< stamp
  core::Stamp arrival;  ///< of the last one
  std::size_t scores = 0;
  std::vector<std::byte> data;  ///< packed()
};
inline constexpr std::chrono::hours kMaxBlockSpan{1};

/// One robot's scores, as_stored() and in order of arrival, in as few blocks as possible.
[[nodiscard]] std::vector<Block> blocks(std::span<const ArrivedScore> scores);

/// As bytes. The scores are as_stored().
[[nodiscard]] std::vector<std::byte> packed(std::span<const core::Score> scores);
/// The inverse. Throws StorageError if these are not bytes of packed().
[[nodiscard]] std::vector<core::Score> unpacked(std::span<const std::byte> data);

}  // namespace kidnapwatch::storage
