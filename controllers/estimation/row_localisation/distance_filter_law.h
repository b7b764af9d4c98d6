#pragma once
/// 3D distance filter of paper C (Donati et al., "3D Distance Filter for the Autonomous Navigation
/// of UAVs in Agricultural Scenarios", Remote Sensing 14(6) 1374, 2022), section 3, in several
/// interpretations. It estimates position from the inertial unit's velocity and attitude, satellite
/// fixes, and echoes of range sensors from the rows of a map. Independent of signals. Equations,
/// interpretations and figures: docs/papers/localisation.md.
///
/// The filter runs at the rate of predict(). Slower data are used when they arrive and are compared
/// with the position at their own time. The filter rejects and counts data that are not finite, are
/// too old, contradict the estimate or would make the covariance indefinite. The estimate stays
/// finite.

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

/// Method by which an echo updates the filter.
enum class DistanceFusion {
  kRangeEkf,         ///< the range itself, linearised (recommended)
  kJoint,            ///< paper C, fig. 4: all echoes cut x~, P~; then (x', P') is fused with x~, P~
  kJointEach,        ///< the same after each echo
  kReplace,          ///< (x', P') replaces (x~, P~)
  kIncrement,        ///< information of the cut, as a scalar along the facet's normal
  kIncrementMatrix,  ///< information of the cut, as a matrix without its negative part
  kScalar,           ///< position along the normal, error uniform over the slab: R = h^2 / 3
  kTruncated,        ///< the first two moments of the Gaussian truncated by the slab
};

/// Interpretation of the inertial unit.
enum class InertialReading {
  kPositionFix,  ///< R1: a position fix at its own rate, with large process noise
  kRandomWalk,   ///< R2: a velocity whose errors are a random walk of the position
  kVelocity,     ///< R3: a velocity with a slow error that the filter estimates
};

/// Process noise of an interpretation. Those of R1 and R2 are fitted to paper C's table 3 without a
/// map (docs/papers/localisation.md).
PositionKalmanParams kalman_params_of(InertialReading reading);

enum class EchoAssociation {
  kRayCast,         ///< the facet that the beam hits first from the predicted pose
  kClosestSegment,  ///< paper C: of the slice's segments near the beam, the one that fits the
                    ///< reading best
};

struct DistanceFilterParams {
  PositionKalmanParams kalman;
  DistanceFusion fusion = DistanceFusion::kRangeEkf;
  InertialReading reading = InertialReading::kVelocity;
  EchoAssociation association = EchoAssociation::kRayCast;
  double set_scale = 3.0;            ///< k: the set is k^2 times the covariance
  bool printed_square_root = false;  ///< paper C's eq. 15 as printed
  double bound_sigma = 3.0;          ///< bounds are this many standard deviations
  double inflation = 0.0;            ///< r of range_variance(); 0: correlation_inflation()
  double gate_sigma = 3.5;           ///< of echoes; 0: none
  double huber_sigma = 0.0;          ///< of echoes; 0: none
  double fix_gate_sigma = 5.0;       ///< of fixes and heights; 0: none
  double fix_inflation = 1.0;        ///< factor on the variance of fixes
  double lost_share = 0.8;           ///< the filter is lost if this share of echoes is rejected ...
  double lost_time_s = 2.0;          ///< ... over this time; 0: not checked
  double lost_std_m = 0.5;  ///< added to the horizontal standard deviation of a lost filter
};

struct RangeReading {
  int sensor = 0;            ///< index into the sensors
  double range_m = 0.0;      ///< +infinity: no echo, not used
  double max_range_m = 4.0;  ///< of the sensor
};

class DistanceFilterLaw {
 public:
  /// Counts since the start.
  struct Counters {
    int echoes = 0;            ///< used
    int echoes_gated = 0;      ///< too far from the prediction, or the slab misses the set
    int echoes_unmatched = 0;  ///< the map has no surface there
    int fixes = 0;
    int fixes_gated = 0;
    int heights = 0;  ///< and planes
    int heights_gated = 0;
    int bad_numbers = 0;   ///< readings that are not finite or out of range
    int backwards = 0;     ///< older than the remembered past, or than the reading before
    int not_positive = 0;  ///< updates that would have made the covariance indefinite
    int lost = 0;          ///< times the filter detected that it was lost
    int set_restarts = 0;  ///< times the ellipsoid was empty
  };

