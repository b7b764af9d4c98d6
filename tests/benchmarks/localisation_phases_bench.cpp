/// The phases of paper C's figure 11 (Donati et al., Remote Sensing 14(6) 1374, 2022), in
/// microseconds, of the steps with four echoes and no fix of a flight between 16 rows of 118 m: P1
/// prediction, P2 from the 3D map to what the sensors should see, P3 row selection, P4 distance
/// filter (parallel cuts), P5 update (echoes, height, the inertial unit's position where it is used
/// as a fix), OT the whole step. A phase is called by itself with what it is given in the flight.
/// Counters: median and 99th percentile over the steps.

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/math/angles.h"
#include "tests/benchmarks/localisation_flight.h"
#include "tests/benchmarks/localisation_timing.h"
#include "tests/controllers/estimation/row_localisation/map_localisation_lab.h"

namespace vinerow::bench::localisation_phases_bench {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCone_rad = rad_from_deg(15.0);

struct Phases {
  Steps p1, p2, p3, p4, p5, overall;

  std::vector<std::pair<const char*, Steps*>> all() {
    return {{"P1", &p1}, {"P2", &p2}, {"P3", &p3}, {"P4", &p4}, {"P5", &p5}, {"OT", &overall}};
  }
};

/// What the four sensors should read at a pose. @returns as many as meet the map
std::vector<controllers::RangePrediction> predict_all(const RecordedFlight& flight,
                                                      const Pose& X_WB) {
  std::vector<controllers::RangePrediction> echoes;
  for (const controllers::RangeSensorModel& sensor : flight.sensors) {
    const auto echo = controllers::predict_range(flight.world->map_index(), X_WB, sensor, 4.0);
    if (echo) echoes.push_back(*echo);
  }
  return echoes;
}

double time_predictions_us(const RecordedFlight& flight, const Pose& X_WB) {
  return time_us([&] {
    for (const controllers::RangeSensorModel& sensor : flight.sensors) {
      benchmark::DoNotOptimize(
          controllers::predict_range(flight.world->map_index(), X_WB, sensor, 4.0));
    }
  });
}

class DistanceFilterPhases {
 public:
  DistanceFilterPhases(const RecordedFlight& flight,
                       const controllers::DistanceFilterParams& params)
      : flight_(flight), params_(params) {
    slice_.reserve(8192);
  }

  void run(benchmark::State& state) {
    for (auto _ : state) {
      for (int replay = 0; replay < kReplays; ++replay) {
        fly(false);
        fly(true);
      }
    }
    for (const auto& [name, steps] : phases_.all()) report(state, name, steps->medians_us());
  }

 private:
  bool cuts_slices() const {
    return params_.association == controllers::EchoAssociation::kClosestSegment;
  }

  /// @param in_pieces  false: nothing is called beside the law, whose steps are timed
  void fly(bool in_pieces) {
    for (const auto& [name, steps] : phases_.all()) steps->begin_replay();
    const test::LabSetup& setup = flight_.setup;
    controllers::DistanceFilterLaw law(params_, flight_.map.accuracy, &flight_.world->map_index(),
                                       flight_.sensors);
    law.start(flight_.ticks.front().now, flight_.start_W, flight_.start_covariance_m2);
    for (const FlightTick& tick : flight_.ticks) {
      const double p1_us =
          time_us([&] { law.predict(tick.now, tick.v_W, tick.q_WB, setup.heading_std_rad); });
      const double p5_us = time_us([&] {
        law.take_inertial_position(tick.now, tick.p_inertial_W, tick.std_inertial_m);
        if (tick.height_m) law.take_height(tick.now, *tick.height_m, setup.height_std_m);
      });
      if (tick.fix_W) law.take_fix(tick.now, *tick.fix_W, setup.fix_std_m, Vector3d::Zero());
      if (tick.predicts_only() || tick.fix_W) {
        law.take_ranges(tick.now, tick.ranges);
        continue;
      }
      if (!in_pieces) {
        const double echoes_us = time_us([&] { law.take_ranges(tick.now, tick.ranges); });
        phases_.overall.add(p1_us + p5_us + echoes_us);
        continue;
      }
      const Pose X_WB{law.q_WB(), law.kalman().p_W()};
      const double p2_us = cuts_slices() ? time_cuts_us(X_WB) : time_predictions_us(flight_, X_WB);
      const std::vector<controllers::RangePrediction> echoes = predict_all(flight_, X_WB);
      const double p4_us = time_sets_us(law, echoes);
      const double update_us = time_updates_us(law, echoes);
      phases_.p1.add(p1_us);
      phases_.p2.add(p2_us);
      phases_.p4.add(p4_us);
      phases_.p5.add(p5_us + update_us);
      if (!cuts_slices()) {
        law.take_ranges(tick.now, tick.ranges);
        continue;
      }
      // The choice of a segment is what is left; rays find theirs on the way. Slices once more:
      // those of the law find all in the caches.
      const double slices_us = time_cuts_us(X_WB);
      const double echoes_us = time_us([&] { law.take_ranges(tick.now, tick.ranges); });
      phases_.p3.add(std::max(0.0, echoes_us - slices_us - p4_us - update_us));
    }
  }

