#pragma once
/// Parameters of guidance `dwa`, with their names in files.

#include "controllers/dwa/dwa_guide.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

enum class DwaFootprint { kCircles, kPolygon, kCircle };

struct DwaPartParams {
  DwaGuideParams guide;
  ObstacleMemoryParams memory;
  DwaFootprint footprint = DwaFootprint::kCircles;
  double circle_radius_m = 0.56;
  double circle_spacing_m = 0.5;  ///< of the outer circles' centres from the vehicle's centre
};

const ParameterTable<DwaPartParams>& dwa_table();

/// @throws ConfigError "rover.guidance (dwa) needs 'front_axle_m', ..." if the vehicle type lacks
/// the number, or crossed limits with their numbers
DwaPartParams read_dwa_params(const ParameterSet& parameters, const ControllerContext& context);
/// @throws ConfigError if the circles leave more of the outline uncovered than margin_m
DiscOutline make_dwa_outline(const DwaPartParams& params, const ControllerContext& context);

}  // namespace vinerow::controllers
