#include "controllers/estimation/row_localisation/distance_filter_law.h"

#include <algorithm>
#include <cmath>

namespace vinerow::controllers {
namespace {

using Eigen::Vector3d;

// Values without a source are chosen.
constexpr double kMinSpeed_mps = 0.1;     // lower bound of the speed at which the map error changes
constexpr double kLongestPeriod_s = 1.0;  // a longer pause of a sensor is not its period
constexpr int kFixesToBelieve = 10;       // this many gated fixes in a row prove the estimate wrong
constexpr double kRandomWalk_m2_per_s = 0.023;      // R2, fitted to paper C's table 3
constexpr double kPositionFixWalk_m2_per_s = 1.98;  // R1, fitted to paper C's table 3
constexpr double kMaxNormError = 1e-3;  // of a quaternion: beyond it the message is broken
constexpr double kMinDrift_mps = 0.01;  // growth of the set even if the velocity has no slow error
constexpr std::size_t kSliceSegments = 8192;  // reserved, so that a step allocates nothing

}  // namespace

// Time T ago the vehicle was at
//
//   p_T = p - D - c T
//
// with p and c of the Kalman filter now and D the integrated displacement since then (position_at).
// All data are compared with p_T; their gradient is PositionKalman::gradient_of.
//
//   fix      z = p_T + R p_BA                       gate fix_gate_sigma
//   plane    z = n.p_T                              gate fix_gate_sigma
//   range    see DistanceFusion and distance_filter_law_fusion.cpp
//
// The integrity set is cut by the same data with bounds b = bound_sigma times their deviations. A
// slab at time T ago is moved by N.D and widened by b sigma_v T.

PositionKalmanParams kalman_params_of(InertialReading reading) {
  PositionKalmanParams params;
  if (reading == InertialReading::kVelocity) return params;
  params.velocity_std_mps = 0.0;
  params.walk_m2_per_s =
      reading == InertialReading::kPositionFix ? kPositionFixWalk_m2_per_s : kRandomWalk_m2_per_s;
  return params;
}

DistanceFilterLaw::DistanceFilterLaw(const DistanceFilterParams& params,
                                     const MapAccuracy& accuracy, const RowMeshIndex* map,
                                     std::vector<RangeSensorModel> sensors)
    : params_(params),
      accuracy_(accuracy),
      map_(map),
      sensors_(std::move(sensors)),
      sensor_states_(sensors_.size()),
      kalman_(params.kalman) {
  if (params_.association == EchoAssociation::kClosestSegment) slice_.reserve(kSliceSegments);
}

bool DistanceFilterLaw::start(Time now, const Vector3d& p_W, const Eigen::Matrix3d& covariance_m2) {
  if (!kalman_.start(now, p_W, covariance_m2)) {
    ++counters_.bad_numbers;
    return false;
  }
  now_ = {Vector3d::Zero(), q_WB_};
  trace_.clear();
  trace_.add(now, now_);
  start_set();
  return true;
}

void DistanceFilterLaw::start_set() {
  // The ellipsoid of shape 3 b^2 P, P diagonal, contains the box of half widths b sigma.
  const double scale = 3.0 * params_.bound_sigma * params_.bound_sigma;
  set_.start(kalman_.p_W(), scale * kalman_.position_covariance());
}

void DistanceFilterLaw::predict(Time now, const Vector3d& v_W, const Eigen::Quaterniond& q_WB,
                                double yaw_std_rad) {
  if (!has_started()) return;
  if (!v_W.allFinite() || !q_WB.coeffs().allFinite() ||
      !(std::abs(q_WB.norm() - 1.0) < kMaxNormError) || !std::isfinite(yaw_std_rad)) {
    ++counters_.bad_numbers;
    // Continue with the last valid data.
    if (now > kalman_.time()) predict(now, v_W_, q_WB_, yaw_std_rad_);
    return;
  }
  if (now < kalman_.time()) {
    ++counters_.backwards;
    return;
  }
  const double dt = (now - kalman_.time()).s();
  const Vector3d before = kalman_.p_W();
  kalman_.predict(now, v_W);
  set_.predict(kalman_.p_W() - before,
               dt * params_.bound_sigma * std::max(params_.kalman.velocity_std_mps, kMinDrift_mps));
  q_WB_ = q_WB;
  v_W_ = v_W;
  yaw_std_rad_ = yaw_std_rad;
  now_.displacement_W += std::min(dt, params_.kalman.longest_step_s) * v_W;
  now_.q_WB = q_WB;
  trace_.add(now, now_);
}

bool DistanceFilterLaw::recall(Time measured, Moment& moment) {
  if (!has_started() || measured < trace_.oldest()) {
    ++counters_.backwards;
    return false;
  }
  const Past past = trace_.at(measured);
  moment = {std::max(0.0, (kalman_.time() - measured).s()),
            now_.displacement_W - past.displacement_W, past.q_WB};
  return true;
}

Vector3d DistanceFilterLaw::position_at(const Moment& moment) const {
  return kalman_.p_W() - moment.displacement_since_W -
         moment.age_s * kalman_.velocity_correction_W();
}

void DistanceFilterLaw::count(DatumStatus status, int& accepted, int& gated) {
  switch (status) {
    case DatumStatus::kAccepted:
      ++accepted;
      break;
    case DatumStatus::kGated:
      ++gated;
      break;
    case DatumStatus::kBadNumber:
      ++counters_.bad_numbers;
      break;
    case DatumStatus::kNotPositive:
      ++counters_.not_positive;
      break;
    case DatumStatus::kBackwards:
      ++counters_.backwards;
      break;
  }
}

void DistanceFilterLaw::take_inertial_position(Time measured, const Vector3d& p_W,
                                               const Vector3d& std_m) {
  Moment moment;
  if (params_.reading != InertialReading::kPositionFix || !recall(measured, moment)) return;
  int accepted = 0, gated = 0;
  count(kalman_.correct_position(p_W - position_at(moment), std_m.cwiseAbs2(), moment.age_s, 0.0),
        accepted, gated);
}

void DistanceFilterLaw::take_fix(Time measured, const Vector3d& p_W, const Vector3d& std_m,
                                 const Vector3d& p_BA) {
  Moment moment;
  if (!recall(measured, moment)) return;
  const Vector3d p_B = p_W - moment.q_WB * p_BA;
  const Vector3d innovation = p_B - position_at(moment);
  const Vector3d variance = params_.fix_inflation * std_m.cwiseAbs2();
  DatumStatus status =
      kalman_.correct_position(innovation, variance, moment.age_s, params_.fix_gate_sigma);
  if (status != DatumStatus::kGated) fixes_gated_in_a_row_ = 0;
  // If every fix is gated for long, the estimate has diverged: widen it by the innovation.
  if (status == DatumStatus::kGated && ++fixes_gated_in_a_row_ >= kFixesToBelieve) {
    fixes_gated_in_a_row_ = 0;
    ++counters_.lost;
    kalman_.widen(innovation.cwiseAbs2());
    status = kalman_.correct_position(innovation, variance, moment.age_s, 0.0);
    start_set();
  }
  count(status, counters_.fixes, counters_.fixes_gated);
  if (status != DatumStatus::kAccepted) return;
  fix_nis_ = 3.0 * kalman_.last_nis();  // last_nis() is the mean over the coordinates
  cut_set_by_fix(p_B + moment.displacement_since_W, std_m);
}

void DistanceFilterLaw::take_plane(Time measured, const Vector3d& normal_W, double offset_m,
                                   double std_m) {
  Moment moment;
  if (!recall(measured, moment)) return;
  PositionKalman::Scalar datum;
  datum.gradient = PositionKalman::gradient_of(normal_W, moment.age_s);
  datum.innovation = offset_m - normal_W.dot(position_at(moment));
  datum.variance = std_m * std_m;
  datum.gate_sigma = params_.fix_gate_sigma;
  count(kalman_.correct(datum), counters_.heights, counters_.heights_gated);
}

bool DistanceFilterLaw::take_stamp(Time measured, SensorState& sensor) {
  if (sensor.has_read && measured <= sensor.last) {
    ++counters_.backwards;
    return false;
  }
  if (sensor.has_read) sensor.period_s = std::min((measured - sensor.last).s(), kLongestPeriod_s);
  sensor.has_read = true;
  sensor.last = measured;
  return true;
}

void DistanceFilterLaw::take_ranges(Time measured, std::span<const RangeReading> readings) {
  Moment moment;
  if (map_ == nullptr || !recall(measured, moment)) return;
  // kJoint: the ellipse of shape k^2 P starts at the prediction, and each echo cuts it.
  joint_centre_ = kalman_.p_W().head<2>();
  joint_shape_ =
      params_.set_scale * params_.set_scale * kalman_.position_covariance().topLeftCorner<2, 2>();
  joint_cut_ = false;
  for (const RangeReading& reading : readings) {
    SensorState& sensor = sensor_states_[reading.sensor];
    if (!take_stamp(measured, sensor)) continue;
    if (std::isnan(reading.range_m) || reading.range_m < 0.0) {
      ++counters_.bad_numbers;
      continue;
    }
    if (!(reading.range_m < reading.max_range_m)) continue;  // no echo
    const Vector3d p_m = position_at(moment);
    const auto echo = associate({moment.q_WB, p_m}, reading);
    if (!echo) {
      ++counters_.echoes_unmatched;
      continue;
    }
    const DatumStatus status = fuse(*echo, reading, moment, p_m);
    count(status, counters_.echoes, counters_.echoes_gated);
    watch(status != DatumStatus::kAccepted, sensor.period_s / static_cast<double>(sensors_.size()));
    if (status != DatumStatus::kAccepted) continue;
    cut_set(echo_slab(*echo, p_m, reading.range_m, bounds_of(reading)), moment);
  }
  if (joint_cut_ && params_.fusion == DistanceFusion::kJoint) {
    int accepted = 0, gated = 0;
    count(finish_joint(), accepted, gated);
  }
}

void DistanceFilterLaw::watch(bool refused, double weight_s) {
  if (params_.lost_time_s <= 0.0) return;
  // Low pass of the rejected share with the time constant lost_time_s.
  const double share = std::min(1.0, weight_s / params_.lost_time_s);
  refused_share_ += share * ((refused ? 1.0 : 0.0) - refused_share_);
  if (refused_share_ < params_.lost_share) return;
  refused_share_ = 0.0;
  ++counters_.lost;
  const double added = params_.lost_std_m * params_.lost_std_m;
  kalman_.widen({added, added, 0.0});
  start_set();
}

double DistanceFilterLaw::inflation_of(const SensorState& sensor) const {
  if (params_.inflation > 0.0) return params_.inflation;
  return correlation_inflation(accuracy_.correlation_length_m,
                               std::max(v_W_.head<2>().norm(), kMinSpeed_mps), sensor.period_s);
}

EchoBounds DistanceFilterLaw::bounds_of(const RangeReading& reading) const {
  return {sensors_[reading.sensor].bound_m, params_.bound_sigma * accuracy_.surface_std_m,
          params_.bound_sigma * yaw_std_rad_};
}

void DistanceFilterLaw::cut_set(const EchoSlab& slab, const Moment& moment) {
  // Move the slab from its own time to now by the integrated displacement.
  EchoSlab moved = slab;
  const double shift = slab.normal_W.dot(moment.displacement_since_W);
  const double drift = params_.bound_sigma * params_.kalman.velocity_std_mps * moment.age_s;
  moved.lower_m += shift - drift;
  moved.upper_m += shift + drift;
  if (set_.cut(moved) != CutStatus::kEmpty) return;
  ++counters_.set_restarts;
  start_set();
}

void DistanceFilterLaw::cut_set_by_fix(const Vector3d& p, const Vector3d& std_m) {
  for (int axis = 0; axis < 3; ++axis) {
    const double bound = params_.bound_sigma * std_m[axis];
    const EchoSlab slab{Vector3d::Unit(axis), p[axis] - bound, p[axis] + bound};
    if (set_.cut(slab) != CutStatus::kEmpty) continue;
    ++counters_.set_restarts;
    start_set();
    return;
  }
}

}  // namespace vinerow::controllers
