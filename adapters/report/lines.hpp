// SPDX-License-Identifier: Apache-2.0
// Lines in a square of axes: ROC curves.
#pragma once

#include <string>
#include <vector>

#include "adapters/report/svg.hpp"

namespace kidnapwatch::adapters::report {

struct Line {
  std::string label;
  std::vector<Xy> points;  ///< in the units of the axes
};

/// An axis from 0 to 1, or by powers of ten from `least` to 1.
struct Axis {
  std::string label;
  double least = 0.0;  ///< > 0: logarithmic
};

struct LineFigure {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Line> lines;
};

/// As SVG. Points beyond the axes are drawn at their ends.
[[nodiscard]] std::string drawn(const LineFigure& figure);

}  // namespace kidnapwatch::adapters::report
