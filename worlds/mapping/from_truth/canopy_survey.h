#pragma once
/// Measures the true canopy of a row, as a laser scan of it would, and fits chains of
/// cross-sections to it.

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

/// How far to look.
struct RowSurroundings {
  double side_m = 1.0;    ///< to each side of the row's line, less than half way to the next row
  double height_m = 4.0;  ///< above the ground
};

/// One chain for every stretch of canopy above the row's line, up to 2 m beyond its ends. Shorter
/// stretches than 0.3 m are left out. Canopy is found by rays of class kCanopy down and up on the
/// line and from both sides at many heights, every 0.15 m; sections are the least-squares fit of a
/// surface that is straight between them, so its mean error is zero. A stretch gets at least four
/// sections.
/// @returns empty where nothing stands on the line
std::vector<SectionChain> survey_canopy(const SceneQuery& scene, const RowCurve& row,
                                        const GroundHeight& ground,
                                        const RowSurroundings& surroundings,
                                        const CanopySurveyOptions& options, RandomStream& random);

/// Where sections stand from `from_m` to `to_m`, both included: steps drawn from the options'
/// range, then scaled to fit. @param least  sections
std::vector<double> draw_stations(double from_m, double to_m, const CanopySurveyOptions& options,
                                  std::size_t least, RandomStream& random);

}  // namespace vinerow::mapping
