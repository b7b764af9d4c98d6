#pragma once
/// Coverage picture of a survey with two maps: number of pictures that see each point of the
/// parcel, and their forward overlap.

#include "engine/playback/coverage_log.h"
#include "engine/render/scene.h"

namespace vinerow::tools {

/// North is up. Both maps show the parcel, the plant rows, the vehicle's track and the positions of
/// the pictures. A colour scale is below each, and the numbers of CoverageMap are at the bottom.
render::Image draw_coverage(const playback::SurveyCoverage& coverage);

}  // namespace vinerow::tools
