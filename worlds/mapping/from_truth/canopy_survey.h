#pragma once
/// Survey of a row's true canopy by rays, like a laser scan, and fit of chains of cross-sections.

#include <vector>

#include "engine/api/scene_query.h"
#include "engine/core/random.h"
#include "worlds/mapping/from_truth/section_chain.h"

namespace vinerow::mapping {

struct CanopySurveyOptions {
  double spacing_low_m = 1.0;  ///< between sections, drawn evenly from low to high
  double spacing_high_m = 2.0;
  int levels = 4;  ///< >= 2, from the lowest leaves to the highest (level_shares())
};

/// Search range.
struct RowSurroundings {
  double side_m = 1.0;    ///< to each side of the row's line, less than half way to the next row
  double height_m = 4.0;  ///< above the ground
};

/// Chains for every stretch of canopy above the row's line, up to 2 m beyond its ends. Stretches
/// shorter than 0.3 m are left out. Canopy is found by rays of class kCanopy every 0.15 m, down and
/// up on the line and from both sides at many heights. The sections are the least-squares fit of a
/// surface that is straight between them, so that its mean error is zero. A stretch gets at least
/// four sections.
/// @returns empty if there is no canopy on the line
std::vector<SectionChain> survey_canopy(const SceneQuery& scene, const RowCurve& row,
                                        const GroundHeight& ground,
                                        const RowSurroundings& surroundings,
                                        const CanopySurveyOptions& options, RandomStream& random);

/// Positions of sections from `from_m` to `to_m`, both included: steps drawn from the options'
/// range, then scaled to fit. @param min_count  minimum number of sections
std::vector<double> draw_stations(double from_m, double to_m, const CanopySurveyOptions& options,
                                  std::size_t min_count, RandomStream& random);

}  // namespace vinerow::mapping
