#pragma once
/// Which pictures show a small piece of ground, and which of them a dense matcher puts beside each.

#include <cstdint>
#include <vector>

#include "worlds/mapping/photogrammetry/survey_view.h"

namespace vinerow::mapping {

struct TileViews {
  std::vector<int> shown_in;  ///< indices of views that may show the tile, ascending
  std::vector<bool> whole;    ///< of each of them: that it shows all of the ball
  /// For each of `shown_in`: its partners (places in `shown_in`), those with the smallest angle
  /// between both rays first, and by index where two angles are equal.
  std::vector<std::vector<std::uint16_t>> partners;
};

/// @param centre_W,radius_m  of a ball around the tile
/// @param least_angle_rad    between the rays of two pictures to the centre, for them to be
/// partners
/// @param most               partners of one picture
TileViews find_tile_views(const std::vector<SurveyView>& views, const Eigen::Vector3d& centre_W,
                          double radius_m, double least_angle_rad, int most);

}  // namespace vinerow::mapping
