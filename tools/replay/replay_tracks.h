#pragma once
/// Where vehicles and their links were, and what they were to do, as few bytes with an index.
///
/// Numbers are little-endian, at multiples of 4 bytes. Of a vehicle with n samples:
///   times       n uint32, ms since the run's start
///   positions   n times 3 int32, mm: origin of B in W
///   rotations   n times 4 int16, / 32767: quaternion (x, y, z, w) of B in W
/// Of a vehicle that flies over a height field:
///   heights     n float32, m: of B above the ground
/// Of a link that moves against its vehicle:
///   rotations   n times 4 int16 likewise, of the link in B
///   positions   n times 3 int16, mm, where they change
/// Of a link that spins too fast for its samples (a rotor): n uint8, 1 while it spins, and its
/// axis. Between samples positions are straight and rotations turn evenly, as odometry_at() has it.
/// Samples of a vehicle that stands still are left out.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/replay/replay.h"

namespace vinerow::tools {

struct ReplayTracks {
  /// "vehicles": a list in the scenario's order of {"name", "type", "index", "samples", "times",
  /// "positions", "rotations", "links", "plans"}; where an offset of `bytes` is wanted it is the
  /// number. A vehicle without true poses is left out.
  nlohmann::json index;
  std::string bytes;
  std::vector<std::string> notes;
};

/// At most 10 samples a second; fewer where `limits` want it.
/// @pre scenario, world, vehicles and trace are there
ReplayTracks make_replay_tracks(const ReplayInput& input, const ReplayLimits& limits);

}  // namespace vinerow::tools
