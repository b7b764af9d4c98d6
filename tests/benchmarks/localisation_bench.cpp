/// Steps of the estimators between mapped rows, on the data of a flight recorded beforehand: 16
/// rows of 118 m, four ultrasounds with cones of 15 deg at 20 Hz, a height with them, fixes at
/// 5 Hz, inertial unit at 100 Hz. Counters: median and 99th percentile over the steps of the
/// flight, in microseconds; `mean` over all. The aim: 20 us in the median of a step with four
/// echoes (paper C: about 5 ms), 50 MB for a map of 4 ha. `cold`: before each step other data have
/// gone through the processor's first two caches.

#include <numeric>

#include "controllers/estimation/inertial/navigation_measurements.h"
#include "controllers/estimation/row_localisation/row_ground.h"
#include "engine/math/angles.h"
#include "tests/benchmarks/localisation_flight.h"
#include "tests/benchmarks/localisation_timing.h"
#include "tests/controllers/estimation/inertial/imu_course.h"
#include "tests/controllers/estimation/row_localisation/map_localisation_lab.h"
#include "tests/controllers/support/row_mesh_map.h"
#include "tests/support/heap.h"

namespace vinerow::bench::localisation_bench {
namespace {

using Eigen::Vector3d;

constexpr double kCone_rad = rad_from_deg(15.0);
constexpr int kColdReplays = 3;

class CacheSweeper {
 public:
  void sweep() {
    double sum = 0.0;
    for (std::size_t i = 0; i < data_.size(); i += 8) sum += data_[i];
    benchmark::DoNotOptimize(sum);
  }

 private:
  std::vector<double> data_ = std::vector<double>(4 << 17, 1.0);  // 4 MB
};

void report_steps(benchmark::State& state, const RecordedFlight& flight,
                  const std::vector<double>& steps_us) {
  std::vector<double> predictions, echoes, fixes;
  for (std::size_t i = 0; i < steps_us.size(); ++i) {
    const FlightTick& tick = flight.ticks[i];
    (tick.predicts_only() ? predictions : tick.fix_W ? fixes : echoes).push_back(steps_us[i]);
  }
  report(state, "predict", predictions);
  report(state, "echoes", echoes);
  report(state, "and_fix", fixes);
  state.counters["mean"] =
      std::accumulate(steps_us.begin(), steps_us.end(), 0.0) / static_cast<double>(steps_us.size());
}

void step(benchmark::State& state, double cone_rad, const test::LabFilterMaker& make) {
  const bool is_cold = state.range(0) > 0;
  const RecordedFlight flight = record_flight(sixteen_rows(cone_rad), 1);
  CacheSweeper sweeper;
  Steps steps;
  for (auto _ : state) {
    for (int replay = 0; replay < (is_cold ? kColdReplays : kReplays); ++replay) {
      const auto filter = make(flight.context());
      start(flight, *filter);
      steps.begin_replay();
      for (const FlightTick& tick : flight.ticks) {
        if (is_cold) sweeper.sweep();
        steps.add(time_us([&] { feed(flight, tick, *filter); }));
      }
    }
  }
  report_steps(state, flight, steps.medians_us());
}

test::LabFilterMaker fusing(controllers::DistanceFusion fusion) {
  controllers::DistanceFilterParams params;
  params.fusion = fusion;
  return test::distance_filter(params);
}

/// As docs/papers/localisation.md names the paper's: inertial unit as a fix, segments of a slice.
test::LabFilterMaker as_paper_c() {
  controllers::DistanceFilterParams params =
      test::reading_params(controllers::InertialReading::kPositionFix);
  params.fusion = controllers::DistanceFusion::kJoint;
  params.association = controllers::EchoAssociation::kClosestSegment;
  return test::distance_filter(params);
}

#define VINEROW_STEP(name, cone_rad, maker)      \
  BENCHMARK_CAPTURE(step, name, cone_rad, maker) \
      ->ArgName("cold")                          \
      ->Arg(0)                                   \
      ->Arg(1)                                   \
      ->Iterations(1)                            \
      ->Unit(benchmark::kMillisecond)

VINEROW_STEP(range_ekf, kCone_rad, fusing(controllers::DistanceFusion::kRangeEkf));
VINEROW_STEP(range_ekf_single_rays, 0.0, fusing(controllers::DistanceFusion::kRangeEkf));
VINEROW_STEP(joint, kCone_rad, fusing(controllers::DistanceFusion::kJoint));
VINEROW_STEP(increment, kCone_rad, fusing(controllers::DistanceFusion::kIncrement));
VINEROW_STEP(as_paper_c, 0.0, as_paper_c());
VINEROW_STEP(map_localisation, kCone_rad, test::map_localisation());

/// map_localisation from a start known to 1 m, while more than one alley is in question: steps with
/// four echoes in the first 10 s of 20 flights.
void step_of_a_bank(benchmark::State& state) {
  test::LabSetup setup = sixteen_rows(kCone_rad);
  setup.start_std_m = 1.0;
  setup.start_vertical_std_m = 0.26;
  setup.duration_s = 10.0;
  std::vector<double> steps_us;
  double filters = 0.0;
  for (auto _ : state) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const RecordedFlight flight = record_flight(setup, seed);
      Steps steps;
      for (int replay = 0; replay < kReplays; ++replay) {
        test::MapLocalisationFilter filter({}, flight.context());
        start(flight, filter);
        steps.begin_replay();
        for (const FlightTick& tick : flight.ticks) {
          const int count = filter.law().filter_count();
          const double us = time_us([&] { feed(flight, tick, filter); });
          if (tick.predicts_only() || tick.fix_W || count < 2) continue;
          steps.add(us);
          if (replay == 0) filters += count;
        }
      }
      const std::vector<double> medians_us = steps.medians_us();
      steps_us.insert(steps_us.end(), medians_us.begin(), medians_us.end());
    }
  }
  report(state, "echoes", steps_us);
  state.counters["filters"] = filters / static_cast<double>(steps_us.size());
  state.counters["steps"] = static_cast<double>(steps_us.size());
}
BENCHMARK(step_of_a_bank)->Iterations(1)->Unit(benchmark::kMillisecond);

