#pragma once
/// The 3D distance filter of paper C (Donati et al., "3D Distance Filter for the Autonomous
/// Navigation of UAVs in Agricultural Scenarios", Remote Sensing 14(6) 1374, 2022), section 3, in
/// several readings: position from the inertial unit's velocity and attitude, satellite fixes, and
/// echoes of range sensors off the rows of a map. Knows no signals. Equations, readings and
/// figures: docs/papers/localisation.md.
///
/// The filter runs at the rate of predict(); slower data are taken when they come, at their own
/// time: they are compared with where the vehicle was. Data that are not finite, too old, that
/// contradict the estimate or would spoil the covariance are refused and counted; the estimate
/// stays finite.

#include <Eigen/Geometry>
#include <limits>
#include <span>
#include <vector>

#include "controllers/estimation/parts/trace.h"
#include "controllers/estimation/row_localisation/echo_slab.h"
#include "controllers/estimation/row_localisation/integrity_set.h"
#include "controllers/estimation/row_localisation/position_kalman.h"
#include "controllers/estimation/row_localisation/range_prediction.h"
#include "engine/api/map.h"

namespace vinerow::controllers {

/// How an echo gets into the filter.
enum class DistanceFusion {
  kRangeEkf,         ///< the range itself, linearised (recommended)
  kJoint,            ///< paper C, fig. 4: all echoes cut x~, P~; then (x', P') is fused with x~, P~
  kJointEach,        ///< the same after each echo
  kReplace,          ///< (x', P') takes the place of (x~, P~)
  kIncrement,        ///< what the cut adds, as a scalar along the facet's normal
  kIncrementMatrix,  ///< what the cut adds, as a matrix without its negative part
  kScalar,           ///< position along the normal, error uniform over the slab: R = h^2 / 3
  kTruncated,        ///< the Gaussian cut off by the slab, its first two moments
};

/// What the inertial unit is taken for.
enum class InertialReading {
  kPositionFix,  ///< R1: a position fix at its own rate, much noise let in
  kRandomWalk,   ///< R2: a velocity; errors a random walk of the position
  kVelocity,     ///< R3: a velocity with a slow error that the filter learns
};

/// Process noise of a reading: R1's and R2's are fitted to paper C's table 3 without a map
/// (docs/papers/localisation.md).
PositionKalmanParams kalman_params_of(InertialReading reading);

enum class EchoAssociation {
  kRayCast,         ///< the facet that the beam meets first from the predicted pose
  kClosestSegment,  ///< paper C: of the slice's segments near the beam the one that fits the
                    ///< reading best
};

struct DistanceFilterParams {
  PositionKalmanParams kalman;
  DistanceFusion fusion = DistanceFusion::kRangeEkf;
  InertialReading reading = InertialReading::kVelocity;
  EchoAssociation association = EchoAssociation::kRayCast;
  double set_scale = 3.0;            ///< k: the set is k^2 times the covariance
  bool printed_square_root = false;  ///< paper C's eq. 15 as printed
  double bound_sigma = 3.0;          ///< a bound is so many standard deviations
  double inflation = 0.0;            ///< r of range_variance(); 0: correlation_inflation()
  double gate_sigma = 3.5;           ///< of echoes; 0: none
  double huber_sigma = 0.0;          ///< of echoes; 0: none
  double fix_gate_sigma = 5.0;       ///< of fixes and heights; 0: none
  double fix_inflation = 1.0;        ///< factor on the variance of fixes
  double lost_share = 0.8;           ///< share of echoes refused ...
  double lost_time_s = 2.0;          ///< ... over this time: the filter is lost; 0: no such watch
  double lost_std_m = 0.5;           ///< what a lost filter adds to its horizontal deviation
};

struct RangeReading {
  int sensor = 0;            ///< index into the sensors
  double range_m = 0.0;      ///< +infinity: nothing was seen, which is not used
  double max_range_m = 4.0;  ///< of the sensor
};

class DistanceFilterLaw {
 public:
  /// Counted since the start.
  struct Counters {
    int echoes = 0;            ///< taken
    int echoes_gated = 0;      ///< too far from the prediction, or slabs that miss the set
    int echoes_unmatched = 0;  ///< the map has nothing there
    int fixes = 0;
    int fixes_gated = 0;
    int heights = 0;  ///< and planes
    int heights_gated = 0;
    int bad_numbers = 0;   ///< readings that are not finite or out of range
    int backwards = 0;     ///< older than what is remembered, or than the reading before
    int not_positive = 0;  ///< updates that would have spoilt the covariance
    int lost = 0;          ///< times the filter found itself lost
    int set_restarts = 0;  ///< times the ellipsoid was empty
  };

  /// @param map  lives as long as the law; nullptr: echoes are not used
  DistanceFilterLaw(const DistanceFilterParams& params, const MapAccuracy& accuracy,
                    const RowMeshIndex* map, std::vector<RangeSensorModel> sensors);

  bool has_started() const { return kalman_.has_started(); }
  bool start(Time now, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance_m2);