  /// One slice for all echoes of a moment: in kJoint they are seen from one pose.
  double time_cuts_us(const Pose& X_WB) {
    return time_us([&] {
      flight_.world->map_index().cut(X_WB.p, X_WB.q * Vector3d::UnitZ(), 4.0, slice_);
      benchmark::DoNotOptimize(slice_.data());
    });
  }

  /// Slabs that cut the ellipse, where echoes are taken so, and the ellipsoid beside the filter.
  double time_sets_us(const controllers::DistanceFilterLaw& law,
                      const std::vector<controllers::RangePrediction>& echoes) {
    const double k = params_.bound_sigma;
    const controllers::EchoBounds bounds{0.003, k * flight_.map.accuracy.surface_std_m,
                                         k * law.yaw_std_rad()};
    const controllers::PositionKalman& kalman = law.kalman();
    Vector2d centre = kalman.p_W().head<2>();
    Matrix2d shape = k * k * kalman.position_covariance().topLeftCorner<2, 2>();
    const double height_bound_m = k * std::sqrt(kalman.position_covariance()(2, 2));
    controllers::IntegritySet set = law.set();
    return time_us([&] {
      for (const controllers::RangePrediction& echo : echoes) {
        const controllers::EchoSlab slab =
            controllers::echo_slab(echo, kalman.p_W(), echo.range_m, bounds);
        if (params_.fusion != controllers::DistanceFusion::kRangeEkf) {
          const controllers::EchoSlab2 flat =
              controllers::horizontal_slab(slab, kalman.p_W().z(), height_bound_m);
          controllers::cut_ellipsoid<2>(centre, shape, flat.a, flat.lower_m, flat.upper_m);
        }
        set.cut(slab);
      }
      benchmark::DoNotOptimize(centre);
      benchmark::DoNotOptimize(shape);
      benchmark::DoNotOptimize(set);
    });
  }

  double time_updates_us(const controllers::DistanceFilterLaw& law,
                         const std::vector<controllers::RangePrediction>& echoes) {
    controllers::PositionKalman kalman = law.kalman();
    const Vector3d p_W = kalman.p_W();
    const Vector2d near = p_W.head<2>() + Vector2d(0.01, 0.01);
    const Matrix2d P = kalman.position_covariance().topLeftCorner<2, 2>();
    return time_us([&] {
      if (params_.fusion != controllers::DistanceFusion::kRangeEkf) {
        kalman.correct_horizontal(near, P);
      } else {
        for (const controllers::RangePrediction& echo : echoes) {
          controllers::PositionKalman::Scalar datum;
          datum.gradient = controllers::PositionKalman::gradient_of(echo.gradient_p(), 0.0);
          datum.innovation = 0.01;
          datum.variance = controllers::range_variance(
              echo, p_W, flight_.map.accuracy.surface_std_m, 10.0, 0.003, law.yaw_std_rad());
          kalman.correct(datum);
        }
      }
      benchmark::DoNotOptimize(kalman);
    });
  }

