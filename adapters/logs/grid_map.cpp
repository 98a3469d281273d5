// SPDX-License-Identifier: Apache-2.0
// Tells a map's format by its content; reads those of CMU's robotics courses.
#include "adapters/logs/grid_map.hpp"

#include <string>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using core::BadInput;
using core::baselines::Cell;
using core::baselines::GridMap;

constexpr std::string_view kResolution = "robot_specifications->resolution";
constexpr std::string_view kMap = "global_map[0]:";
constexpr double kMetres = 0.01;  // per centimetre
// As map_server has them.
constexpr double kOccupied = 0.65;
constexpr double kFree = 0.25;

Cell cell(double free) {
  if (free < 0.0) return Cell::unknown;
  if (1.0 - free > kOccupied) return Cell::occupied;
  return 1.0 - free < kFree ? Cell::free : Cell::unknown;
}

/// The grid that the lines up to the map's first row describe, all unknown.
GridMap empty_map(Lines& lines) {
  GridMap map;
  map.layout.cell_m = 0.0;
  while (lines.next()) {
    Words words(lines.text());
    if (lines.text().starts_with(kResolution)) {
      words.skip(1, "resolution");
      map.layout.cell_m = kMetres * words.finite("resolution");
    } else if (lines.text().starts_with(kMap)) {
      words.skip(1, "global_map");
      map.layout.columns = static_cast<long>(words.beam_count("global_map"));
      map.layout.rows = static_cast<long>(words.beam_count("global_map"));
      break;
    }
  }
  if (!(map.layout.cell_m > 0.0)) throw BadInput("resolution", "missing or not above 0");
  if (map.layout.columns == 0) throw BadInput("global_map", "missing");
  if (map.layout.cells() > core::baselines::kMaxCells) throw BadInput("global_map", "too large");
  map.cells.assign(map.layout.cells(), Cell::unknown);
  return map;
}

}  // namespace

bool is_cmu_map(std::string_view head) { return head.starts_with("robot_specifications->"); }

GridMap read_cmu_map(Lines& lines) {
  try {
    GridMap map = empty_map(lines);
    for (long column = 0; column < map.layout.columns; ++column) {
      if (!lines.next()) throw BadInput("global_map", "cut off");
      Words words(lines.text());
      for (long row = 0; row < map.layout.rows; ++row) {
        map.cells[map.layout.index(column, row)] = cell(words.finite("global_map"));
      }
      words.expect_end();
    }
    return map;
  } catch (const BadInput& error) {
    throw BadInput(lines.where(), error.what());
  }
}

GridMap read_grid_map(const std::filesystem::path& file) {
  Lines lines(file);
  if (is_cmu_map(lines.head())) return read_cmu_map(lines);
  if (is_ros_map(lines.head())) return read_ros_map(lines);
  throw BadInput(file.string(), "no map of a known format");
}

}  // namespace kidnapwatch::adapters::logs
