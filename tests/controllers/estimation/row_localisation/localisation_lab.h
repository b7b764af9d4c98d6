#pragma once
/// Flights along an alley of a synthetic vineyard, to test the law of any estimator: simulated
/// sensor readings at 100 Hz, and the error of the estimate. The reference study of paper C
/// (docs/papers/localisation.md).

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "controllers/estimation/row_localisation/distance_filter_law.h"
#include "tests/controllers/estimation/row_localisation/localisation_world.h"

namespace vinerow::test {

struct LabSetup {
  LocalisationWorldSetup world;
  // Flight.
  double duration_s = 60.0;
  double speed_mps = 1.5;
  double height_m = 1.25;       ///< above ground
  double gust_std_m = 0.1;      ///< of the place, each axis
  double yaw_std_rad = 0.1222;  ///< 7 deg about the row's direction
  double tilt_std_rad = 0.035;
  double gust_radps = 1.2, yaw_radps = 2.0, tilt_radps = 3.0;  ///< how fast they wander
  double start_std_m = 0.26;                                   ///< each axis
  double start_vertical_std_m = -1.0;                          ///< < 0: start_std_m
  int start_alleys_off = 0;  ///< error of the stated start, in alleys to the left of the true one
  // Range sensors: looking along these angles of B, in the plane of B.
  std::vector<double> sensor_angles_rad = {0.785398163, 2.356194490, -2.356194490, -0.785398163};
  double range_bound_m = 0.003;  ///< uniform error
  double max_range_m = 4.0;
  int range_every = 5;        ///< ticks
  bool in_turn = false;       ///< one sensor every range_every ticks
  double cone_rad = 0.0;      ///< half angle of the true cone; 0: a ray
  int filter_fan_rays = 1;    ///< of the sensors as the filter knows them
  double missed_share = 0.0;  ///< echoes lost
  double false_share = 0.0;   ///< echoes from nowhere, shorter than the true ones
  int range_age = 0;          ///< ticks late
  bool has_stamps = true;     ///< late data say when they were measured
  // Satellite fixes.
  Eigen::Vector3d fix_std_m = {1.0, 1.0, 1.5};
  double fix_time_s = 0.0;  ///< correlation time of their errors; 0: white
  int fix_every = 20;
  int fix_age = 0;
  double outage_from_s = -1.0, outage_to_s = -1.0;
  double height_std_m = 0.03;  ///< of a height, with the echoes (paper C: the sensor that looks
                               ///< down); 0: no height
  // Inertial unit.
  double velocity_std_mps = 0.05, velocity_time_s = 5.0;
  double velocity_white_std_mps = 0.0;
  Eigen::Vector3d inertial_std_m = {1.0, 1.0, 1.5};            ///< of its position, white
  double roll_std_rad = 5.236e-4, heading_std_rad = 3.491e-3;  ///< 0.03 and 0.2 deg
};

/// A law under test.
class LabFilter {
 public:
  virtual ~LabFilter() = default;
  virtual void start(Time now, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance) = 0;
  /// Every tick of 10 ms. @param p_W, std_m  the unit's own position
  virtual void inertial(Time now, const Eigen::Vector3d& v_W, const Eigen::Quaterniond& q_WB,
                        const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m) = 0;
  virtual void fix(Time measured, const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m) = 0;
  virtual void height(Time /*measured*/, double /*z_m*/, double /*std_m*/) {}
  virtual void ranges(Time measured, std::span<const controllers::RangeReading> readings) = 0;
  virtual Eigen::Vector3d p_W() const = 0;
  virtual Eigen::Matrix3d covariance() const = 0;
  /// Whether its set, if it has one, contains a point.
  virtual bool contains(const Eigen::Vector3d& /*p_W*/) const { return true; }
};

/// The map it may use; nullptr: no map.
struct LabContext {
  const RowMap& map;
  const controllers::RowMeshIndex& index;
  std::vector<controllers::RangeSensorModel> sensors;
  const LabSetup& setup;
};
using LabFilterMaker = std::function<std::unique_ptr<LabFilter>(const LabContext&)>;

struct LabSample {
  double time_s, s_m;                ///< s: true place along the rows
  double lateral_m, longitudinal_m;  ///< estimate less truth, along the rows' left and ahead
  double nees;      ///< of the horizontal error, 2 degrees of freedom, clipped at 100
  bool in_ellipse;  ///< of 95 %
  bool in_set;
};

struct LabRun {
  std::vector<LabSample> samples;
};

/// One flight; the same seed gives the same flight and errors to every filter.
LabRun fly(const LabSetup& setup, std::uint64_t seed, const LabFilterMaker& make);

struct LabScore {
  double lateral_m = 0.0, longitudinal_m = 0.0;  ///< rms over all samples
  double lateral_mean_m = 0.0, longitudinal_mean_m = 0.0;
  double lateral_max_m = 0.0;
  double nees = 0.0;         ///< mean
  double coverage = 0.0;     ///< share inside the 95 % ellipse
  double containment = 0.0;  ///< share inside the set
  int seeds = 0;
  int lost = 0;  ///< not finite, or off by more than 1 m at the end; these count in all else too
};

/// Seeds 1..count; `counts` selects the samples that count (default: all from 3 s on).
LabScore study(const LabSetup& setup, int count, const LabFilterMaker& make,
               const std::function<bool(const LabSample&)>& counts = {});

/// The distance filter. `has_map` false: satellite fixes and inertial unit only.
LabFilterMaker distance_filter(const controllers::DistanceFilterParams& params,
                               bool has_map = true);

/// Parameters of the three readings (docs/papers/localisation.md).
controllers::DistanceFilterParams reading_params(controllers::InertialReading reading);

}  // namespace vinerow::test
