#pragma once
/// Plan as straight legs for a fixed-wing vehicle, and its height along them.

#include <string>
#include <vector>

#include "controllers/parts/paths/leg_frame.h"
#include "controllers/waypoint_guidance/heading_generator.h"
#include "engine/api/forward.h"
#include "engine/api/messages/path.h"
#include "engine/core/result.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

/// A sharper corner is a reversal: no tangent leads from leg to leg, the waypoint is flown over.
inline constexpr double kReversal_rad = 150.0 * kPi / 180.0;

struct FlightLeg {
  LegFrame frame;
  PathKind kind = PathKind::kTransit;
  int waypoint = 0;            ///< index in the plan of the leg's end
  double start_m = 0.0;        ///< of the leg along the plan
  double plan_length_m = 0.0;  ///< of the plan that it represents; 0 for paths to the plan
  double airspeed_mps = 0.0;
};

struct FlightLegsOptions {
  TurnLimits turn;
  double airspeed_mps = 12.0;   ///< if the plan does not state it
  double min_airspeed_mps = 0;  ///< the plan's speeds below it are not flown
  double max_airspeed_mps = 1e9;
  double climb_max_rad = rad_from_deg(10.0);
  double descent_max_rad = rad_from_deg(10.0);
};

struct FlightLegs {
  std::vector<FlightLeg> legs;
  double length_m = 0.0;              ///< in plan view
  std::vector<std::string> warnings;  ///< parts of the plan that cannot be flown as they are
};

/// Points nearer to each other than this in plan view count as one waypoint, the later one.
constexpr double kSameWaypoint_m = 0.1;

/// @returns the legs, or a failure: "plan has 1 waypoint, needs two or more"
Result<FlightLegs> make_flight_legs(const PlannedPath& plan, const FlightLegsOptions& options);

struct HeightPoint {
  double height_m = 0.0;
  double slope = 0.0;  ///< per metre along the leg
};

/// Height of the consecutive ramps of eq. 6, with kinks rounded by parabolas. No heap.
/// @param along_m  along leg `leg`; negative: on legs before it, more than its length: on legs
/// after
/// @param kink_m   half the length of a parabola; reduced if half a leg is shorter
HeightPoint calc_height(const std::vector<FlightLeg>& legs, std::size_t leg, double along_m,
                        double kink_m);

}  // namespace vinerow::controllers
