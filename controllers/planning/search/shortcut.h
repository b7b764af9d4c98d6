#pragma once
/// Shortening of a path over free ground by Dubins paths.

#include <vector>

#include "controllers/parts/paths/footprint.h"
#include "controllers/parts/paths/path_pieces.h"
#include "engine/core/random.h"

namespace vinerow::controllers {

struct ShortcutParams {
  double radius_m = 1.0;      ///< of the Dubins paths
  double check_step_m = 0.1;  ///< between poses of the collision check
  double tries_per_m = 5.0;   ///< per metre of the path's length
  double longest_m = 30.0;    ///< length of the section that one try replaces
};

/// Tries the whole path, then sections drawn at random. A Dubins path replaces a section if it is
/// free and saves at least a centimetre. The ends do not move.
/// @param pieces  free, each starting where the one before ends; not empty
std::vector<PathSegment> shorten_at_random(std::vector<PathSegment> pieces,
                                           const ShortcutParams& params, const Footprint& footprint,
                                           RandomStream& random);

}  // namespace vinerow::controllers
