#pragma once
/// Air-assisted sprayer with nozzles on both sides. It deposits liquid on the patches of the true
/// canopy and records where the rest goes. Physics of the spray: spray_jet.h; switching of
/// sections: section_switch.h; sources and figures: docs/models/payloads.md.
///
/// At each tick an open nozzle emits the flow of one period in `rays_per_nozzle` portions. Their
/// directions, uniform over the solid angle between inner and outer cone, and their times within
/// the period come from an additive recurrence of low discrepancy (Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018: powers of 1/1.2207...), shifted by the part's
/// random stream. Nozzles move with the true vehicle; sections know only the estimate. The wind is
/// that at the middle of the boom.
///
/// Cost: two or three rays per portion; no heap in a step.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::vehicles {

PartSpec sprayer_spec();
/// @throws ConfigError if parameters contradict each other or the vehicle's map has no rows
std::unique_ptr<Payload> make_sprayer(const ParameterSet& parameters,
                                      const PayloadContext& context);

}  // namespace vinerow::vehicles
