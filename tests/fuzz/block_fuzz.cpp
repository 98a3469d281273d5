// SPDX-License-Identifier: Apache-2.0
// Any bytes as a block of scores from a store that was scribbled on.
#include "storage/block.hpp"
#include "storage/sqlite.hpp"
#include "tests/fuzz/input.hpp"

using namespace kidnapwatch;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    (void)storage::unpacked(std::as_bytes(std::span(data, size)));
  } catch (const storage::StorageError&) {
  }
  return 0;
}
