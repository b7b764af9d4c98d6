#pragma once
/// Where the cloud of a map came from.

#include "worlds/mapping/model/cloud_map.h"
#include "worlds/mapping/reading/read_cloud.h"

namespace vinerow::mapping {

/// Adds to a map of make_cloud_map() what that leaves to its caller, but for phases: origin, file,
/// format, crs, cloud_bytes, not_finite, reduction, and the reader's sentences before its notes.
void add_source(const CloudReadReport& read, CloudMap& map);

}  // namespace vinerow::mapping
