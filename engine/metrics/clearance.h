#pragma once
/// Clearance and contacts: true distance from the vehicle's collision box to the meshes.
///
/// Results: min_clearance_m (to canopy, posts, trunks and wires; NaN if none of them came nearer
/// than search_radius_m), contact_count (contacts with those, with obstacles and with other
/// vehicles; contacts less than 0.5 s apart count as one), canopy_contact_count.
/// Between two ticks the motion is interpolated and sampled every 2 cm, so that leaves brushed
/// between ticks count; each canopy contact is reported to <name>_event. Physics counts contacts
/// with rigid bodies, in every step.
/// Cost: the distance is computed only if it could be a new minimum. It cannot have decreased by
/// more than the hull has moved.

#include <memory>
#include <vector>

#include "engine/api/registry.h"
#include "engine/api/result_spec.h"

namespace vinerow::metrics {

const std::vector<ResultSpec>& clearance_results();
PartSpec clearance_spec();
std::unique_ptr<Metric> make_clearance(const ParameterSet& parameters,
                                       const MetricContext& context);

}  // namespace vinerow::metrics
