// SPDX-License-Identifier: Apache-2.0
// Shares and how sure they are, row by row: a dot and a whisker for each series.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace kidnapwatch::adapters::report {

/// 0 <= low <= value <= high <= 1.
struct Interval {
  double value = 0.0;
  double low = 0.0;
  double high = 1.0;
};

struct IntervalRow {
  std::string label;
  std::vector<std::optional<Interval>> values;  ///< one per series, or nothing
};

struct IntervalFigure {
  std::string title;
  std::string x_label;
  double reach = 1.0;  ///< of the axis from 0; beyond it an arrow says so
  std::vector<std::string> series;
  std::vector<IntervalRow> rows;
};

/// As SVG; the values stand at the right, too.
[[nodiscard]] std::string drawn(const IntervalFigure& figure);

}  // namespace kidnapwatch::adapters::report
