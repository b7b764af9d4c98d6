#pragma once
/// Sensor data of a flight between mapped rows, recorded once for an estimator. Any law can then be
/// timed on the same data.

#include <memory>
#include <optional>
#include <vector>

#include "tests/controllers/estimation/row_localisation/localisation_lab.h"

namespace vinerow::bench {

/// The data of one step of 10 ms, as the laboratory delivers them.
struct FlightTick {
  Time now;
  Eigen::Vector3d v_W, p_inertial_W, std_inertial_m;
  Eigen::Quaterniond q_WB;
  std::optional<Eigen::Vector3d> fix_W;
  std::optional<double> height_m;
  std::vector<controllers::RangeReading> ranges;

  bool predicts_only() const { return !fix_W && !height_m && ranges.empty(); }
};

/// A flight over a map of `setup.world`, whose rows' lines have a point every 2 m, as `row_mesh`
/// lifts them to the terrain.
struct RecordedFlight {
  test::LabSetup setup;
  std::unique_ptr<test::LocalisationWorld> world;
  RowMap map;
  std::vector<controllers::RangeSensorModel> sensors;
  Eigen::Vector3d start_W = Eigen::Vector3d::Zero();
  Eigen::Matrix3d start_covariance_m2 = Eigen::Matrix3d::Identity();
  std::vector<FlightTick> ticks;

  test::LabContext context() const { return {map, world->map_index(), sensors, setup}; }
};

RecordedFlight record_flight(const test::LabSetup& setup, std::uint64_t seed);

/// 16 rows of 118 m, four sensors at X, 70 s at 1.5 m/s. @param cone_rad  half angle of the
/// sensors and of the filter's fan of 7 rays; 0: single rays
test::LabSetup sixteen_rows(double cone_rad);

/// Starts a law as the flight did.
void start(const RecordedFlight& flight, test::LabFilter& filter);
/// Gives it the data of a step.
void feed(const RecordedFlight& flight, const FlightTick& tick, test::LabFilter& filter);

}  // namespace vinerow::bench
