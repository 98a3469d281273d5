// SPDX-License-Identifier: Apache-2.0
// Bytes in fewer bytes, by zstd.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kidnapwatch::storage {

[[nodiscard]] std::vector<std::byte> compressed(std::span<const std::byte> bytes);

/// The inverse. Throws StorageError for what is none, or would be longer than `longest`.
[[nodiscard]] std::vector<std::byte> decompressed(std::span<const std::byte> data,
                                                  std::size_t longest);

}  // namespace kidnapwatch::storage
