// SPDX-License-Identifier: Apache-2.0
// The warping cost as it is usually written: what the kernel is measured against.
#pragma once

#include "core/cloud.hpp"

namespace kidnapwatch::bench {

/// The textbook's: two rows of doubles, the smallest of three by std::min.
[[nodiscard]] double two_rows(const core::Cloud& p, const core::Cloud& q);

/// Along anti-diagonals, in floats: cells that do not depend on each other, which the compiler
/// turns into vector instructions of this very processor.
[[nodiscard]] float wavefront(const core::Cloud& p, const core::Cloud& q);

}  // namespace kidnapwatch::bench
