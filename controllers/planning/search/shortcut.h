#pragma once
/// Shorter ways over free ground: parts of a path are replaced by Dubins paths.

#include <vector>

#include "controllers/parts/paths/footprint.h"
#include "controllers/parts/paths/path_pieces.h"
#include "engine/core/random.h"

namespace vinerow::controllers {

struct ShortcutParams {
  double radius_m = 1.0;      ///< of the Dubins paths
  double check_step_m = 0.1;  ///< between poses of the swept check
  double tries_per_m = 5.0;   ///< of the path's length
  double longest_m = 30.0;    ///< part of the path that one try replaces
};

/// Tries the whole path, then parts drawn at random; a part is
/// replaced where that is free and saves a centimetre. Ends stay where they are.
/// @param pieces  free, each starting where the one before ends; not empty
std::vector<PathPiece> shorten_at_random(std::vector<PathPiece> pieces,
                                         const ShortcutParams& params, const Footprint& footprint,
                                         RandomStream& random);

}  // namespace vinerow::controllers
