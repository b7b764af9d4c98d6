#pragma once
/// How near the hull came to plants and posts: true distance from the vehicle's collision box to
/// the meshes.
///
/// Results: min_clearance_m (to canopy, posts, trunks and wires; NaN where none of them was nearer
/// than search_radius_m), contact_count (touches of those, of obstacles and of other vehicles;
/// touches less than 0.5 s apart are one), canopy_contact_count.
/// Between two ticks the way is taken as straight and looked at every 2 cm, so that leaves that are
/// brushed between them count; that they are is written to <name>_event. What is rigid is counted
/// by the physics, every step.
/// Cost: the distance is only computed where it could be a new minimum: the hull cannot have come
/// nearer than it moved.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/metrics/metric_numbers.h"

namespace vinerow::metrics {

const std::vector<MetricNumber>& clearance_numbers();
PartSpec clearance_spec();
std::unique_ptr<Metric> make_clearance(const ParameterSet& parameters,
                                       const MetricContext& context);

}  // namespace vinerow::metrics
