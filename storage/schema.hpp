// SPDX-License-Identifier: Apache-2.0
// The store's tables, and how an older file becomes one of today.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {

/// Element i leads from schema i to i + 1; the file's PRAGMA user_version tells how many it has
/// seen.
[[nodiscard]] std::span<const std::string_view> migrations();

/// Creates the store or brings it up to date, all or nothing. A file of an older schema is first
/// copied to `file`.schema-N. Throws StorageError, touching nothing, if the file has a newer schema
/// or belongs to another program.
void migrate(const std::filesystem::path& file,
             std::span<const std::string_view> steps = migrations());

}  // namespace kidnapwatch::storage
