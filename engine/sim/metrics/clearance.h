#pragma once
/// How near the hull came to plants and posts: true distance from the vehicle's collision box to
/// the meshes.
///
/// Results: min_clearance_m (up to search_radius_m), contact_count (touches of canopy, posts,
/// trunks, obstacles and other vehicles; touches less than 0.5 s apart are one),
/// canopy_contact_count. Cost: the distance is only computed where it could be a new minimum: the
/// hull cannot have come nearer than it moved.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow {

PartSpec clearance_spec();
std::unique_ptr<Metric> make_clearance(const ParameterSet& parameters,
                                       const MetricContext& context);

}  // namespace vinerow
