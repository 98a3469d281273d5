// SPDX-License-Identifier: Apache-2.0
// A recorded run to cut kidnappings from: a robot that tours a simulated world.
#pragma once

#include <string>

#include "core/recording.hpp"
#include "core/sim/drive.hpp"
#include "core/sim/world.hpp"

namespace kidnapwatch::core::evaluation {

inline Recording tour(std::size_t scans, double step_s = 0.2) {
  const sim::World world = sim::room_world();
  sim::Drive drive(world, {.beams = 180, .range_max_m = 8.0}, 1,
                   stamp_from_ns(1'700'000'000'000'000'000));
  Recording recording{"tour", {}};
  for (std::size_t i = 0; i < scans; ++i) recording.scans.push_back(drive.next(step_s));
  return recording;
}

}  // namespace kidnapwatch::core::evaluation
