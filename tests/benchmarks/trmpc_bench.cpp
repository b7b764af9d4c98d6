/// A whole tick of the controller trmpc, both axes: deviations, problems, mixing, signals; on the
/// plain aircraft of aircraft_sim.h. `case` 0: gusts of 1 m/s about a straight leg, where no QP is
/// needed; 1: ten starts 14 m low and 24 deg off, the ticks with active limits alone; 2: the same
/// with a horizon of 60 ticks. Counters: median, 90th and 99th percentile and the largest in
/// microseconds of processor time, how many ticks they are of, and the set-up in milliseconds. The
/// aim: 60 us in the median.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "tests/controllers/trmpc/wing_setup.h"

namespace vinerow::test::trmpc_bench {
namespace {

double processor_us() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

void tick_of_trmpc(benchmark::State& state) {
  const bool is_stressed = state.range(0) > 0;
  WingSetup setup;
  if (is_stressed) {
    setup.higher_m = -14.0;
    setup.turned_rad = 24.0 * M_PI / 180.0;
  }
  if (state.range(0) == 2) setup.controller.values = {{"horizon", std::int64_t{60}}};
  std::vector<double> ticks_us;
  double setup_us = 0.0;
  for (auto _ : state) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const double begin_us = processor_us();
      AircraftLoop loop(setup);
      setup_us = processor_us() - begin_us;
      GaussMarkovGust gust(seed);
      for (int k = 0; k < 240; ++k) {
        loop.sense();
        const double start_us = processor_us();
        loop.decide();
        const double took_us = processor_us() - start_us;
        loop.sim().set_body_gust(gust.next());
        loop.move();
        const bool is_active =
            loop.value("tube", "lon_active_rows") + loop.value("tube", "lat_active_rows") > 0.0;
        if (is_active == is_stressed) ticks_us.push_back(took_us);
      }
    }
  }
  std::sort(ticks_us.begin(), ticks_us.end());
  const auto at = [&](double share) {
    return ticks_us[static_cast<std::size_t>(share * static_cast<double>(ticks_us.size() - 1))];
  };
  state.counters["median_us"] = at(0.5);
  state.counters["p90_us"] = at(0.9);
  state.counters["p99_us"] = at(0.99);
  state.counters["max_us"] = at(1.0);
  state.counters["ticks"] = static_cast<double>(ticks_us.size());
  state.counters["setup_ms"] = 1e-3 * setup_us;
}
BENCHMARK(tick_of_trmpc)
    ->Arg(0)
    ->Arg(1)
    ->Arg(2)
    ->ArgName("case")
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
}  // namespace vinerow::test::trmpc_bench
