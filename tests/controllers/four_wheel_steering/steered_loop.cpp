#include "tests/controllers/four_wheel_steering/steered_loop.h"

#include <cmath>

#include "controllers/parts/paths/path_pieces.h"
#include "engine/math/angles.h"

namespace vinerow::test {
namespace {

constexpr Duration kCycle{20'000'000};
constexpr double kPitch_m = 0.2;

VehicleDescription describe(const LoopOptions& options) {
  VehicleDescription description = make_steered_description();
  description.steered->steer_lag_s = options.plant.servo_lag_s;
  return description;
}

}  // namespace

PlannedPath make_straight_plan(double length_m, double heading_rad) {
  return controllers::make_planned_path(
      {controllers::make_straight({0, 0}, length_m * controllers::direction(heading_rad),
                                  PathKind::kLeg, 0, 0.0)},
      kPitch_m);
}

PlannedPath make_omega(double radius_m, double spacing_m, double length_m, double heading_rad) {
  const Eigen::Vector2d t = controllers::direction(heading_rad), side = spacing_m * left_of(t);
  const controllers::Pose2 out{length_m * t, heading_rad},
      back{length_m * t + side, heading_rad + kPi};
  std::vector<controllers::PathSegment> pieces = {
      controllers::make_straight({0, 0}, out.p, PathKind::kLeg, 0, 0.0)};
  controllers::append_dubins(out, controllers::calc_dubins(out, back, radius_m), PathKind::kTurn,
                             0.0, pieces);
  pieces.push_back(controllers::make_straight(back.p, side, PathKind::kLeg, 1, 0.0));
  return controllers::make_planned_path(pieces, kPitch_m);
}

SteeredLoop::SteeredLoop(const LoopOptions& options, const controllers::Pose2& start)
    : Loop({.description = describe(options), .tick = kCycle}),
      plant_({start.p + options.offset_m, start.yaw_rad + options.heading_error_rad},
             options.plant) {
  add_controller({"four_wheel_steering", options.parameters});
  set_plant(plant_);
  if (!options.encoders) return;
  set_inputs([this] {
    write("encoders", NamedValues{{"axle_rear_steer_rad", "axle_front_steer_rad"},
                                  {plant_.rear_rad(), plant_.front_rad()}});
  });
}

Tracking track(const PlannedPath& plan, const LoopOptions& options) {
  const PathPoint& first = plan.points.front();
  SteeredLoop loop(options, {first.p_W.head<2>(), first.yaw_rad});
  loop.give_plan(plan);
  const controllers::Path path(plan);
  Tracking result;
  double leg2 = 0.0, turn2 = 0.0;
  int legs = 0, turns = 0;
  for (; loop.time_s() < options.longest_s && !loop.finished();) {
    loop.tick();
    const double along = loop.follower().distance_m;
    const controllers::Path::Nearest at =
        path.nearest(loop.plant().pose().p, along - 1.0, along + 1.0);
    if (at.distance_m < options.settle_m) continue;
    const double e = at.lateral_error_m;
    const bool is_leg = plan.points[at.segment].kind == PathKind::kLeg;
    (is_leg ? leg2 : turn2) += e * e;
    ++(is_leg ? legs : turns);
    result.max_m = std::max(result.max_m, std::abs(e));
  }
  result.finished = loop.finished();
  result.time_s = loop.time_s();
  if (legs > 0) result.leg_rms_m = std::sqrt(leg2 / legs);
  if (turns > 0) result.turn_rms_m = std::sqrt(turn2 / turns);
  result.rms_m = std::sqrt((leg2 + turn2) / std::max(legs + turns, 1));
  return result;
}

}  // namespace vinerow::test
