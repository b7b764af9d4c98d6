/// Whole runs: real-time factor of the demo, log included, without pictures; and the size of its
/// log per hour.

#include <benchmark/benchmark.h>

#include <filesystem>

#include "engine/run/run.h"
#include "tests/support/paths.h"
#include "tools/parts/register_all.h"

namespace vinerow::scenario_bench {
namespace {

void whole_scenario(benchmark::State& state, const char* name) {
  Registry registry;
  register_all(registry);
  const scenario::Scenario scenario = scenario::load_scenario(
      std::string(VINEROW_SOURCE_DIR) + "/assets/scenarios/" + name + ".yaml", registry);
  run::RunOptions options;
  options.out = std::filesystem::temp_directory_path() / "vinerow_bench_run";
  options.pictures = false;
  run::RunResult result;
  for (auto _ : state) result = run::run_scenario(scenario, registry, options);
  state.counters["real_time_factor"] = result.real_time_factor();
  state.counters["simulated_s"] = result.simulated_s;
  state.counters["log_MB_per_hour"] =
      static_cast<double>(std::filesystem::file_size(options.out / "log.mcap")) * 1e-6 * 3600.0 /
      result.simulated_s;
  std::filesystem::remove_all(options.out);
}
BENCHMARK_CAPTURE(whole_scenario, riseholme_rover, "riseholme_rover")
    ->Unit(benchmark::kSecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(whole_scenario, orchard_rover, "orchard_rover")
    ->Unit(benchmark::kSecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(whole_scenario, vineyard_quadrotor, "vineyard_quadrotor_two_rows")
    ->Unit(benchmark::kSecond)
    ->Iterations(3);
BENCHMARK_CAPTURE(whole_scenario, survey, "survey_turbulence")
    ->Unit(benchmark::kSecond)
    ->Iterations(3);

}  // namespace
}  // namespace vinerow::scenario_bench
