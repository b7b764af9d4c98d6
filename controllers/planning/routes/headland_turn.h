#pragma once
/// Turn from the end of one alley to the entrance of the next.

#include <optional>
#include <vector>

#include "controllers/parts/paths/path_pieces.h"
#include "engine/core/result.h"

namespace vinerow::controllers {

enum class TurnKind {
  kThreePointArc,  ///< paper B, section 2.3: arc through alley end, apex, next alley's end
  kDubins,         ///< shortest path of a turning radius
};

struct TurnParams {
  TurnKind kind = TurnKind::kThreePointArc;
  double radius_m = 1.0;    ///< Dubins: of its arcs; three-point arc: the minimum allowed
  double headland_m = 0.0;  ///< straight on beyond both alley ends before and after turning
  std::optional<double>
      apex_m;  ///< of the three-point arc, beyond the alley ends; absent: semicircle
  double speed_mps = 0.0;
  /// For messages: the planner's keys of the radius and of the kind, and what else it offers.
  const char* radius_key = "turn_radius_m";
  const char* kind_key = "turn";
  const char* other = ", or order: skip";
};

/// @param exit   end of the alley just driven, heading out
/// @param entry  entrance of the next, heading in
/// @returns straights and arcs, or the reason why the turn does not fit: "the three-point arc has a
/// radius of 0.8 m, ..."
Result<std::vector<PathSegment>> make_headland_turn(const Pose2& exit, const Pose2& entry,
                                                    const TurnParams& params);

}  // namespace vinerow::controllers
