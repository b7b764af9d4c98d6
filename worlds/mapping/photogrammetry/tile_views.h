#pragma once
/// Pictures that show a small piece of ground, and the partners of each in dense matching.

#include <cstdint>
#include <vector>

#include "worlds/mapping/photogrammetry/survey_view.h"

namespace vinerow::mapping {

struct TileViews {
  std::vector<int> shown_in;  ///< indices of views that may show the tile, ascending
  std::vector<bool> whole;    ///< of each of them: true if it shows the whole ball
  /// For each of `shown_in`: its partners (positions in `shown_in`) by rising angle between both
  /// rays, equal angles by index.
  std::vector<std::vector<std::uint16_t>> partners;
};

/// @param centre_W,radius_m  of a ball around the tile
/// @param min_angle_rad    smallest angle between the rays of partners to the centre
/// @param max_partners       partners of one picture
TileViews find_tile_views(const std::vector<SurveyView>& views, const Eigen::Vector3d& centre_W,
                          double radius_m, double min_angle_rad, int max_partners);

}  // namespace vinerow::mapping
