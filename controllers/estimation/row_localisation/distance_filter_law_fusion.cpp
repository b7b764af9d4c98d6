// Association of an echo with a facet, and its fusion: one function for each DistanceFusion.

#include <cmath>
#include <numbers>

#include "controllers/estimation/row_localisation/distance_filter_law.h"
#include "controllers/estimation/row_localisation/ellipsoid.h"
#include "engine/math/decomposition.h"

namespace vinerow::controllers {

using Eigen::Matrix2d, Eigen::Vector2d, Eigen::Vector3d;

std::optional<RangePrediction> DistanceFilterLaw::associate(const Pose& X_WB,
                                                            const RangeReading& reading) {
  if (params_.association == EchoAssociation::kClosestSegment) {
    return find_closest_segment(X_WB, reading);
  }
  return predict_range(*map_, X_WB, sensors_[reading.sensor], reading.max_range_m);
}

std::optional<RangePrediction> DistanceFilterLaw::find_closest_segment(
    const Pose& X_WB, const RangeReading& reading) {
  const RangeSensorModel& sensor = sensors_[reading.sensor];
  const Vector3d origin_W = X_WB * sensor.X_BS.p;
  const Vector3d dir_W = X_WB.q * (sensor.X_BS.q * Vector3d::UnitX());
  const std::span<const RowMeshIndex::Segment> slice = slice_at(X_WB, reading.max_range_m);
  // "In the proximity": the beam may miss the segment by the uncertainty of the position.
  const double near_m =
      params_.bound_sigma * std::sqrt(kalman_.position_covariance().topLeftCorner<2, 2>().trace());
  std::optional<RangePrediction> best;
  double min_m = 0.0;
  for (const RowMeshIndex::Segment& segment : slice) {
    const double slope = segment.normal_W.dot(dir_W);
    if (!(slope < -1e-3)) continue;  // seen from behind or edge-on
    const double range_m = segment.normal_W.dot(segment.from_W - origin_W) / slope;
    if (!(range_m > 0.0) || range_m > reading.max_range_m) continue;
    const Vector3d along_W = segment.to_W - segment.from_W;
    const double length_m = along_W.norm();
    if (!(length_m > 0.0)) continue;
    const double at_m = (origin_W + range_m * dir_W - segment.from_W).dot(along_W) / length_m;
    if (at_m < -near_m || at_m > length_m + near_m) continue;
    const double off_m = std::abs(range_m - reading.range_m);
    if (best && off_m >= min_m) continue;
    min_m = off_m;
    RowMeshIndex::Hit hit;
    hit.distance_m = range_m;
    hit.normal_W = segment.normal_W;
    hit.plane_m = segment.normal_W.dot(segment.from_W);
    hit.row = segment.row;
    best = RangePrediction{range_m, origin_W, dir_W, hit};
  }
  return best;
}

std::span<const RowMeshIndex::Segment> DistanceFilterLaw::slice_at(const Pose& X_WB,
                                                                   double radius_m) {
  const SlicePlane plane{X_WB.p, X_WB.q * Vector3d::UnitZ(), radius_m};
  if (!(plane == slice_plane_)) {
    map_->cut(plane.p_W, plane.normal_W, plane.radius_m, slice_);
    slice_plane_ = plane;
  }
  return slice_;
}

DatumStatus DistanceFilterLaw::fuse(const RangePrediction& echo, const RangeReading& reading,
                                    const Moment& moment, const Vector3d& p_m) {
  if (params_.fusion == DistanceFusion::kRangeEkf) return fuse_range(echo, reading, moment, p_m);
  const EchoSlab slab = echo_slab(echo, p_m, reading.range_m, bounds_of(reading));
  if (params_.fusion == DistanceFusion::kScalar) return fuse_scalar(slab, moment, p_m);
  const EchoSlab2 flat = horizontal(slab, moment);
  if (params_.fusion == DistanceFusion::kTruncated) return fuse_truncated(flat);
  return fuse_cut(flat);
}

DatumStatus DistanceFilterLaw::fuse_range(const RangePrediction& echo, const RangeReading& reading,
                                          const Moment& moment, const Vector3d& p_m) {
  PositionKalman::Scalar datum;
  datum.gradient = PositionKalman::gradient_of(echo.gradient_p(), moment.age_s);
  datum.innovation = reading.range_m - echo.range_m;
  datum.variance = range_variance(echo, p_m, accuracy_.surface_std_m,
                                  inflation_of(sensor_states_[reading.sensor]),
                                  sensors_[reading.sensor].bound_m, yaw_std_rad_);
  datum.gate_sigma = params_.gate_sigma;
  datum.huber_sigma = params_.huber_sigma;
  // A single reading has the map's error once; the inflation is for readings that share it.
  const double alone = range_variance(echo, p_m, accuracy_.surface_std_m, 1.0,
                                      sensors_[reading.sensor].bound_m, yaw_std_rad_);
  return correct_by_echo(datum, alone);
}

DatumStatus DistanceFilterLaw::fuse_scalar(const EchoSlab& slab, const Moment& moment,
                                           const Vector3d& p_m) {
  PositionKalman::Scalar datum;
  datum.gradient = PositionKalman::gradient_of(slab.normal_W, moment.age_s);
  datum.innovation = 0.5 * (slab.lower_m + slab.upper_m) - slab.normal_W.dot(p_m);
  datum.variance = slab.half_width_m() * slab.half_width_m() / 3.0;
  datum.gate_sigma = params_.gate_sigma;
  return correct_by_echo(datum, datum.variance);
}

DatumStatus DistanceFilterLaw::correct_by_echo(const PositionKalman::Scalar& datum,
                                               double variance_alone) {
  const double known = datum.gradient.dot(kalman_.covariance() * datum.gradient);
  const DatumStatus status = kalman_.correct(datum);
  if (status == DatumStatus::kAccepted) {
    range_nis_ = datum.innovation * datum.innovation / (known + variance_alone);
  }
  return status;
}

EchoSlab2 DistanceFilterLaw::horizontal(const EchoSlab& slab, const Moment& moment) const {
  // The sets are of the current position: move the slab by the displacement since.
  const Vector3d displacement_W =
      moment.displacement_since_W + moment.age_s * kalman_.velocity_correction_W();
  EchoSlab moved = slab;
  moved.lower_m += slab.normal_W.dot(displacement_W);
  moved.upper_m += slab.normal_W.dot(displacement_W);
  return horizontal_slab(moved, kalman_.p_W().z(),
                         params_.bound_sigma * std::sqrt(kalman_.position_covariance()(2, 2)));
}

DatumStatus DistanceFilterLaw::fuse_truncated(const EchoSlab2& slab) {
  const Vector2d p = kalman_.p_W().head<2>();
  const Matrix2d P = kalman_.position_covariance().topLeftCorner<2, 2>();
  const Vector2d Pa = P * slab.a;
  const double s = std::sqrt(slab.a.dot(Pa));
  const double from = (slab.lower_m - slab.a.dot(p)) / s, to = (slab.upper_m - slab.a.dot(p)) / s;
  const auto density = [](double w) {
    return std::exp(-0.5 * w * w) / std::sqrt(2.0 * std::numbers::pi);
  };
  const auto below = [](double w) { return 0.5 * std::erfc(-w / std::numbers::sqrt2); };
  const double mass = below(to) - below(from);
  if (!(mass > 1e-6)) return DatumStatus::kGated;
  const double mean = (density(from) - density(to)) / mass;
  const double variance = 1.0 + (from * density(from) - to * density(to)) / mass - mean * mean;
  if (!(variance > 1e-9)) return DatumStatus::kNotPositive;
  return kalman_.replace_horizontal(p + mean / s * Pa,
                                    P - (1.0 - variance) / (s * s) * (Pa * Pa.transpose()));
}

DatumStatus DistanceFilterLaw::fuse_cut(const EchoSlab2& slab) {
  const double k = params_.set_scale;
  const CutOptions options{params_.printed_square_root};
  if (params_.fusion == DistanceFusion::kJoint) {
    const ParallelCut cut =
        cut_ellipsoid<2>(joint_centre_, joint_shape_, slab.a, slab.lower_m, slab.upper_m, options);
    joint_cut_ |= cut.cuts();
    return cut.cuts() || cut.status == CutStatus::kNoUpdate ? DatumStatus::kAccepted
                                                            : DatumStatus::kGated;
  }
  Vector2d centre = kalman_.p_W().head<2>();
  const Vector2d before = centre;
  Matrix2d shape = k * k * kalman_.position_covariance().topLeftCorner<2, 2>();
  const double spread = std::sqrt(slab.a.dot(shape * slab.a));
  const ParallelCut cut =
      cut_ellipsoid<2>(centre, shape, slab.a, slab.lower_m, slab.upper_m, options);
  if (cut.status == CutStatus::kNoUpdate) return DatumStatus::kAccepted;
  if (!cut.cuts()) return DatumStatus::kGated;
  switch (params_.fusion) {
    case DistanceFusion::kReplace:
      return kalman_.replace_horizontal(centre, shape / (k * k));
    case DistanceFusion::kIncrementMatrix:
      return fuse_increment_matrix(centre, shape / (k * k));
    case DistanceFusion::kIncrement: {
      const PseudoMeasurement pseudo = pseudo_measurement(cut, slab.a.dot(before), spread, k);
      if (!pseudo.valid) return DatumStatus::kAccepted;
      PositionKalman::Scalar datum;
      datum.gradient.head<2>() = slab.a;
      datum.innovation = pseudo.value - slab.a.dot(before);
      datum.variance = pseudo.variance;
      return kalman_.correct(datum);
    }
    default:
      return kalman_.correct_horizontal(centre, shape / (k * k));
  }
}

DatumStatus DistanceFilterLaw::fuse_increment_matrix(const Vector2d& centre,
                                                     const Matrix2d& covariance_m2) {
  const Vector2d p = kalman_.p_W().head<2>();
  const Matrix2d after = covariance_m2.inverse();
  const Matrix2d added = after - kalman_.position_covariance().topLeftCorner<2, 2>().inverse();
  // Information along each principal axis of the difference; negative information is left out.
  const SymmetricEigen<2> axes = decompose_symmetric<2>(0.5 * (added + added.transpose()));
  const Vector2d moved = after * (centre - p);
  const Matrix2d& directions = axes.vectors;
  for (int i = 0; i < 2; ++i) {
    const double information = axes.values[i];
    if (!(information > 1e-9)) continue;
    PositionKalman::Scalar datum;
    datum.gradient.head<2>() = directions.col(i);
    datum.innovation = directions.col(i).dot(moved) / information -
                       directions.col(i).dot(kalman_.p_W().head<2>() - p);
    datum.variance = 1.0 / information;
    if (const auto status = kalman_.correct(datum); status != DatumStatus::kAccepted) return status;
  }
  return DatumStatus::kAccepted;
}

DatumStatus DistanceFilterLaw::finish_joint() {
  const double k2 = params_.set_scale * params_.set_scale;
  return kalman_.correct_horizontal(joint_centre_, joint_shape_ / k2);
}

}  // namespace vinerow::controllers
