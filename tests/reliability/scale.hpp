// SPDX-License-Identifier: Apache-2.0
// How much of a promise is tried: a little in every test run, all of it by tests/reliability/run.
#pragma once

#include <cstdlib>
#include <string_view>

namespace kidnapwatch::test {

/// `full` where KW_RELIABILITY=full is set, else `quick`.
template <typename Amount>
[[nodiscard]] Amount at_scale(Amount quick, Amount full) {
  const char* scale = std::getenv("KW_RELIABILITY");  // NOLINT(concurrency-mt-unsafe): one thread
  return scale != nullptr && std::string_view(scale) == "full" ? full : quick;
}

}  // namespace kidnapwatch::test
