// SPDX-License-Identifier: Apache-2.0
// Independent pieces of work on several threads, with progress on a terminal.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

namespace kidnapwatch::service {

/// Calls work(0) .. work(count - 1), each once, on `threads` threads (0: one per core). The first
/// exception ends it all, and is thrown. If standard error is a terminal it shows how far it is.
void in_parallel(std::size_t count, std::size_t threads, std::string_view what,
                 const std::function<void(std::size_t)>& work);

}  // namespace kidnapwatch::service
