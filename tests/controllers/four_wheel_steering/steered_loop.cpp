#include "tests/controllers/four_wheel_steering/steered_loop.h"

#include <cmath>

#include "controllers/four_wheel_steering/four_wheel_steering.h"
#include "controllers/parts/paths/path_pieces.h"
#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::test {
namespace {

constexpr Duration kCycle{20'000'000};
constexpr double kPitch_m = 0.2;

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

std::unique_ptr<Controller> make_steered_controller(const Values& values,
                                                    const VehicleDescription& description) {
  ControllerContext context;
  context.vehicle = "rover";
  context.part = "rover.controller";
  context.period = kCycle;
  context.vehicle_description = &description;
  ParameterSet parameters(controllers::four_wheel_steering_spec().parameters,
                          "four_wheel_steering");
  for (const auto& [name, value] : values) parameters.set(name, value);
  return controllers::make_four_wheel_steering(parameters, context);
}

SteeredLoop::SteeredLoop(const LoopOptions& options, const controllers::Pose2& start)
    : description_(make_steered_description()),
      plant_({start.p + options.offset_m, start.yaw_rad + options.heading_error_rad},
             options.plant),
      has_encoders_(options.encoders) {
  description_.steered->steer_lag_s = options.plant.servo_lag_s;
  Ports world(bus_, "rover", "test");
  estimate_ = world.write<Odometry>("estimate");
  plan_ = world.write<PlannedPath>("plan");
  local_ = world.write<LocalCommand>("local_command");
  if (has_encoders_) encoders_ = world.write<NamedValues>("encoders");
  controller_ = make_steered_controller(options.parameters, description_);
  Ports ports(bus_, "rover", "rover.controller");
  controller_->connect(ports);
  actuators_ = world.read<NamedValues>("actuators");
  steering_ = world.read<NamedValues>("steering");
  follower_ = world.read<FollowerState>("follower");
  command_ = world.read<VelocityCommand>("command");
  event_ = world.read<Event>("controller_event");
  bus_.check_connected();
}

void SteeredLoop::step() {
  estimate_.write(now_, plant_.truth());
  if (has_encoders_) {
    encoders_.write(now_, {{"axle_rear_steer_rad", "axle_front_steer_rad"},
                           {plant_.rear_rad(), plant_.front_rad()}});
  }
  controller_->step(now_);
  plant_.drive(actuators_.value().values, kCycle.s());
  now_ = now_ + kCycle;
}

double SteeredLoop::steering(const std::string& name) const {
  const NamedValues& values = steering_.value();
  for (std::size_t i = 0; i < values.names.size(); ++i) {
    if (values.names[i] == name) return values.values[i];
  }
  VINEROW_DEMAND(false);
  return 0.0;
}

Tracking track(const PlannedPath& plan, const LoopOptions& options) {
  const PathPoint& first = plan.points.front();
  SteeredLoop loop(options, {first.p_W.head<2>(), first.yaw_rad});
  loop.set_plan(plan);
  const controllers::Path path(plan);
  Tracking result;
  double leg2 = 0.0, turn2 = 0.0;
  int legs = 0, turns = 0;
  for (; loop.now().s() < options.longest_s && !loop.controller().finished();) {
    loop.step();
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
  result.finished = loop.controller().finished();
  result.time_s = loop.now().s();
  if (legs > 0) result.leg_rms_m = std::sqrt(leg2 / legs);
  if (turns > 0) result.turn_rms_m = std::sqrt(turn2 / turns);
  result.rms_m = std::sqrt((leg2 + turn2) / std::max(legs + turns, 1));
  return result;
}

}  // namespace vinerow::test
