// SPDX-License-Identifier: Apache-2.0
// A scan made ready for geometry: points, normals and the free space in front of each beam.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/scan.hpp"

namespace kidnapwatch::core {

/// What one scan shows of its surroundings, in beam order and in the sensor's frame.
///
/// Every array but the bearings has kMargin extra beams at both ends, so that a search around a
/// beam needs no bounds check: element kMargin + i belongs to beam i. Where the lidar sweeps a
/// whole turn the margins repeat the other end, otherwise they hold nothing. Reused from scan to
/// scan it allocates only when the number of beams grows.
struct Contour {
  static constexpr std::size_t kMargin = 8;
  static constexpr float kNowhere = 1e6F;  ///< coordinate of the point of a beam that hit nothing

  ScanGeometry geometry;
  std::size_t beams = 0;
  std::size_t valid = 0;      ///< beams that hit something
  bool whole_turn = false;    ///< the last beam is next to the first
  float mean_range_m = 0.0F;  ///< of the valid beams

  std::vector<float> cos_bearing, sin_bearing;  ///< of each beam, without margins
  std::vector<float> x, y;                      ///< m; kNowhere where nothing was hit
  std::vector<float> normal_x, normal_y;        ///< unit, of the line through both neighbours; or 0
  std::vector<float> near_m, far_m;  ///< least and largest range of a beam and its two neighbours;
                                     ///< both 0 where none of the three hit anything
  std::vector<char> foreground;      ///< whether the beam hit a narrow thing in front of all else
  std::vector<float> px, py;         ///< the points of the valid beams alone, no margins
  std::vector<std::uint32_t> pbeam;  ///< their beams, as indices with margin
  std::vector<std::uint32_t> segment_ends;  ///< memory: where surfaces end, in the list of points
};

/// Makes `contour` that of `scan`, which passed check().
void trace(const Scan& scan, Contour& contour);

/// Beam of `contour` in whose direction a point lies, rounded, as an index without margin; negative
/// outside the field of view.
[[nodiscard]] int beam_towards(const Contour& contour, float x_m, float y_m);

/// atan2 to 1e-4 rad, in a tenth of the time.
[[nodiscard]] float bearing_rad(float y, float x);

}  // namespace kidnapwatch::core
