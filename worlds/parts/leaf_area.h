#pragma once
/// Leaf area of a world's plants: its density in their hulls, its index on the ground, and the
/// shelter from wind that follows.

#include "engine/api/forward.h"
#include "engine/api/mesh.h"

namespace vinerow::worlds {

/// Volume inside a closed mesh, by the divergence theorem.
double enclosed_volume_m3(const TriangleMesh& mesh);

/// Leaves in a hull. @param leaf_area_m2  one side, of all leaves
Foliage foliage_in(const TriangleMesh& hull, double leaf_area_m2, double leaf_width_m);

/// Leaf area, one side, over the ground of the rows: their length times the mean distance between
/// them. 0 if no hull states its leaves.
double leaf_area_index(const WorldModel& world);

/// Attenuation a of the wind among leaves: a = 0.28 LAI^(2/3) h^(1/3) / w^(1/3) (Goudriaan, "Crop
/// Micrometeorology", 1977). @param height_m  h, of the canopy's top @param leaf_width_m  w, > 0
double shelter_attenuation(double leaf_area_index, double height_m, double leaf_width_m);

/// Sets the wind's shelter if it is to follow from the leaves. Call it when all plants stand.
/// @throws ConfigError if the world has canopy but does not know its leaf area
void settle_shelter(WorldModel& world);

}  // namespace vinerow::worlds
