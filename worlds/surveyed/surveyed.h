#pragma once
/// World `surveyed`: rows, poles and vines of a real vineyard from GeoJSON in WGS84.

#include "engine/api/registry.h"

namespace vinerow::worlds {

void register_surveyed(Registry& registry);

}  // namespace vinerow::worlds
