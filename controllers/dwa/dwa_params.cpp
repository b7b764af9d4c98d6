#include "controllers/dwa/dwa_params.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

std::string who(const ControllerContext& context) {
  return context.part + " (dwa)";
}

}  // namespace

std::vector<ParameterSpec> dwa_parameters() {
  return {
      choice_parameter("mode", "assist", {"assist", "pure"},
                       "assist: follow the plan where it is free; pure: always drive by samples"),
      choice_parameter("footprint", "circles", {"circles", "polygon", "circle"},
                       "outline in rollouts: three circles, the polygon, or one circle around it"),
      positive_parameter("circle_radius_m", "m", 0.56, "radius of each of the three circles"),
      positive_parameter("circle_spacing_m", "m", 0.5,
                         "distance of the outer circles' centres from the vehicle's centre"),
      choice_parameter("cost", "corrected", {"corrected", "printed"},
                       "printed: J = alpha d_O + beta d_goal of eq. (23), which drives away"),
      positive_parameter("speed_mps", "m/s", 0.8, "highest speed where the plan tells none"),
      positive_parameter("acceleration_mps2", "m/s2", 0.5, "speeding up and braking"),
      positive_parameter("window_s", "s", 0.2, "the dynamic window is what this time allows"),
      positive_parameter("horizon_s", "s", 1.4, "length of the rollouts"),
      positive_parameter("step_s", "s", 0.1, "time between poses of a rollout that are checked"),
      integer_parameter("speed_samples", 4, 2, 50, "speeds tried"),
      integer_parameter("steer_samples", 9, 3, 51, "angles tried per axle"),
      number_parameter("clearance_weight", "1/m", 0.4, 0.0, 1e3, "alpha, of the room at the end"),
      number_parameter("goal_weight", "1/m", 1.0, 0.0, 1e3,
                       "beta, of the distance to the point ahead on the plan"),
      number_parameter("heading_weight", "1/rad", 0.3, 0.0, 1e3, "zeta, of the heading error"),
      number_parameter("path_weight", "1/m", 3.0, 0.0, 1e3,
                       "eta, of the mean distance from the path"),
      positive_parameter("clearance_saturation_m", "m", 0.6, "d_sat: more room is worth no more"),
      number_parameter("lookahead_m", "m", 1.4, 0.2, 4.0, "how far ahead on the plan the goal is"),
      number_parameter("margin_m", "m", 0.05, 0.0, 1.0, "room to keep to what the map knows"),
      number_parameter("follow_margin_m", "m", 0.02, -1.0, 1.0,
                       "the same while following the plan, which was checked with a margin of its "
                       "own; negative: following may cut so far into what the map has, for walls "
                       "that are virtual"),
      number_parameter("obstacle_margin_m", "m", 0.15, 0.0, 1.0,
                       "room to keep to what only the sensors saw"),
      number_parameter("pass_m", "m", 0.7, 0.0, 2.0,
                       "how far beside the plan a way past an obstacle is looked for"),
      positive_parameter("fade_m", "m", 1.2,
                         "length over which the tracking controller is taken to lose its error"),
      positive_parameter("reverse_speed_mps", "m/s", 0.4, "speed backwards out of a jam"),
      number_parameter("reverse_s", "s", 2.0, 0.0, 60.0, "longest way back out of a jam"),
      integer_parameter("max_recoveries", 3, 0, 100, "ways back before it stands"),
      positive_parameter("stall_s", "s", 2.0, "no progress for this long is a jam"),
      positive_parameter("retry_s", "s", 5.0, "how often it tries again when it stands"),
      number_parameter("look_back_s", "s", 6.0, 0.0, 60.0,
                       "longest way back of every fourth try, to see from afar what is there"),
      number_parameter("finish_m", "m", 0.3, 0.0, 2.0,
                       "so near the plan's end the tracking controller takes over"),
      number_parameter("obstacle_range_m", "m", 2.5, 0.0, 20.0,
                       "echoes from farther are left out; 0 = no sensor is listened to"),
      positive_parameter("map_tolerance_m", "m", 0.25,
                         "an echo so near to something on the map comes from there"),
      number_parameter(
          "ground_slope_deg", "deg", 5.0, 0.0, 45.0,
          "ground ahead may rise so much against the vehicle's: echoes of it are left out"),
      integer_parameter("consistent_echoes", 2, 1, 20,
                        "readings of one sensor that must agree before they count"),
      integer_parameter("hits", 2, 1, 20, "readings that make a point an obstacle"),
      positive_parameter("forget_s", "s", 30.0,
                         "points 3 m away are kept so long after their last echo"),
  };
}

