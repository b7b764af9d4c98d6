/// What a probe of the wind costs a vehicle per physics step at 1 kHz, and what the shelter grid of
/// a parcel costs once.

#include <benchmark/benchmark.h>

#include "engine/api/map.h"
#include "engine/physics/physics_world.h"
#include "tests/benchmarks/bench_worlds.h"
#include "vehicles/parts/wind_probe.h"

namespace vinerow::wind_bench {
namespace {

constexpr Duration kStep{1'000'000};

/// A parcel like F in the middle of the field: 16 rows of 90 m, 2.5 m apart.
WorldModel windy_field(bool sheltered) {
  WorldModel world = bench::rolling_field();
  Wind& wind = world.wind;
  wind.mean_speed_mps = 3.0;
  wind.turbulence = 1.0;
  wind.gusts.push_back({.start_s = 10.0, .amplitude_mps = 1.0});
  wind.random_gusts = GustStatistics{.interval_s = 20.0};
  wind.shelter_attenuation = sheltered ? 1.2 : 0.0;
  for (int i = 0; i < 16; ++i) {
    const double y = 2.5 * i - 18.75;
    world.rows->rows.push_back({i, {{-45, y, 0}, {45, y, 0}}, 0.6, 0.5, 2.0});
    if (i > 0) world.rows->alleys.push_back({i, {{-45, y - 1.25, 0}, {45, y - 1.25, 0}}, 2.5});
  }
  return world;
}

/// Flies along an alley at 3 m/s.
void wind_sample(benchmark::State& state, bool sheltered) {
  const WorldModel model = windy_field(sheltered);
  const physics::PhysicsWorld world({}, model);
  vehicles::WindProbe probe(model, world.scene(), RandomStream(1, "drone", "wind"));
  const Eigen::Vector3d v_W(3.0, 0.0, 0.0);
  Eigen::Vector3d p_W(-40.0, 0.1, 1.5);
  Time now;
  for (auto _ : state) {
    benchmark::DoNotOptimize(probe.sample(now, p_W, v_W, kStep));
    now = now + kStep;
    p_W.x() += 0.003;
    if (p_W.x() > 40.0) p_W.x() = -40.0;
  }
}
BENCHMARK_CAPTURE(wind_sample, open, false)->Unit(benchmark::kNanosecond);
BENCHMARK_CAPTURE(wind_sample, sheltered, true)->Unit(benchmark::kNanosecond);

void wind_probe_building(benchmark::State& state) {
  const WorldModel model = windy_field(true);
  const physics::PhysicsWorld world({}, model);
  for (auto _ : state) {
    vehicles::WindProbe probe(model, world.scene(), RandomStream(1, "drone", "wind"));
    benchmark::DoNotOptimize(probe);
  }
}
BENCHMARK(wind_probe_building)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vinerow::wind_bench
