/// Planning with rrt_star on Parcel F: two rows over 20 seeds, and the whole parcel. Everything a
/// run pays for is timed: the distance field of the grid, the plan and its checks.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

#include "engine/api/map.h"
#include "engine/math/angles.h"
#include "tests/benchmarks/bench_worlds.h"

namespace vinerow::planning_bench {
namespace {

struct ParcelF {
  ParcelF() : world(bench::make_world("vineyard")) {
    register_all(registry);
    vehicle.type = "four_wheel_steering_rover";
    vehicle.footprint_B = {{0.95, -0.36}, {0.95, 0.36},   {0.75, 0.5},   {-0.75, 0.5},
                           {-0.95, 0.36}, {-0.95, -0.36}, {-0.75, -0.5}, {0.75, -0.5}};
    vehicle.min_turning_radius_m = 1.767;
  }

  std::unique_ptr<Planner> make(std::uint64_t seed, const std::vector<double>& alleys) const {
    PlannerContext context;
    context.seed = seed;
    context.vehicle = "rover";
    context.part = "rover.planner";
    context.map = &*world->rows;
    context.vehicle_description = &vehicle;
    ParameterSet parameters(registry.spec(PartKind::kPlanner, "rrt_star").parameters, "rrt_star");
    parameters.set("alleys", alleys);
    return registry.make_planner("rrt_star", parameters, context);
  }

  /// A metre before the first alley, heading in.
  Pose start() const {
    const auto& line = world->rows->alleys.front().line_W;
    const Eigen::Vector3d along = (line.back() - line.front()).normalized();
    return {quaternion_from_rpy({0, 0, std::atan2(along.y(), along.x())}), line.front() - along};
  }

  Registry registry;
  std::unique_ptr<WorldModel> world;
  VehicleDescription vehicle;
};

void plan_with_rrt_star(benchmark::State& state, const std::vector<double>& alleys, int seeds) {
  const ParcelF parcel;
  std::vector<double> times_s;
  double failures = 0.0;
  std::map<std::string, double> numbers;
  for (auto _ : state) {
    for (int seed = 1; seed <= seeds; ++seed) {
      const auto begin = std::chrono::steady_clock::now();
      const auto planner = parcel.make(static_cast<std::uint64_t>(seed), alleys);
      const auto path = planner->plan(parcel.start());
      times_s.push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
      failures += path.ok() ? 0.0 : 1.0;
      if (!path.ok()) state.SkipWithError(path.reason().c_str());
      numbers = planner->report()->numbers;
    }
  }
  std::sort(times_s.begin(), times_s.end());
  state.counters["median_ms"] = 1e3 * times_s[times_s.size() / 2];
  state.counters["max_ms"] = 1e3 * times_s.back();
  state.counters["failures"] = failures;
  for (const char* name : {"turn_clearance_m", "first_turn_length_m", "turn_length_m", "nodes"}) {
    state.counters[name] = numbers[name];
  }
}

BENCHMARK_CAPTURE(plan_with_rrt_star, two_rows, {0, 1}, 20)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(plan_with_rrt_star, whole_parcel, {}, 3)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace vinerow::planning_bench
