#pragma once
/// Effect of a payload on the canopy as a JSON file, for the report and for other programs.

#include <string>

#include "engine/api/payload.h"

namespace vinerow::playback {

/// {vehicle, payload, quantity, unit, wanted, step_m, band_m, patches: [[row, side, along, band,
/// x_m, y_m, z_m, area_m2, amount], ...]}, as JSON.
std::string canopy_json(const std::string& vehicle, const std::string& payload,
                        const CanopyCoverage& coverage);

}  // namespace vinerow::playback
