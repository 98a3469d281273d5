// SPDX-License-Identifier: Apache-2.0
// What the paper claims, what was measured, and whether it holds.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/study/results.hpp"

namespace kidnapwatch::core::study {

enum class Verdict { holds, partly, fails, by_construction };

struct Claim {
  std::string figure;
  std::string text;
  std::string measured;
  Verdict verdict = Verdict::fails;
  std::string why;
};

/// "holds", "holds in part", "does not hold", "holds by construction".
[[nodiscard]] std::string_view name(Verdict verdict);

/// The claims that can be judged by the conditions that were run; a claim whose systems were not
/// run is left out. The verdicts follow from the numbers: a claim holds if it does in every case
/// that it makes, and in part if it does in at least half of them.
[[nodiscard]] std::vector<Claim> claims(std::span<const Condition> conditions,
                                        const Reading& reading);

}  // namespace kidnapwatch::core::study