DwaGuideParams read_dwa_params(const ParameterSet& parameters, const ControllerContext& context) {
  DwaGuideParams params;
  params.mode = parameters.text("mode") == "pure" ? DwaMode::kPure : DwaMode::kAssist;
  const VehicleDescription& vehicle = *context.vehicle_description;
  SteeredVehicle& geometry = params.law.geometry;
  geometry = vehicle.need_steered(who(context));
  const auto demand = [&](double value, const char* name) {
    return vehicle.need_positive(value, name, who(context));
  };
  demand(geometry.front_axle_m, "front_axle_m");
  demand(geometry.rear_axle_m, "rear_axle_m");
  demand(geometry.max_axle_steer_rad, "max_axle_steer_rad");
  demand(geometry.steer_rate_radps, "steer_rate_radps");
  params.speed_limit_mps = demand(
      vehicle.need(vehicle.max_speed_mps, "max_speed_mps", who(context)), "max_speed_mps");
  if (geometry.max_axle_steer_rad >= 0.5 * kPi) {
    throw ConfigError(
        fmt::format("{}: 'max_axle_steer_rad' of vehicle type '{}' is {}, must be < pi/2",
                    who(context), vehicle.type, geometry.max_axle_steer_rad));
  }
  params.speed_mps = parameters.number("speed_mps");
  params.law.acceleration_mps2 = parameters.number("acceleration_mps2");
  params.law.window_s = parameters.number("window_s");
  params.law.horizon_s = parameters.number("horizon_s");
  params.law.step_s = parameters.number("step_s");
  const double longest_s =
      std::max(params.law.horizon_s, 0.5 * params.speed_limit_mps / params.law.acceleration_mps2);
  if (longest_s > params.law.step_s * Rollout::kMost) {
    throw ConfigError(fmt::format(
        "{}: rollouts of {} s (horizon_s, or stopping from {} m/s) need {:.0f} steps of "
        "step_s = {} s, at most {} are kept",
        who(context), longest_s, params.speed_limit_mps, std::ceil(longest_s / params.law.step_s),
        params.law.step_s, Rollout::kMost));
  }
  params.law.speeds = static_cast<int>(parameters.integer("speed_samples"));
  params.law.steers = static_cast<int>(parameters.integer("steer_samples"));
  DwaCost& cost = params.law.cost;
  cost.clearance_weight = parameters.number("clearance_weight");
  cost.goal_weight = parameters.number("goal_weight");
  cost.heading_weight = parameters.number("heading_weight");
  cost.path_weight = parameters.number("path_weight");
  cost.saturation_m = parameters.number("clearance_saturation_m");
  cost.as_printed = parameters.text("cost") == "printed";
  params.lookahead_m = parameters.number("lookahead_m");
  params.plan.margin_m = parameters.number("margin_m");
  params.plan.follow_margin_m = parameters.number("follow_margin_m");
  params.plan.obstacle_margin_m = parameters.number("obstacle_margin_m");
  params.plan.lane_most_m = parameters.number("pass_m");
  params.plan.fade_m = parameters.number("fade_m");
  params.plan.crab_slope = std::tan(geometry.max_axle_steer_rad);
  params.reverse_speed_mps =
      std::min(parameters.number("reverse_speed_mps"), params.speed_limit_mps);
  params.recovery.reverse_s = parameters.number("reverse_s");
  params.recovery.max_recoveries = static_cast<int>(parameters.integer("max_recoveries"));
  params.recovery.stall_s = parameters.number("stall_s");
  params.recovery.retry_s = parameters.number("retry_s");
  params.recovery.look_back_s = parameters.number("look_back_s");
  params.finish_m = parameters.number("finish_m");
  return params;
}

DiscOutline read_dwa_outline(const ParameterSet& parameters, const ControllerContext& context) {
  const std::vector<Eigen::Vector2d> outline_B = context.vehicle_description->outline_B();
  const std::string& kind = parameters.text("footprint");
  if (kind == "polygon") return DiscOutline::polygon(outline_B);
  if (kind == "circle") return DiscOutline::circumscribed(outline_B);
  const double radius_m = parameters.number("circle_radius_m");
  const double spacing_m = parameters.number("circle_spacing_m");
  const DiscOutline circles = DiscOutline::three_circles(radius_m, spacing_m);
  const double uncovered_m = circles.uncovered_m(outline_B),
               margin_m = parameters.number("margin_m");
  if (uncovered_m > margin_m) {
    throw ConfigError(
        fmt::format("{}: circles of circle_radius_m = {} m, circle_spacing_m = {} m leave {:.3f} m "
                    "of the outline of vehicle type '{}' uncovered, more than margin_m = {} m",
                    who(context), radius_m, spacing_m, uncovered_m,
                    context.vehicle_description->type, margin_m));
  }
  return circles;
}

ObstacleMemoryParams read_obstacle_memory_params(const ParameterSet& parameters) {
  ObstacleMemoryParams params;
  params.obstacle_range_m = parameters.number("obstacle_range_m");
  params.map_tolerance_m = parameters.number("map_tolerance_m");
  params.ground_slope_rad = rad_from_deg(parameters.number("ground_slope_deg"));
  params.consistent_echoes = static_cast<int>(parameters.integer("consistent_echoes"));
  params.hits = static_cast<int>(parameters.integer("hits"));
  params.forget_s = parameters.number("forget_s");
  return params;
}

}  // namespace vinerow
