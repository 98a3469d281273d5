// SPDX-License-Identifier: Apache-2.0
// From a name back to the enumerator that it names.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "core/bad_input.hpp"

namespace kidnapwatch::core {

/// The enumerator whose name is `text`, where names[i] names the enumerator of value i. Throws
/// BadInput naming `field` and what is allowed.
template <typename Enum, std::size_t N>
[[nodiscard]] Enum named(const std::array<std::string_view, N>& names, std::string_view text,
                         std::string_view field) {
  const auto found = std::ranges::find(names, text);
  if (found != names.end()) {
    return static_cast<Enum>(found - names.begin());
  }
  std::string allowed;
  for (const auto one : names) {
    allowed += (allowed.empty() ? "must be one of " : ", ") + std::string(one);
  }
  throw BadInput(std::string(field), allowed);
}

}  // namespace kidnapwatch::core
