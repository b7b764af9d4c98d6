#pragma once
/// Compact tracks of vehicles and their links, and plans, as bytes with an index.
///
/// Numbers are little-endian, at multiples of 4 bytes. For a vehicle with n samples:
///   times       n uint32, ms since the run's start
///   positions   n times 3 int32, mm: origin of B in W
///   rotations   n times 4 int16, / 32767: quaternion (x, y, z, w) of B in W
/// For a vehicle that flies over a height field:
///   heights     n float32, m: B above the ground
/// For a link that moves relative to its vehicle:
///   rotations   n times 4 int16 likewise, of the link in B
///   positions   n times 3 int16, mm, where they change
/// For a link that spins too fast for its samples (a rotor): n uint8, 1 while it spins, and its
/// axis. Between samples, positions are interpolated linearly and rotations at constant rate, as in
/// odometry_at(). Samples of a stationary vehicle are left out.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/replay/replay.h"

namespace vinerow::tools {

struct ReplayTracks {
  /// "vehicles": a list in the scenario's order of {"name", "type", "index", "samples", "times",
  /// "positions", "rotations", "links", "plans"}; data in `bytes` are given by their offset. A
  /// vehicle without true poses is left out.
  nlohmann::json index;
  std::string bytes;
  std::vector<std::string> notes;
};

/// Tracks with at most 10 samples per second, fewer if `limits` require it.
/// @pre scenario, world, vehicles and trace are not null
ReplayTracks make_replay_tracks(const ReplayInput& input, const ReplayLimits& limits);

}  // namespace vinerow::tools
