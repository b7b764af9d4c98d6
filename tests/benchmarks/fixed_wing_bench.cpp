/// A whole physics step of a world with one fixed wing: wind, aerodynamics, servos and motor, rigid
/// body, contact search, leaves. Aim: below 2 us with wind.

#include <benchmark/benchmark.h>

#include "tests/benchmarks/bench_worlds.h"
#include "vehicles/fixed_wing/fixed_wing.h"

namespace vinerow::fixed_wing_bench {
namespace {

constexpr Duration kStep{1'000'000};

vehicles::FixedWingParams flying_params() {
  vehicles::FixedWingParams params;
  params.name = "plane";
  params.launch.mode = vehicles::LaunchMode::kAir;
  return params;
}

VehicleContext context() {
  VehicleContext context;
  context.vehicle = context.part = "plane";
  return context;
}

void measure(benchmark::State& state, const WorldModel& model) {
  physics::PhysicsWorld world({}, model);
  vehicles::FixedWing plane(flying_params(), context());
  Pose X_WB;
  X_WB.p = {0.0, 0.0, model.terrain->height_m(0, 0)};
  plane.spawn(world, X_WB);
  const physics::BodyState start = plane.body();
  const std::span<const double> trim = plane.actuator_states();
  const vehicles::FixedWing::Actuators actuators = {trim[0], trim[1], trim[2]};
  Time now;
  int steps = 0;
  for (auto _ : state) {
    if (++steps % 2000 == 0) plane.set_motion(start, actuators);
    plane.before_physics(now, kStep);
    world.step(kStep);
    now = now + kStep;
    plane.after_physics(now, kStep);
  }
  if (!plane.crash().empty()) state.SkipWithError(std::string(plane.crash()).c_str());
}

void step_of_fixed_wing_calm(benchmark::State& state) {
  measure(state, bench::rolling_field());
}
BENCHMARK(step_of_fixed_wing_calm);

void step_of_fixed_wing_in_wind(benchmark::State& state) {
  WorldModel model = bench::rolling_field();
  model.wind.mean_speed_mps = 3.0;
  model.wind.turbulence = 1.0;
  model.wind.turbulence_limit_mps = 1.0;
  measure(state, model);
}
BENCHMARK(step_of_fixed_wing_in_wind);

void step_of_fixed_wing_in_wind_us76(benchmark::State& state) {
  WorldModel model = bench::rolling_field();
  model.wind.mean_speed_mps = 3.0;
  model.wind.turbulence = 1.0;
  model.wind.atmosphere = Atmosphere::kStandard76;
  measure(state, model);
}
BENCHMARK(step_of_fixed_wing_in_wind_us76);

/// Loads alone: what trims and linear models call.
void load_of_fixed_wing(benchmark::State& state) {
  const vehicles::FixedWingModel model(flying_params());
  AirPoint air;
  air.v_air_B = {11.9, 0.2, -1.5};
  air.w_WB_B = {0.1, 0.2, -0.1};
  const std::array<double, 3> actuators = {0.6, 0.01, -0.02};
  for (auto _ : state) {
    benchmark::DoNotOptimize(air);
    benchmark::DoNotOptimize(model.load(air, actuators));
  }
}
BENCHMARK(load_of_fixed_wing);

}  // namespace
}  // namespace vinerow::fixed_wing_bench
