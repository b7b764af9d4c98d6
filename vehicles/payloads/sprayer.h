#pragma once
/// An air-assisted sprayer with nozzles on both sides: liquid onto the true canopy, patch by patch,
/// and what became of the rest. Physics of the spray: spray_jet.h; when sections open:
/// section_switch.h; sources and figures: docs/models/payloads.md.
///
/// At each tick an open nozzle gives off what flows in a period, as portions (`rays_per_nozzle`)
/// whose directions, uniform over the solid angle between inner and outer cone, and whose moments
/// within the period come from an additive recurrence of low discrepancy (Roberts, "The
/// unreasonable effectiveness of quasirandom sequences", 2018: powers of 1/1.2207...), shifted by
/// the part's random stream. Nozzles move with the true vehicle; sections know the estimate only.
/// The wind is that at the middle of the boom.
///
/// Cost: two or three rays a portion; no heap in a step.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::vehicles {

PartSpec sprayer_spec();
/// @throws ConfigError if parameters do not go together or the vehicle's map has no rows
std::unique_ptr<Payload> make_sprayer(const ParameterSet& parameters,
                                      const PayloadContext& context);

}  // namespace vinerow::vehicles