  /// @param map  must outlive this; nullptr: echoes are not used
  DistanceFilterLaw(const DistanceFilterParams& params, const MapAccuracy& accuracy,
                    const RowMeshIndex* map, std::vector<RangeSensorModel> sensors);

  bool has_started() const { return kalman_.has_started(); }
  bool start(Time now, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance_m2);

  /// Propagates from the last tick to this one. @param v_W, q_WB current output of the inertial
  /// unit
  void predict(Time now, const Eigen::Vector3d& v_W, const Eigen::Quaterniond& q_WB,
               double yaw_std_rad);
  /// Used with InertialReading::kPositionFix only.
  void take_inertial_position(Time measured, const Eigen::Vector3d& p_W,
                              const Eigen::Vector3d& std_m);
  /// @param p_W  of the antenna  @param p_BA  the antenna in B
  void take_fix(Time measured, const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m,
                const Eigen::Vector3d& p_BA);
  /// Height of B's origin, z of W, as from a barometer.
  void take_height(Time measured, double height_m, double std_m) {
    take_plane(measured, Eigen::Vector3d::UnitZ(), height_m, std_m);
  }
  /// n.p of B's origin, n unit, as from a range sensor that looks at the ground. Gated by
  /// fix_gate_sigma.
  void take_plane(Time measured, const Eigen::Vector3d& normal_W, double offset_m, double std_m);
  /// Applies the echoes of one time.
  void take_ranges(Time measured, std::span<const RangeReading> readings);

  const PositionKalman& kalman() const { return kalman_; }
  const IntegritySet& set() const { return set_; }
  const Counters& counters() const { return counters_; }
  const Eigen::Quaterniond& q_WB() const { return q_WB_; }
  Eigen::Vector3d v_W() const { return v_W_ + kalman_.velocity_correction_W(); }
  double yaw_std_rad() const { return yaw_std_rad_; }
  /// Normalised innovation squared of the last echo used; 0 before, and in the fusions by ellipses,
  /// which have no NIS. Its variance is that of one reading (r = 1). Expectation 1.
  double range_nis() const { return range_nis_; }
  /// The same of the last fix used, its three coordinates together. Expectation 3.
  double fix_nis() const { return fix_nis_; }

 private:
  struct Past {
    Eigen::Vector3d displacement_W = Eigen::Vector3d::Zero();  ///< dead reckoned since the start
    Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
    friend Past interpolate(const Past& older, const Past& newer, double share) {
      return {older.displacement_W + share * (newer.displacement_W - older.displacement_W),
              older.q_WB.slerp(share, newer.q_WB)};
    }
  };
  /// Time of a measurement relative to the estimate.
  struct Moment {
    double age_s = 0.0;
    Eigen::Vector3d displacement_since_W = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  };
  struct SensorState {
    bool has_read = false;
    Time last;
    double period_s = 0.05;
  };
  /// Plane in which the map was cut.
  struct SlicePlane {
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
    double radius_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN equals nothing: no cut yet
    bool operator==(const SlicePlane&) const = default;
  };

  bool recall(Time measured, Moment& moment);
  Eigen::Vector3d position_at(const Moment& moment) const;
  bool take_stamp(Time measured, SensorState& sensor);
  std::optional<RangePrediction> associate(const Pose& X_WB, const RangeReading& reading);
  std::optional<RangePrediction> find_closest_segment(const Pose& X_WB,
                                                      const RangeReading& reading);
  /// Cuts again only if the pose or the radius has changed: in kJoint all echoes of one time are
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
  /// @param variance_alone  of this reading alone, without correlation with others
  DatumStatus correct_by_echo(const PositionKalman::Scalar& datum, double variance_alone);
  DatumStatus fuse_truncated(const EchoSlab2& slab);
  DatumStatus fuse_cut(const EchoSlab2& slab);
  DatumStatus fuse_increment_matrix(const Eigen::Vector2d& centre, const Eigen::Matrix2d& shape);
  DatumStatus finish_joint();

  void count(DatumStatus status, int& accepted, int& gated);
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
  // Ellipse that the echoes of one time cut (kJoint), and whether any of them did.
  Eigen::Vector2d joint_centre_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d joint_shape_ = Eigen::Matrix2d::Identity();
  bool joint_cut_ = false;
  double refused_share_ = 0.0;
  int fixes_gated_in_a_row_ = 0;
  double range_nis_ = 0.0, fix_nis_ = 0.0;
  Counters counters_;
};

}  // namespace vinerow::controllers
