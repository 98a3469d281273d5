// SPDX-License-Identifier: Apache-2.0
// Strips of coloured cells, one per detector: the manner of the paper's figures 2, 3 and 6-9.
#pragma once

#include <string>
#include <vector>

namespace kidnapwatch::adapters::report {

/// One value per step; colours from 0 to 1, black at 0 and below.
struct Strip {
  std::string label;
  std::vector<double> values;
  std::vector<std::string> notes;  ///< at the right, one per column of the figure
};

/// Strips that belong together: those of a map.
struct StripGroup {
  std::string title;
  std::vector<Strip> strips;
};

struct StripFigure {
  std::string title;
  std::string x_label;
  double first_x = 0.0;              ///< of every strip's first value; then steps of 1
  std::string scale_label;           ///< what the colours mean
  std::vector<std::string> columns;  ///< heads of the notes
  std::vector<StripGroup> groups;
};

/// As SVG.
[[nodiscard]] std::string drawn(const StripFigure& figure);

}  // namespace kidnapwatch::adapters::report
