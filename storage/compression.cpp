// SPDX-License-Identifier: Apache-2.0
// zstd with a context for each thread.
#include "storage/compression.hpp"

#include <memory>
#include <string>

#include <zstd.h>

#include "storage/sqlite.hpp"

namespace kidnapwatch::storage {
namespace {

constexpr int kLevel = 3;  // level 19 saves 4 % of a block of scores and takes 20 times as long

[[noreturn]] void refuse(const char* reason) {
  throw StorageError::damage(std::string("compressed data: ") + reason);
}

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const noexcept { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const noexcept { ZSTD_freeDCtx(context); }
};

}  // namespace

std::vector<std::byte> compressed(std::span<const std::byte> bytes) {
  thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  std::vector<std::byte> data(ZSTD_compressBound(bytes.size()));
  const std::size_t size = ZSTD_compressCCtx(context.get(), data.data(), data.size(), bytes.data(),
                                             bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0) refuse(ZSTD_getErrorName(size));
  data.resize(size);
  return data;
}

std::vector<std::byte> decompressed(std::span<const std::byte> data, std::size_t longest) {
  thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  const auto size = ZSTD_getFrameContentSize(data.data(), data.size());
  if (size > longest) refuse("none, or too much");  // as where the size is unknown
  std::vector<std::byte> bytes(size);
  const std::size_t got =
      ZSTD_decompressDCtx(context.get(), bytes.data(), bytes.size(), data.data(), data.size());
  if (ZSTD_isError(got) != 0 || got != size) refuse("damaged");
  return bytes;
}

}  // namespace kidnapwatch::storage
