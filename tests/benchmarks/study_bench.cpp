/// The bare loop that `study_bench.py` sets a study beside: one session, reset for every run.

#include <benchmark/benchmark.h>

#include "tests/support/paths.h"
#include "vinerow/session.h"

namespace vinerow::study_bench {
namespace {

/// @param state  its argument is the number of runs, seeds from 1
void study_bare_loop(benchmark::State& state, const char* scenario) {
  const std::string file =
      std::string(VINEROW_SOURCE_DIR) + "/assets/scenarios/" + scenario + ".yaml";
  for (auto _ : state) {
    Session session = open_session(file);
    for (std::int64_t seed = 1; seed <= state.range(0); ++seed) {
      session.reset(static_cast<std::uint64_t>(seed));
      while (!session.over()) session.advance_for(Duration{1'000'000'000});
      benchmark::DoNotOptimize(session.digest());
    }
  }
}
BENCHMARK_CAPTURE(study_bare_loop, orchard_rover, "orchard_rover")
    ->Arg(100)
    ->Unit(benchmark::kSecond)
    ->Iterations(1);
BENCHMARK_CAPTURE(study_bare_loop, riseholme_rover, "riseholme_rover")
    ->Arg(20)
    ->Unit(benchmark::kSecond)
    ->Iterations(1);

}  // namespace
}  // namespace vinerow::study_bench
