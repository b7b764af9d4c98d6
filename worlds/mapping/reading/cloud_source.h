#pragma once
/// Source of a map's cloud.

#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/reading/read_cloud.h"

namespace vinerow::mapping {

/// Completes a map of make_cloud_map(), except for phases: origin, file, format, crs, cloud_bytes,
/// not_finite, reduction, and the reader's sentences before its notes.
void add_source(const CloudReadReport& read, CloudMap& map);

}  // namespace vinerow::mapping
