#pragma once
/// Messages for speeds that cannot be driven: of a plan, beyond its follower's, and of a follower,
/// beyond its wheels'.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "engine/api/messages/path.h"

namespace vinerow::controllers {

/// "the plan wants up to 5 m/s, the limit is 1.94 m/s (speed_mps)"; empty if it does not.
/// @param key  of the follower's own limit
/// @param counts  (PathKind): whether the limit applies there
inline std::string describe_too_fast_plan(
    const PlannedPath& plan, double own_mps, const char* key,
    bool (*counts)(PathKind) = [](PathKind) { return true; }) {
  double max_mps = 0.0;
  for (const PathPoint& point : plan.points) {
    if (counts(point.kind)) max_mps = std::max(max_mps, point.speed_mps);
  }
  constexpr double kRounding = 1e-9;
  if (max_mps <= own_mps * (1.0 + kRounding)) return "";
  return fmt::format("the plan wants up to {:.3g} m/s, the limit is {:.3g} m/s ({})", max_mps,
                     own_mps, key);
}

/// "speed_mps = 19.4 m/s, but the wheels reach 4 m/s"; empty if they reach it.
inline std::string describe_too_slow_wheels(double own_mps, double wheels_mps) {
  if (own_mps <= wheels_mps) return "";
  return fmt::format("speed_mps = {:.6g} m/s, but the wheels reach {:.3g} m/s", own_mps,
                     wheels_mps);
}

/// What of the wanted speeds a follower cannot drive, a sentence each.
/// @param own_mps     the follower's `speed_mps`
/// @param wheels_mps  that its wheels reach
inline std::vector<std::string> describe_slower_speeds(const PlannedPath& plan, double own_mps,
                                                       double wheels_mps) {
  std::vector<std::string> sentences = {
      describe_too_slow_wheels(own_mps, wheels_mps),
      describe_too_fast_plan(plan, std::min(own_mps, wheels_mps), "speed_mps")};
  std::erase(sentences, "");
  return sentences;
}

}  // namespace vinerow::controllers
