#include "controllers/dwa/dwa_params.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

std::string who(const ControllerContext& context) {
  return context.part + " (dwa)";
}

}  // namespace

const ParameterTable<DwaPartParams>& dwa_table() {
  using P = DwaPartParams;
  using Guide = DwaGuideParams;
  using Memory = ObstacleMemoryParams;
  const auto guide = [](auto... members) { return inside(&P::guide, members...); };
  const auto law = [](auto... members) { return inside(&P::guide, &Guide::law, members...); };
  const auto cost = [](auto member) {
    return inside(&P::guide, &Guide::law, &DwaParams::cost, member);
  };
  const auto plan = [](auto member) { return inside(&P::guide, &Guide::plan, member); };
  const auto recovery = [](auto member) { return inside(&P::guide, &Guide::recovery, member); };
  const auto memory = [](auto member) { return inside(&P::memory, member); };
  // The guide takes speeds below 0.03 m/s for standing: with less than these bounds it would call
  // every alley blocked.
  constexpr ParameterRange kSpeeds = between(0.05, 100.0);
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("mode", guide(&Guide::mode),
                  {{"assist", DwaMode::kAssist}, {"pure", DwaMode::kPure}},
                  "assist: follow the plan while it is free; pure: always drive by samples")
          .choice("footprint", &P::footprint,
                  {{"circles", DwaFootprint::kCircles},
                   {"polygon", DwaFootprint::kPolygon},
                   {"circle", DwaFootprint::kCircle}},
                  "outline in rollouts: three circles, the polygon, or one circle around it")
          .number("circle_radius_m", "m", &P::circle_radius_m, kPositive,
                  "radius of each of the three circles")
          .number("circle_spacing_m", "m", &P::circle_spacing_m, kPositive,
                  "distance of the outer circles' centres from the vehicle's centre")
          .choice("cost", cost(&DwaCost::as_printed), {{"corrected", false}, {"printed", true}},
                  "printed: J = alpha d_O + beta d_goal of eq. (23), which drives away")
          .number("speed_mps", "m/s", guide(&Guide::speed_mps), kSpeeds,
                  "highest speed if the plan has no speed")
          .number("acceleration_mps2", "m/s2", law(&DwaParams::acceleration_mps2), kPositive,
                  "acceleration and deceleration")
          .number("window_s", "s", law(&DwaParams::window_s), between(0.01, 100.0),
                  "the dynamic window contains the commands that can be reached within this time")
          .number("horizon_s", "s", law(&DwaParams::horizon_s), kPositive, "length of the rollouts")
          .number("step_s", "s", law(&DwaParams::step_s), kPositive,
                  "time between checked poses of a rollout")
          .integer("speed_samples", law(&DwaParams::speeds), between(2, 50), "sampled speeds")
          .integer("steer_samples", law(&DwaParams::steers), between(3, 51),
                   "sampled angles per axle")
          .number("clearance_weight", "1/m", cost(&DwaCost::clearance_weight), between(0.0, 1e3),
                  "alpha, of the clearance at the end")
          .number("goal_weight", "1/m", cost(&DwaCost::goal_weight), between(0.0, 1e3),
                  "beta, of the distance to the point ahead on the plan")
          .number("heading_weight", "1/rad", cost(&DwaCost::heading_weight), between(0.0, 1e3),
                  "zeta, of the heading error")
          .number("path_weight", "1/m", cost(&DwaCost::path_weight), between(0.0, 1e3),
                  "eta, of the mean distance from the path")
          .number("clearance_saturation_m", "m", cost(&DwaCost::saturation_m), kPositive,
                  "d_sat: clearance beyond this has no further value")
          .number("lookahead_m", "m", guide(&Guide::lookahead_m), between(0.2, 4.0),
                  "distance of the goal ahead on the plan")
          .number("margin_m", "m", plan(&PlanAheadParams::margin_m), between(0.0, 1.0),
                  "clearance to obstacles of the map")
          .number("follow_margin_m", "m", plan(&PlanAheadParams::follow_margin_m),
                  between(-1.0, 1.0),
                  "the same while following the plan, which was checked with its own margin; "
                  "negative: following may cut this far into occupied ground of the map, for "
                  "virtual walls")
          .number("obstacle_margin_m", "m", plan(&PlanAheadParams::obstacle_margin_m),
                  between(0.0, 1.0), "clearance to obstacles that only the sensors detected")
          .number("pass_m", "m", plan(&PlanAheadParams::lane_max_m), between(0.0, 2.0),
                  "largest distance beside the plan of a path past an obstacle")
          .number("fade_m", "m", plan(&PlanAheadParams::fade_m), kPositive,
                  "assumed length over which the tracking controller removes its error")
          .number("reverse_speed_mps", "m/s", guide(&Guide::reverse_speed_mps), kSpeeds,
                  "speed backwards when blocked")
          .number("reverse_s", "s", recovery(&RecoveryParams::reverse_s), between(0.0, 60.0),
                  "longest drive back when blocked")
          .integer("max_recoveries", recovery(&RecoveryParams::max_recoveries), between(0, 100),
                   "drives back before it stops")
          .number("stall_s", "s", recovery(&RecoveryParams::stall_s), between(0.5, 1e4),
                  "without progress for this long it counts as blocked")
          .number("retry_s", "s", recovery(&RecoveryParams::retry_s), kPositive,
                  "period of further tries after it has stopped")
          .number("look_back_s", "s", recovery(&RecoveryParams::look_back_s), between(0.0, 60.0),
                  "longest drive back of every fourth try, for a view from farther away")
          .number("finish_m", "m", guide(&Guide::finish_m), between(0.0, 2.0),
                  "nearer to the plan's end than this the tracking controller takes over")
          .number("obstacle_range_m", "m", memory(&Memory::obstacle_range_m), between(0.0, 20.0),
                  "echoes from farther are ignored; 0 = all sensors are ignored")
          .number("map_tolerance_m", "m", memory(&Memory::map_tolerance_m), kPositive,
                  "an echo nearer than this to something on the map comes from there")
          .degrees("ground_slope_deg", memory(&Memory::ground_slope_rad), between(0.0, 45.0),
                   "largest rise of the ground ahead against the vehicle's: its echoes are ignored")
          .integer("consistent_echoes", memory(&Memory::consistent_echoes), between(1, 20),
                   "readings of one sensor that must agree before they count")
          .integer("hits", memory(&Memory::hits), between(1, 20),
                   "readings that make a point an obstacle")
          .number("forget_s", "s", memory(&Memory::forget_s), kPositive,
                  "time after the last echo for which points 3 m away are kept")
          .rule([](const P& p) -> std::string {
            // Between the poses of a rollout nothing is checked.
            const DwaParams& own = p.guide.law;
            if (own.step_s <= own.horizon_s) return "";
            return fmt::format("step_s = {} s is longer than horizon_s = {} s", own.step_s,
                               own.horizon_s);
          })
          .rule([](const P& p) -> std::string {
            const DwaCost& own = p.guide.law.cost;
            if (own.clearance_weight > 0.0 || own.goal_weight > 0.0) return "";
            if (own.as_printed) return "clearance_weight and goal_weight are both 0";
            if (own.heading_weight > 0.0 || own.path_weight > 0.0) return "";
            return "clearance_weight, goal_weight, heading_weight and path_weight are all 0";
          });
  return table;
}

