#pragma once
/// Two maps of a survey: how many pictures see each place of the parcel, and the forward overlap
/// with which they do.

#include "engine/playback/coverage_log.h"
#include "engine/render/scene.h"

namespace vinerow::tools {

/// North is up. Both maps show the parcel, the plant rows, the vehicle's track and where pictures
/// were taken; a scale of colours below each, and the numbers of CoverageMap.
render::Image draw_coverage(const playback::SurveyCoverage& coverage);

}  // namespace vinerow::tools
