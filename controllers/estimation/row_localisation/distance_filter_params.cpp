#include "controllers/estimation/row_localisation/distance_filter_params.h"

#include "engine/api/parameter_table.h"

namespace vinerow::controllers {

const ParameterTable<DistanceFilterOptions>& distance_filter_law_table() {
  using P = DistanceFilterOptions;
  using Law = DistanceFilterParams;
  using Kalman = PositionKalmanParams;
  const auto law = [](auto member) { return inside(&P::law, member); };
  const auto kalman = [](auto member) { return inside(&P::law, &Law::kalman, member); };
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("fusion", law(&Law::fusion),
                  {{"range_ekf", DistanceFusion::kRangeEkf},
                   {"joint", DistanceFusion::kJoint},
                   {"joint_each", DistanceFusion::kJointEach},
                   {"replace", DistanceFusion::kReplace},
                   {"increment", DistanceFusion::kIncrement},
                   {"increment_matrix", DistanceFusion::kIncrementMatrix},
                   {"scalar", DistanceFusion::kScalar},
                   {"truncated", DistanceFusion::kTruncated}},
                  "fusion of an echo: the range itself (range_ekf); paper C, fig. 4, after all "
                  "echoes of one time (joint) or each (joint_each); the cut ellipse as the new "
                  "covariance (replace); the information of the cut as a scalar (increment) or a "
                  "matrix (increment_matrix); position along the normal, uniform over the slab "
                  "(scalar); the Gaussian truncated by the slab (truncated)")
          .choice(
              "reading", law(&Law::reading),
              {{"velocity", InertialReading::kVelocity},
               {"random_walk", InertialReading::kRandomWalk},
               {"position_fix", InertialReading::kPositionFix}},
              "interpretation of the inertial unit: a velocity with a slow error (R3), a velocity "
              "whose errors are a random walk (R2), a position fix at its own rate (R1)")
          .choice(
              "association", law(&Law::association),
              {{"ray_cast", EchoAssociation::kRayCast},
               {"closest_segment", EchoAssociation::kClosestSegment}},
              "the facet that the beam hits first, or paper C's segment that fits the reading best")
          .number("set_scale", "", law(&Law::set_scale), kPositive,
                  "k: the cut ellipse is k^2 times the covariance")
          .boolean("printed_square_root", law(&Law::printed_square_root),
                   "paper C's eq. 15 as printed; its P' may be indefinite and is then rejected")
          .number("bound_sigma", "", law(&Law::bound_sigma), kPositive,
                  "bounds of slabs and of the ellipsoid, in standard deviations")
          .number("walk_m2_per_s", "m2/s", &P::walk_m2_per_s, kPositive,
                  "process noise of each coordinate; if absent 1e-6 (velocity), 0.023 "
                  "(random_walk), 1.98 (position_fix), which fit paper C's table 3")
          .number("velocity_std_mps", "m/s", kalman(&Kalman::velocity_std_mps), between(0.0, 10.0),
                  "1 sigma of the velocity's slow error (VN-200: 0.05); reading: velocity")
          .number("velocity_time_s", "s", kalman(&Kalman::velocity_time_s), kPositive,
                  "its correlation time")
          .degrees("yaw_std_deg", &P::yaw_std_rad, between(0.0, 90.0),
                   "1 sigma of the heading; 0: as the inertial unit states, 0.2 if it does not")
          .number(
              "inertial_std_m", "m", &P::inertial_std_m, kPositive,
              "1 sigma of the inertial unit's position if it states none; reading: position_fix")
          .number("inflation", "", law(&Law::inflation), between(0.0, 1e6),
                  "factor on the variance of the map's error; 0: 2.5 l / (v T), at least 1")
          .number(
              "gate_sigma", "", law(&Law::gate_sigma), between(0.0, 100.0),
              "limit of the innovation; echoes beyond it are rejected; 0: none (range_ekf, scalar)")
          .number("huber_sigma", "", law(&Law::huber_sigma), between(0.0, 100.0),
                  "innovation above which echoes weigh less; 0: never (range_ekf)")
          .number("fix_gate_sigma", "", law(&Law::fix_gate_sigma), between(0.0, 100.0),
                  "limit of the innovation; fixes and heights beyond it are rejected; 0: none")
          .number(
              "fix_inflation", "", law(&Law::fix_inflation), kPositive,
              "factor on the variance of fixes; 2 tau f for errors with the correlation time tau")
          .number("lost_share", "", law(&Law::lost_share), between(0.0, 1.0),
                  "share of rejected echoes over lost_time_s at which the filter is lost")
          .number("lost_time_s", "s", law(&Law::lost_time_s), between(0.0, 1000.0),
                  "time over which lost_share is taken; 0: not checked")
          .number("lost_std_m", "m", law(&Law::lost_std_m), between(0.0, 100.0),
                  "increase of the horizontal standard deviation of a lost filter");
  return table;
}

DistanceFilterParams make_distance_filter_params(const DistanceFilterOptions& options) {
  DistanceFilterParams params = options.law;
  params.kalman = kalman_params_of(params.reading);
  if (params.reading == InertialReading::kVelocity) {
    params.kalman.velocity_std_mps = options.law.kalman.velocity_std_mps;
  }
  params.kalman.velocity_time_s = options.law.kalman.velocity_time_s;
  if (options.walk_m2_per_s) params.kalman.walk_m2_per_s = *options.walk_m2_per_s;
  return params;
}

}  // namespace vinerow::controllers