DwaPartParams read_dwa_params(const ParameterSet& parameters, const ControllerContext& context) {
  DwaPartParams params = dwa_table().read(parameters, who(context));
  DwaGuideParams& guide = params.guide;
  const VehicleDescription& vehicle = *context.vehicle_description;
  SteeredVehicle& geometry = guide.law.geometry;
  geometry = vehicle.need_steered(who(context));
  const auto demand = [&](double value, const char* name) {
    return vehicle.need_positive(value, name, who(context));
  };
  demand(geometry.front_axle_m, "front_axle_m");
  demand(geometry.rear_axle_m, "rear_axle_m");
  demand(geometry.max_axle_steer_rad, "max_axle_steer_rad");
  demand(geometry.steer_rate_radps, "steer_rate_radps");
  guide.speed_limit_mps =
      demand(vehicle.need(vehicle.max_speed_mps, "max_speed_mps", who(context)), "max_speed_mps");
  if (geometry.max_axle_steer_rad >= 0.5 * kPi) {
    throw ConfigError(
        fmt::format("{}: 'max_axle_steer_rad' of vehicle type '{}' is {}, must be < pi/2",
                    who(context), vehicle.type, geometry.max_axle_steer_rad));
  }
  const double stop_s = 0.5 * guide.speed_limit_mps / guide.law.acceleration_mps2;
  const double longest_s = std::max(guide.law.horizon_s, stop_s);
  if (longest_s > guide.law.step_s * Rollout::kMax) {
    const std::string cause =
        stop_s > guide.law.horizon_s
            ? fmt::format("stopping from {} m/s at acceleration_mps2 = {} m/s2",
                          guide.speed_limit_mps, guide.law.acceleration_mps2)
            : "horizon_s";
    throw ConfigError(fmt::format(
        "{}: rollouts of {:.6g} s ({}) need {:.0f} steps of step_s = {} s, at most {} are possible",
        who(context), longest_s, cause, std::ceil(longest_s / guide.law.step_s), guide.law.step_s,
        Rollout::kMax));
  }
  guide.plan.crab_slope = std::tan(geometry.max_axle_steer_rad);
  guide.reverse_speed_mps = std::min(guide.reverse_speed_mps, guide.speed_limit_mps);
  return params;
}

DiscOutline make_dwa_outline(const DwaPartParams& params, const ControllerContext& context) {
  const std::vector<Eigen::Vector2d> outline_B = context.vehicle_description->outline_B();
  if (params.footprint == DwaFootprint::kPolygon) return DiscOutline::polygon(outline_B);
  if (params.footprint == DwaFootprint::kCircle) return DiscOutline::circumscribed(outline_B);
  const DiscOutline circles =
      DiscOutline::three_circles(params.circle_radius_m, params.circle_spacing_m);
  const double uncovered_m = circles.uncovered_m(outline_B), margin_m = params.guide.plan.margin_m;
  if (uncovered_m > margin_m) {
    throw ConfigError(
        fmt::format("{}: circles of circle_radius_m = {} m, circle_spacing_m = {} m leave {:.3f} m "
                    "of the outline of vehicle type '{}' uncovered, more than margin_m = {} m",
                    who(context), params.circle_radius_m, params.circle_spacing_m, uncovered_m,
                    context.vehicle_description->type, margin_m));
  }
  return circles;
}

}  // namespace vinerow::controllers
