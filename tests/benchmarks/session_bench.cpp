/// Sessions: a reset against opening a new session, in CPU time.

#include <benchmark/benchmark.h>

#include "tests/support/paths.h"
#include "vinerow/session.h"

namespace vinerow::session_bench {
namespace {

std::string file_of(const char* name) {
  return std::string(VINEROW_SOURCE_DIR) + "/assets/scenarios/" + name + ".yaml";
}

void open_anew(benchmark::State& state, const char* name) {
  std::uint64_t seed = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(open_session(file_of(name), {{}, ++seed}).now());
  }
}

void reset(benchmark::State& state, const char* name) {
  Session session = open_session(file_of(name));
  std::uint64_t seed = 0;
  for (auto _ : state) session.reset(++seed);
}

BENCHMARK_CAPTURE(open_anew, riseholme_rover, "riseholme_rover")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(5);
BENCHMARK_CAPTURE(reset, riseholme_rover, "riseholme_rover")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(50);
BENCHMARK_CAPTURE(open_anew, vineyard_quadrotor, "vineyard_quadrotor_two_rows")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(5);
BENCHMARK_CAPTURE(reset, vineyard_quadrotor, "vineyard_quadrotor_two_rows")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(50);

}  // namespace
}  // namespace vinerow::session_bench
