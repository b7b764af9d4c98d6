/// A physics step and the scheduler's share of it.

#include <benchmark/benchmark.h>

#include "engine/physics/physics_world.h"
#include "engine/sim/scheduler.h"
#include "tests/benchmarks/bench_worlds.h"
#include "tests/benchmarks/driving_rover.h"

namespace vinerow::kernel_bench {
namespace {

constexpr Duration kStep{1'000'000};

physics::BodySpec ball(const Eigen::Vector3d& p) {
  physics::BodySpec spec;
  spec.name = "ball";
  spec.mass_kg = 1.0;
  spec.inertia_B = Eigen::Vector3d(0.01, 0.02, 0.03).asDiagonal();
  spec.X_WB.p = p;
  spec.v_WB_W = {0, 0, 50};  // stays in the air
  spec.w_WB_W = {1, 2, 3};
  spec.shapes.push_back({physics::SphereShape{0.2}, {}});
  return spec;
}

/// Throws the balls again before they land: every 8 s of simulated time, 50 m/s upwards last 10 s.
constexpr int kThrowAgain = 8000;

void throw_balls(physics::PhysicsWorld& world, const std::vector<physics::BodyId>& balls) {
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const physics::BodySpec spec = ball({5.0 * static_cast<double>(i) + 5.0, 0, 50});
    world.set_state(balls[i], {spec.X_WB, spec.v_WB_W, spec.w_WB_W});
  }
}

/// One rover and `state.range(0)` flying bodies on a 200 x 200 height field at 1 kHz; the rover
/// drives.
void step_of_rover_and_bodies(benchmark::State& state) {
  const WorldModel model = bench::rolling_field();
  bench::DrivingRover rover(model, kStep);
  std::vector<physics::BodyId> balls;
  for (int i = 0; i < state.range(0); ++i)
    balls.push_back(rover.world().add_body(ball({5.0 * i + 5.0, 0, 50})));
  int steps = 0;
  for (auto _ : state) {
    if (++steps % kThrowAgain == 0) throw_balls(rover.world(), balls);
    rover.step();
  }
}
BENCHMARK(step_of_rover_and_bodies)->Arg(0)->Arg(2)->Unit(benchmark::kMicrosecond);

/// The same world without the rover: what Bullet and the free-body update cost.
void step_of_two_bodies(benchmark::State& state) {
  const WorldModel model = bench::rolling_field();
  physics::PhysicsWorld world({}, model);
  std::vector<physics::BodyId> balls;
  for (int i = 0; i < 2; ++i) balls.push_back(world.add_body(ball({5.0 * i + 5.0, 0, 50})));
  int steps = 0;
  for (auto _ : state) {
    if (++steps % kThrowAgain == 0) throw_balls(world, balls);
    world.step(kStep);
  }
}
BENCHMARK(step_of_two_bodies)->Unit(benchmark::kMicrosecond);

/// Ten tasks at 5 to 100 Hz under a 1 kHz step: cost per step.
void scheduler_overhead(benchmark::State& state) {
  Scheduler scheduler(kStep);
  std::int64_t ticks = 0;
  for (const double rate_Hz : {5.0, 10.0, 20.0, 20.0, 40.0, 40.0, 50.0, 100.0, 100.0, 100.0}) {
    scheduler.add(Stage::kSense, "task", period_of_rate(rate_Hz), {}, [&ticks](Time) { ++ticks; });
  }
  Time now;
  for (auto _ : state) {
    scheduler.run_due(now);
    now = now + kStep;
  }
  benchmark::DoNotOptimize(ticks);
}
BENCHMARK(scheduler_overhead)->Unit(benchmark::kNanosecond);

}  // namespace
}  // namespace vinerow::kernel_bench
