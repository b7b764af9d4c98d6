/// From points to a map, reading the file left out: Parcel F at three densities, so that the points
/// are 0.7, 7 and 28 million. Points per second must not fall.

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include "tests/worlds/mapping/photogrammetry/synthetic_parcel.h"
#include "worlds/mapping/pipeline/make_cloud_map.h"

namespace vinerow::worlds::cloud_map_bench {
namespace {

void bm_cloud_map(benchmark::State& state) {
  test::SyntheticParcel parcel;
  parcel.rows = 16;
  parcel.length_m = 118.0;
  parcel.missing = 0.024;
  parcel.slope_x = 0.1;
  parcel.noise_m = 0.015;
  parcel.density_per_m2 = static_cast<double>(state.range(0));
  mapping::ParcelCloud cloud = test::make_synthetic_cloud(parcel).cloud;
  for (auto _ : state) {
    cloud.classes.clear();
    const mapping::CloudMap made = mapping::make_cloud_map(cloud, {});
    state.counters["rows"] = static_cast<double>(made.report.rows.size());
    state.counters["containment"] = made.report.containment;
    state.counters["MB"] = 1e-6 * static_cast<double>(made.report.mesh_bytes);
  }
  const auto points = static_cast<double>(cloud.points.size());
  state.counters["points"] = points;
  state.counters["points/s"] =
      benchmark::Counter(points, benchmark::Counter::kIsIterationInvariantRate);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["peak_MB"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
}
BENCHMARK(bm_cloud_map)
    ->Arg(70)
    ->Arg(700)
    ->Arg(2800)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace vinerow::worlds::cloud_map_bench
