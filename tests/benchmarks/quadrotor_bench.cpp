/// A whole physics step of a world with one quadrotor: wind, rotors, ground effect, rigid body,
/// contact search, leaves. The aim away from contact: below 3 us.

#include <benchmark/benchmark.h>

#include "engine/api/map.h"
#include "tests/benchmarks/bench_worlds.h"
#include "vehicles/quadrotor/quadrotor.h"

namespace vinerow::quadrotor_bench {
namespace {

constexpr Duration kStep{1'000'000};

struct Flight {
  Flight(const WorldModel& the_model, double height_m)
      : model(the_model), world({}, model), drone({}, context()) {
    Pose X_WB;
    X_WB.p = {0.0, 0.0, model.terrain->height_m(0, 0) + drone.params().stand_height_m};
    drone.spawn(world, X_WB);
    start.X_WB = X_WB;
    start.X_WB.p.z() += height_m;
    start.v_WB_W.setZero();
    start.w_WB_W.setZero();
    stands = height_m == 0.0;
    again();
  }
  static VehicleContext context() {
    VehicleContext context;
    context.vehicle = context.part = "drone";
    return context;
  }
  /// Back to the place, before it has drifted off.
  void again() {
    if (stands) return;
    const double hover = drone.params().hover_radps();
    drone.set_motion(start, {hover, hover, hover, hover});
  }
  void step() {
    if (++steps % 500 == 0) again();
    drone.before_physics(now, kStep);
    world.step(kStep);
    now = now + kStep;
    drone.after_physics(now, kStep);
  }
  const WorldModel& model;
  physics::PhysicsWorld world;
  vehicles::Quadrotor drone;
  physics::BodyState start;
  bool stands = false;
  Time now;
  int steps = 0;
};

void measure(benchmark::State& state, const WorldModel& model, double height_m) {
  Flight flight(model, height_m);
  for (auto _ : state) flight.step();
  if (!flight.drone.crash().empty()) state.SkipWithError(std::string(flight.drone.crash()).c_str());
}

WorldModel windy_field() {
  WorldModel model = bench::rolling_field();
  model.wind.mean_speed_mps = 3.0;
  model.wind.turbulence = 1.0;
  model.wind.random_gusts = GustStatistics{.interval_s = 10.0};
  return model;
}

void step_of_quadrotor_high(benchmark::State& state) {
  measure(state, bench::rolling_field(), 30.0);
}
void step_of_quadrotor_at_1_5_m(benchmark::State& state) {
  measure(state, bench::rolling_field(), 1.5);
}
void step_of_quadrotor_at_1_5_m_in_wind(benchmark::State& state) {
  measure(state, windy_field(), 1.5);
}
void step_of_quadrotor_standing(benchmark::State& state) {
  measure(state, bench::rolling_field(), 0.0);
}
/// Beside a row of leaves, 0.45 m from the blades' tips.
void step_of_quadrotor_beside_leaves(benchmark::State& state) {
  static const auto vineyard = bench::make_world("vineyard");
  WorldModel model = *vineyard;
  const std::vector<Eigen::Vector3d>& line_W = model.rows->alleys.at(0).line_W;
  Flight flight(model, 1.5);
  const Eigen::Vector2d middle = 0.5 * (line_W.front() + line_W.back()).head<2>();
  flight.start.X_WB.p = {middle.x(), middle.y(),
                         model.terrain->height_m(middle.x(), middle.y()) + 1.5};
  flight.again();
  for (auto _ : state) flight.step();
  if (!flight.drone.crash().empty()) state.SkipWithError(std::string(flight.drone.crash()).c_str());
}
BENCHMARK(step_of_quadrotor_high)->Unit(benchmark::kMicrosecond);
BENCHMARK(step_of_quadrotor_at_1_5_m)->Unit(benchmark::kMicrosecond);
BENCHMARK(step_of_quadrotor_at_1_5_m_in_wind)->Unit(benchmark::kMicrosecond);
BENCHMARK(step_of_quadrotor_standing)->Unit(benchmark::kMicrosecond);
BENCHMARK(step_of_quadrotor_beside_leaves)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace vinerow::quadrotor_bench
