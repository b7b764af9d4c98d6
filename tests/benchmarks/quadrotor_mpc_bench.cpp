/// A whole tick of the controller quadrotor_mpc: reference, observer, 16-state MPC with all soft
/// rows, mixer, signals. Estimates and references are those of a flight flown beforehand with the
/// same controller: two rows of 60 m and the omega turn in 3 m/s wind with 1 m/s gusts, or,
/// `upset`, ten starts 2 m off with 40 deg of tilt and 5 m/s. Counters: median and 99th percentile
/// in microseconds of processor time, the largest tick, and the mean changes of the active set. The
/// aim: 100 us in the median.

#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <ctime>
#include <vector>

#include "engine/core/random.h"
#include "tests/controllers/quadrotor_mpc/mpc_flight.h"

namespace vinerow::test::quadrotor_mpc_bench {
namespace {

double processor_us() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

void upset(QuadrotorSim& sim, RandomStream& random) {
  const double towards = random.uniform(-M_PI, M_PI);
  const Eigen::Vector3d side(std::cos(towards), std::sin(towards), 0.0);
  sim.state().p_W += 2.0 * side;
  sim.state().v_W += 5.0 * side;
  sim.state().q_WB = Eigen::AngleAxisd(0.7, side);
}

/// Flies until `end_s` and adds the time of each tick.
void fly(QuadrotorLoop& loop, double end_s, std::vector<double>& ticks_us, double& changes) {
  while (loop.time_s() < end_s) {
    loop.sense();
    const double begin = processor_us();
    loop.decide();
    ticks_us.push_back(processor_us() - begin);
    loop.move();
    changes += loop.value("mpc", "qp_iterations");
  }
}

void tick_of_quadrotor_mpc(benchmark::State& state) {
  const bool is_upset = state.range(0) > 0;
  MpcSetup setup;
  setup.physics = Duration{5'000'000};
  std::vector<double> ticks_us;
  double changes = 0.0;
  for (auto _ : state) {
    if (is_upset) {
      setup.path = straight({0, 0, 5}, 0.3, 3.0);
      RandomStream random(1, "bench", "upset");
      for (int i = 0; i < 10; ++i) {
        QuadrotorLoop loop(setup);
        upset(loop.sim(), random);
        fly(loop, 5.0, ticks_us, changes);
      }
    } else {
      const RowsAndTurn rows = make_rows_and_turn();
      setup.path = rows.path;
      QuadrotorLoop loop(setup);
      loop.sim().set_wind(gusty_wind({0, 3, 0}, 1.0, 4.0, rows.end_s, 1, 3));
      fly(loop, rows.end_s - 1.0, ticks_us, changes);
    }
  }
  std::sort(ticks_us.begin(), ticks_us.end());
  const auto at = [&](double share) {
    return ticks_us[static_cast<std::size_t>(share * static_cast<double>(ticks_us.size() - 1))];
  };
  state.counters["median_us"] = at(0.5);
  state.counters["p99_us"] = at(0.99);
  state.counters["max_us"] = at(1.0);
  state.counters["changes"] = changes / static_cast<double>(ticks_us.size());
}
BENCHMARK(tick_of_quadrotor_mpc)->Arg(0)->Arg(1)->ArgName("upset")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vinerow::test::quadrotor_mpc_bench
