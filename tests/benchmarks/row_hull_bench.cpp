/// Row meshes from canopy points: 1, 4 and 16 rows of 118 m at 1500 points/m2, 15 mm noise. Points
/// per second must not fall with the number of rows.

#include <benchmark/benchmark.h>

#include "tests/worlds/mapping/hulls/synthetic_canopy.h"
#include "worlds/mapping/hulls/row_hull.h"

namespace vinerow::row_hull_bench {
namespace {

void bm_row_hulls(benchmark::State& state) {
  std::vector<mapping::RowCanopy> rows;
  std::int64_t points = 0;
  for (int i = 0; i < state.range(0); ++i) {
    rows.push_back(test::vine_row(i, 118.0, {.noise_m = 0.015}).canopy);
    points += static_cast<std::int64_t>(rows.back().points.size());
  }
  double bytes = 0.0;
  for (auto _ : state) {
    const auto hulls = mapping::make_row_hulls(rows, [](double, double) { return 0.0; });
    bytes = 0.0;
    for (const auto& row : hulls) bytes += static_cast<double>(row.mesh_bytes);
  }
  state.SetItemsProcessed(state.iterations() * points);
  state.counters["points"] = static_cast<double>(points);
  state.counters["bytes"] = bytes;
}
BENCHMARK(bm_row_hulls)->Arg(1)->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace vinerow::row_hull_bench