  const RecordedFlight& flight_;
  controllers::DistanceFilterParams params_;
  std::vector<controllers::RowMeshIndex::Segment> slice_;
  Phases phases_;
};

void phases_of_range_ekf(benchmark::State& state) {
  const RecordedFlight flight = record_flight(sixteen_rows(kCone_rad), 1);
  DistanceFilterPhases(flight, {}).run(state);
}
BENCHMARK(phases_of_range_ekf)->Iterations(1)->Unit(benchmark::kMillisecond);

/// The inertial unit as a fix, single rays, slices, the ellipse that four echoes cut.
void phases_as_paper_c(benchmark::State& state) {
  const RecordedFlight flight = record_flight(sixteen_rows(0.0), 1);
  controllers::DistanceFilterParams params =
      test::reading_params(controllers::InertialReading::kPositionFix);
  params.fusion = controllers::DistanceFusion::kJoint;
  params.association = controllers::EchoAssociation::kClosestSegment;
  DistanceFilterPhases(flight, params).run(state);
}
BENCHMARK(phases_as_paper_c)->Iterations(1)->Unit(benchmark::kMillisecond);

/// P5 is what is left of a step without prediction and rays.
void phases_of_map_localisation(benchmark::State& state) {
  const RecordedFlight flight = record_flight(sixteen_rows(kCone_rad), 1);
  Phases phases;
  const auto fly = [&](bool in_pieces) {
    for (const auto& [name, steps] : phases.all()) steps->begin_replay();
    controllers::MapLocalisationLaw law({}, flight.map, flight.world->map_index(), flight.sensors);
    law.start(flight.ticks.front().now, flight.start_W, flight.start_covariance_m2);
    for (const FlightTick& tick : flight.ticks) {
      const double p1_us = time_us([&] { law.predict(tick.now, tick.v_W, tick.q_WB); });
      if (tick.fix_W) law.correct_fix(tick.now, *tick.fix_W, flight.setup.fix_std_m, {0, 0, 0});
      const bool counts = !tick.predicts_only() && !tick.fix_W;
      const controllers::LocalisationState& mean = law.state();
      const Eigen::AngleAxisd turn(-mean.heading_error_rad(), Vector3d::UnitZ());
      const Pose X_MB{turn * tick.q_WB, mean.p_W() - mean.map_shift_W()};
      if (counts && in_pieces) phases.p2.add(time_predictions_us(flight, X_MB));
      // Once more: those of the law find all in the caches.
      const double rays_us = counts && in_pieces ? time_predictions_us(flight, X_MB) : 0.0;
      const double update_us = time_us([&] {
        if (tick.height_m) {
          law.correct_plane(tick.now, Vector3d::UnitZ(), *tick.height_m, flight.setup.height_std_m);
        }
        for (const controllers::RangeReading& reading : tick.ranges) {
          if (!std::isfinite(reading.range_m)) continue;
          law.correct_range(tick.now, reading.sensor, reading.range_m, 0.05);
        }
      });
      if (!counts) continue;
      if (!in_pieces) {
        phases.overall.add(p1_us + update_us);
        continue;
      }
      phases.p1.add(p1_us);
      phases.p5.add(std::max(0.0, update_us - rays_us));
    }
  };
  for (auto _ : state) {
    for (int replay = 0; replay < kReplays; ++replay) {
      fly(false);
      fly(true);
    }
  }
  for (const auto& [name, steps] : phases.all()) report(state, name, steps->medians_us());
}
BENCHMARK(phases_of_map_localisation)->Iterations(1)->Unit(benchmark::kMillisecond);

/// One slice of the map within 4 m, for display, at places of the flight.
void slice_of_the_map(benchmark::State& state) {
  const RecordedFlight flight = record_flight(sixteen_rows(0.0), 1);
  std::vector<controllers::RowMeshIndex::Segment> slice;
  slice.reserve(8192);
  double segments = 0.0;
  std::size_t i = 0;
  for (auto _ : state) {
    const FlightTick& tick = flight.ticks[i++ % flight.ticks.size()];
    flight.world->map_index().cut(tick.p_inertial_W, tick.q_WB * Vector3d::UnitZ(), 4.0, slice);
    segments += static_cast<double>(slice.size());
  }
  state.counters["segments"] = segments / static_cast<double>(state.iterations());
}
BENCHMARK(slice_of_the_map)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace vinerow::bench::localisation_phases_bench