  /// From the last tick to this one. @param v_W, q_WB  as the inertial unit tells them now
  void predict(Time now, const Eigen::Vector3d& v_W, const Eigen::Quaterniond& q_WB,
               double yaw_std_rad);
  /// Used in reading kPositionFix only.
  void take_inertial_position(Time measured, const Eigen::Vector3d& p_W,
                              const Eigen::Vector3d& std_m);
  /// @param p_W  of the antenna  @param p_BA  the antenna in B
  void take_fix(Time measured, const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m,
                const Eigen::Vector3d& p_BA);
  /// Height of B's origin, z of W, as from a barometer.
  void take_height(Time measured, double height_m, double std_m) {
    take_plane(measured, Eigen::Vector3d::UnitZ(), height_m, std_m);
  }
  /// n.p of B's origin, n unit, as from a range sensor that looks at the ground. What is farther
  /// off than fix_gate_sigma is refused.
  void take_plane(Time measured, const Eigen::Vector3d& normal_W, double offset_m, double std_m);
  /// Echoes of one moment.
  void take_ranges(Time measured, std::span<const RangeReading> readings);

  const PositionKalman& kalman() const { return kalman_; }
  const IntegritySet& set() const { return set_; }
  const Counters& counters() const { return counters_; }
  const Eigen::Quaterniond& q_WB() const { return q_WB_; }
  Eigen::Vector3d v_W() const { return v_W_ + kalman_.velocity_correction_W(); }
  double yaw_std_rad() const { return yaw_std_rad_; }
  /// Normalised innovation squared of the last echo taken; 0 before, and in the fusions by
  /// ellipses, which have none. Its variance is that of one reading (r = 1). Expectation 1.
  double range_nis() const { return range_nis_; }
  /// The same of the last fix taken, its three coordinates together. Expectation 3.
  double fix_nis() const { return fix_nis_; }

 private:
  struct Past {
    Eigen::Vector3d way_W = Eigen::Vector3d::Zero();  ///< dead reckoned since the start
    Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
    friend Past interpolate(const Past& older, const Past& newer, double share) {
      return {older.way_W + share * (newer.way_W - older.way_W),
              older.q_WB.slerp(share, newer.q_WB)};
    }
  };
  /// The moment of data, as the estimate sees it.
  struct Moment {
    double age_s = 0.0;
    Eigen::Vector3d way_since_W = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  };
  struct SensorState {
    bool has_read = false;
    Time last;
    double period_s = 0.05;
  };
  /// Where a slice of the map was cut.
  struct SlicePlane {
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
    double radius_m = std::numeric_limits<double>::quiet_NaN();  ///< equals none: nothing is cut
    bool operator==(const SlicePlane&) const = default;
  };

  bool recall(Time measured, Moment& moment);
  Eigen::Vector3d position_at(const Moment& moment) const;
  bool take_stamp(Time measured, SensorState& sensor);
  std::optional<RangePrediction> associate(const Pose& X_WB, const RangeReading& reading);
  std::optional<RangePrediction> find_closest_segment(const Pose& X_WB,
                                                      const RangeReading& reading);
  /// Cut anew only where the pose or the radius is another: in kJoint the echoes of one moment are
  /// seen from one pose.
  std::span<const RowMeshIndex::Segment> slice_at(const Pose& X_WB, double radius_m);
  double inflation_of(const SensorState& sensor) const;
  EchoBounds bounds_of(const RangeReading& reading) const;
  EchoSlab2 horizontal(const EchoSlab& slab, const Moment& moment) const;

  DatumStatus fuse(const RangePrediction& echo, const RangeReading& reading, const Moment& moment,
                   const Eigen::Vector3d& p_m);
  DatumStatus fuse_range(const RangePrediction& echo, const RangeReading& reading,
                         const Moment& moment, const Eigen::Vector3d& p_m);
  DatumStatus fuse_scalar(const EchoSlab& slab, const Moment& moment, const Eigen::Vector3d& p_m);
  /// @param variance_alone  of this reading, whatever it shares with others
  DatumStatus correct_by_echo(const PositionKalman::Scalar& datum, double variance_alone);
  DatumStatus fuse_truncated(const EchoSlab2& slab);
  DatumStatus fuse_cut(const EchoSlab2& slab);
  DatumStatus fuse_increment_matrix(const Eigen::Vector2d& centre, const Eigen::Matrix2d& shape);
  DatumStatus finish_joint();

  void count(DatumStatus status, int& taken, int& gated);
  void watch(bool refused, double weight);
  void cut_set(const EchoSlab& slab, const Moment& moment);
  void cut_set_by_fix(const Eigen::Vector3d& p, const Eigen::Vector3d& std_m);
  void start_set();

  DistanceFilterParams params_;
  MapAccuracy accuracy_;
  const RowMeshIndex* map_;
  std::vector<RangeSensorModel> sensors_;
  std::vector<SensorState> sensor_states_;
  std::vector<RowMeshIndex::Segment> slice_;
  SlicePlane slice_plane_;
  PositionKalman kalman_;
  IntegritySet set_;
  RecentTrace<Past> trace_;
  Past now_;
  Eigen::Quaterniond q_WB_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_W_ = Eigen::Vector3d::Zero();
  double yaw_std_rad_ = 0.0;
  // The ellipse that the echoes of one moment cut (kJoint), and whether they did.
  Eigen::Vector2d joint_centre_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d joint_shape_ = Eigen::Matrix2d::Identity();
  bool joint_cut_ = false;
  double refused_share_ = 0.0;
  int fixes_gated_in_a_row_ = 0;
  double range_nis_ = 0.0, fix_nis_ = 0.0;
  Counters counters_;
};

}  // namespace vinerow::controllers
