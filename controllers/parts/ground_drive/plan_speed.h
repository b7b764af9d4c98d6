#pragma once
/// What a plan wants faster than its follower goes: told, because it is driven slower than asked.

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "engine/api/messages/path.h"

namespace vinerow::controllers {

/// "the plan wants up to 5 m/s, goes 1.94 m/s at most (speed_mps)"; empty where it wants no more.
/// @param key  of the follower's own limit
inline std::string tell_plan_too_fast(const PlannedPath& plan, double own_mps, const char* key) {
  double most_mps = 0.0;
  for (const PathPoint& point : plan.points) most_mps = std::max(most_mps, point.speed_mps);
  constexpr double kRounding = 1e-9;
  if (most_mps <= own_mps * (1.0 + kRounding)) return "";
  return fmt::format("the plan wants up to {:.3g} m/s, goes {:.3g} m/s at most ({})", most_mps,
                     own_mps, key);
}

}  // namespace vinerow::controllers