/// The ground below the vehicle, for a sensor that looks down; rows' lines with a point every 2 m.
void ground_between_rows(benchmark::State& state) {
  const RecordedFlight flight = record_flight(sixteen_rows(0.0), 1);
  const auto& p_W = flight.ticks;
  const controllers::RowGround ground(flight.map);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ground.at(p_W[i++ % p_W.size()].p_inertial_W));
  }
}
BENCHMARK(ground_between_rows)->Unit(benchmark::kMicrosecond);

/// error_state_kalman on a lively course of 60 s, 5 Hz fixes of position and velocity.
void step_of_error_state_kalman(benchmark::State& state) {
  const test::ImuCourse course = test::lively_course();
  Steps predictions, fixes;
  for (auto _ : state) {
    for (int replay = 0; replay < kReplays; ++replay) {
      predictions.begin_replay();
      fixes.begin_replay();
      controllers::ErrorStateKalman filter({});
      filter.start(Time{}, course.at(0.0).state, 0.01 * controllers::ErrorCovariance::Identity());
      for (int i = 0; i <= 6000; ++i) {
        const Time now = test::tick_at(i, 10'000'000);
        const test::CoursePoint point = course.at(now.s());
        predictions.add(time_us([&] { filter.predict(now, point.w_B, point.f_B); }));
        if (i % 20 != 0) continue;
        fixes.add(time_us([&] {
          const Vector3d arm_B(0.3, -0.2, 0.4), arm_W = point.state.q_WB * arm_B;
          const controllers::VectorMeasurement place =
              controllers::place_measurement(filter.past(now), arm_B, point.state.p_WI + arm_W);
          filter.correct_vector(place.innovation, place.H, Vector3d::Constant(0.09), 10.0);
          const controllers::VectorMeasurement velocity = controllers::velocity_measurement(
              filter.past(now), arm_B,
              point.state.v_WI + point.state.q_WB * point.w_B.cross(arm_B));
          filter.correct_vector(velocity.innovation, velocity.H, Vector3d::Constant(0.01), 10.0);
        }));
      }
    }
  }
  report(state, "predict", predictions.medians_us());
  report(state, "fix", fixes.medians_us());
}
BENCHMARK(step_of_error_state_kalman)->Iterations(1)->Unit(benchmark::kMillisecond);

/// 16 rows of 118 m, and 4 ha: 160 rows of 100 m.
void index_of_row_meshes(benchmark::State& state) {
  test::RowMeshBlock block;
  block.rows = static_cast<int>(state.range(0));
  block.length_m = static_cast<double>(state.range(1));
  const RowMap map = test::make_row_mesh_map(block, RandomStream(14, "", "block"));
  for (auto _ : state) benchmark::DoNotOptimize(controllers::RowMeshIndex(map));
  const std::size_t before = test::heap_bytes();
  const controllers::RowMeshIndex index(map);
  state.counters["index_MB"] = 1e-6 * static_cast<double>(test::heap_bytes() - before);
  state.counters["facets"] = static_cast<double>(test::triangle_count(map));
  double bytes = 0.0;
  for (const RowMesh& mesh : map.meshes) {
    bytes += static_cast<double>(mesh.mesh_W.vertices.size() * sizeof(mesh.mesh_W.vertices[0]) +
                                 mesh.mesh_W.triangles.size() * sizeof(mesh.mesh_W.triangles[0]));
  }
  state.counters["meshes_MB"] = 1e-6 * bytes;
}
BENCHMARK(index_of_row_meshes)
    ->ArgNames({"rows", "length_m"})
    ->Args({16, 118})
    ->Args({160, 100})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vinerow::bench::localisation_bench
