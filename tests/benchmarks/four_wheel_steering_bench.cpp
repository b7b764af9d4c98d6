/// A whole step of the controller four_wheel_steering: path, steering law, wheel speed QP, signals.
/// The aim: <= 10 us median (--benchmark_repetitions=20).

#include <benchmark/benchmark.h>

#include "controllers/four_wheel_steering/four_wheel_steering.h"
#include "controllers/four_wheel_steering/wheel_speed_qp.h"
#include "controllers/parts/paths/path_curve.h"
#include "controllers/parts/paths/path_pieces.h"
#include "engine/math/angles.h"

namespace vinerow::four_wheel_steering_bench {
namespace {

VehicleDescription steered_rover() {
  VehicleDescription description;
  description.type = "four_wheel_steering_rover";
  const double limit = rad_from_deg(23.0);
  description.actuators = {{"axle_front_steer_rad", "rad", -limit, limit},
                           {"axle_rear_steer_rad", "rad", -limit, limit}};
  for (const char* wheel : {"fl", "fr", "rl", "rr"}) {
    description.actuators.push_back(
        {std::string("wheel_") + wheel + "_speed_radps", "rad/s", -8.0, 8.0});
  }
  description.wheeled = {
      .track_m = 0.85, .wheel_radius_m = 0.2, .wheel_speed_limit_radps = 8.0};
  description.steered = {.front_axle_m = 0.75,
                         .rear_axle_m = 0.75,
                         .max_axle_steer_rad = limit,
                         .steer_rate_radps = 2.0};
  return description;
}

PlannedPath omega() {
  const controllers::Pose2 out{{15.0, 0.0}, 0.0}, back{{15.0, 2.5}, kPi};
  std::vector<controllers::PathSegment> pieces = {controllers::make_straight({0, 0}, out.p, PathKind::kLeg, 0, 0.0)};
  controllers::append_dubins(out, controllers::calc_dubins(out, back, 1.77), PathKind::kTurn, 0.0, pieces);
  pieces.push_back(controllers::make_straight(back.p, {0.0, 2.5}, PathKind::kLeg, 1, 0.0));
  return controllers::make_planned_path(pieces, 0.2);
}

/// Two rows and the turn between them at 0.8 m/s, a few millimetres beside the path.
void step_of_four_wheel_steering(benchmark::State& state) {
  const VehicleDescription description = steered_rover();
  ControllerContext context;
  context.vehicle = "rover";
  context.part = "rover.controller";
  context.period = Duration{20'000'000};
  context.vehicle_description = &description;
  ParameterSet parameters(controllers::four_wheel_steering_spec().parameters, "four_wheel_steering");
  if (state.range(0) > 0) parameters.set("wheel_acceleration_mps2", 2.0);
  const auto controller = controllers::make_four_wheel_steering(parameters, context);
  SignalBus bus;
  Ports world(bus, "rover", "bench"), ports(bus, "rover", "rover.controller");
  auto estimate = world.write<Odometry>("estimate");
  auto plan = world.write<PlannedPath>("plan");
  controller->connect(ports);
  const PlannedPath planned = omega();
  const controllers::Path path(planned);
  std::vector<Odometry> poses;
  for (double s = 0.0; s < path.length_m() - 0.1; s += 0.016) {
    const controllers::Pose2 pose = path.pose_at(s);
    const Eigen::Vector2d p = pose.p + 0.003 * std::sin(2.0 * s) * left_of(controllers::direction(pose.yaw_rad));
    Odometry odometry;
    odometry.X_WB = {quaternion_from_rpy({0.05, 0.02, pose.yaw_rad}), {p.x(), p.y(), 0.0}};
    odometry.v_WB_B = {0.8, 0.01 * std::sin(s), 0.0};
    odometry.w_WB_B.z() = 0.8 * path.curvature_at(s);
    poses.push_back(odometry);
  }
  std::size_t i = poses.size();
  Time now;
  for (auto _ : state) {
    if (i == poses.size()) {
      state.PauseTiming();
      i = 0;
      plan.write(now, planned);
      estimate.write(now, poses[0]);
      controller->step(now);
      state.ResumeTiming();
    }
    estimate.write(now, poses[i++]);
    controller->step(now);
    now = now + context.period;
  }
}
BENCHMARK(step_of_four_wheel_steering)
    ->Arg(0)
    ->Arg(1)
    ->ArgName("wheel_acceleration")
    ->Unit(benchmark::kMicrosecond);

void wheel_speed_qp(benchmark::State& state) {
  controllers::WheelSpeedQp qp({});
  int i = 0;
  for (auto _ : state) {
    const double angle = 0.4 * std::sin(0.01 * i++);
    benchmark::DoNotOptimize(qp.solve(controllers::calc_rolling({}, {angle, -0.9 * angle}), 0.8));
  }
}
BENCHMARK(wheel_speed_qp)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace vinerow::four_wheel_steering_bench
