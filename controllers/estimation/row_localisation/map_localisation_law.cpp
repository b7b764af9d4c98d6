#include "controllers/estimation/row_localisation/map_localisation_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/map.h"
#include "engine/core/check.h"
#include "engine/math/angles.h"
#include "engine/math/polyline.h"

namespace vinerow::controllers {
namespace {

// An ideal receiver states zero; a millimetre keeps the innovation variance positive. Chosen.
constexpr double kMinFixVariance_m2 = 1e-6;

}  // namespace

// Measurement models. State of LocalisationState: position p, velocity error b, heading error psi,
// fix error e and map shift m, all in W. A measurement of age T is compared with the pose at its
// own time, p - D with D the integrated displacement since then.
//
// Range, on the map M (shifted by m in W):
//
//   X_MB = (Rz(-psi) R_WB, p - D - m),   h = first return over the cone at X_MB
//   dh/dp = g = -N / (N.u),   dh/dm = -g,   dh/dpsi = -(dh/dyaw)
//
// The tangent of a rough wall holds over centimetres only. So the derivative along the row comes
// from a regression over the distribution of p - m along the row (predict_spread):
//
//   g <- g + (slope - g.a) a,   a the direction of the row
//
// Variance of the noise, with f the factor for errors that stay the same along the row:
//
//   r = f (sigma_map^2 / (N.u)^2 + rough^2) + bound^2/3 + (dh/dpsi sigma_white)^2 [+ height^2]
//
// An echo is either true, with N(z; h, s) and s = H P H' + r, or false, uniform over the range:
//
//   log L = max(log(q / range), log(1 - q) - nu^2/(2s) - log(2 pi s)/2) / f
//
// The division by f tempers the likelihood: f readings with the same error count as one.
//
// Fix of the antenna: z = p - D + R p_BA + e, axis by axis. Plane: z = n.(p - D).

MapLocalisationLaw::MapLocalisationLaw(const MapLocalisationParams& params, const RowMap& map,
                                       const RowMeshIndex& index,
                                       std::vector<RangeSensorModel> sensors)
    : params_(params),
      map_(map),
      index_(index),
      sensors_(std::move(sensors)),
      last_range_(sensors_.size()) {
  params_.bank = std::clamp(params_.bank, 1, kMaxFilters);
}

void MapLocalisationLaw::start(Time now, const Eigen::Vector3d& p_W,
                               const Eigen::Matrix3d& covariance_m2) {
  now_ = now;
  displacement_W_.setZero();
  past_count_ = past_next_ = 0;
  has_fix_ = false;
  gated_share_ = 0.0;
  std::fill(last_range_.begin(), last_range_.end(), std::nullopt);
  start_bank(p_W, covariance_m2);
}

void MapLocalisationLaw::predict(Time now, const Eigen::Vector3d& v_W,
                                 const Eigen::Quaterniond& q_WB) {
  if (!v_W.allFinite() || !q_WB.coeffs().allFinite() || now < now_) {
    ++counters_.refused;
    return;
  }
  const double dt_s = (now - now_).s();
  now_ = now;
  v_W_ = v_W;
  if (dt_s > 0.0) {
    displacement_W_ += dt_s * v_W;
    for (int i = 0; i < count_; ++i) filters_[i].state.predict(v_W, dt_s);
  }
  past_[past_next_] = {now, displacement_W_, q_WB};
  past_next_ = (past_next_ + 1) % kMemory;
  past_count_ = std::min(past_count_ + 1, kMemory);
}

bool MapLocalisationLaw::recall(Time measured, Past& past) const {
  if (past_count_ == 0 || measured > now_) return false;
  const auto at = [&](int age) -> const Past& {
    return past_[(past_next_ + kMemory - 1 - age) % kMemory];
  };
  for (int age = 0; age < past_count_; ++age) {
    if (at(age).time > measured) continue;
    past = at(age);
    if (age > 0 && past.time < measured) {
      const Past& newer = at(age - 1);
      const double share = (measured - past.time).s() / (newer.time - past.time).s();
      past.displacement_W += share * (newer.displacement_W - past.displacement_W);
      past.q_WB = past.q_WB.slerp(share, newer.q_WB);
    }
    return true;
  }
  return false;
}

const PlantRow* MapLocalisationLaw::find_row(int id) const {
  for (const PlantRow& row : map_.rows) {
    if (row.id == id) return &row;
  }
  return nullptr;
}

double MapLocalisationLaw::take_echo(Filter& filter, const Past& past,
                                     const Eigen::Vector3d& displacement_since_W,
                                     const RangeSensorModel& sensor, double range_m,
                                     double period_s, bool is_best) {
  LocalisationState& state = filter.state;
  // Predict the reading at the pose of its own time, in the frame of the map.
  const double log_false = std::log(params_.false_share / params_.max_range_m);
  const Pose X_MB{
      Eigen::AngleAxisd(-state.heading_error_rad(), Eigen::Vector3d::UnitZ()) * past.q_WB,
      state.p_W() - displacement_since_W - state.map_shift_W()};
  const auto prediction = predict_range(index_, X_MB, sensor, params_.max_range_m);
  const double inflation =
      correlation_inflation(map_.accuracy.correlation_length_m,
                            std::max(v_W_.head<2>().norm(), params_.min_speed_mps), period_s);
  if (!prediction) {
    if (is_best) ++counters_.echoes_unexplained;
    return log_false / inflation;
  }
  Eigen::Vector3d gradient = prediction->gradient_p();
  double expected_m = prediction->range_m;
  double rough_m2 = 0.0;  // roughness of the wall over the possible positions along the row
  if (const PlantRow* row = find_row(prediction->hit.row)) {
    const Eigen::Vector3d edge_W = nearest_from_above(row->line_W, X_MB.p.head<2>()).edge;
    // Map and truth differ most at the ends of a run of plants: such echoes are not used.
    if (std::abs(prediction->hit.normal_W.head<2>().dot(edge_W.head<2>().normalized())) >
        params_.max_along) {
      if (is_best) ++counters_.echoes_unexplained;
      return log_false / inflation;
    }
    // Standard deviation of p - m along the row, and the regression line over it.
    const Eigen::Vector3d along_W = edge_W.normalized();
    LocalisationState::Vector on_map = LocalisationState::Vector::Zero();
    on_map.segment<3>(LocalisationState::kPosition) = along_W;
    on_map.segment<3>(LocalisationState::kMap) = -along_W;
    const double std_m = std::sqrt(std::max(0.0, state.innovation_variance(on_map, 0.0)));
    const bool stands = v_W_.head<2>().norm() < params_.min_speed_mps;
    const SpreadPrediction spread =
        predict_spread(index_, X_MB, sensor, params_.max_range_m, *prediction, along_W, std_m,
                       params_.max_along, stands);
    expected_m = spread.range_m;
    gradient += (spread.slope - gradient.dot(along_W)) * along_W;
    rough_m2 = spread.variance_m2;
  }
  double height_m2 = 0.0;  // variance of the echo from the height, which it must not correct
  if (!params_.walls_correct_height) {
    LocalisationState::Vector up = LocalisationState::Vector::Zero();
    up[LocalisationState::kPosition + 2] = gradient.z();
    up[LocalisationState::kMap + 2] = -gradient.z();
    height_m2 = std::max(0.0, state.innovation_variance(up, 0.0));
    gradient.z() = 0.0;
  }
  // H and r of the header comment.
  LocalisationState::Vector h = LocalisationState::Vector::Zero();
  h.segment<3>(LocalisationState::kPosition) = gradient;
  h.segment<3>(LocalisationState::kMap) = -gradient;
  h[LocalisationState::kHeading] = -prediction->gradient_yaw(X_MB.p);
  double r = range_variance(*prediction, X_MB.p, map_.accuracy.surface_std_m, inflation,
                            sensor.bound_m, params_.heading_white_std_rad) +
             inflation * rough_m2 + height_m2;
  const double innovation = range_m - expected_m;
  const double s = state.innovation_variance(h, r);
  const double sigmas = std::abs(innovation) / std::sqrt(s);
  const double log_true =
      std::log1p(-params_.false_share) - 0.5 * sigmas * sigmas - 0.5 * std::log(2.0 * kPi * s);
  if (sigmas > params_.gate_sigma) {
    if (is_best) ++counters_.echoes_gated;
    return std::max(log_false, log_true) / inflation;
  }
  if (is_best) {
    ++counters_.echoes;
    const double alone = range_variance(*prediction, X_MB.p, map_.accuracy.surface_std_m, 1.0,
                                        sensor.bound_m, params_.heading_white_std_rad) +
                         rough_m2 + height_m2;
    range_nis_ = innovation * innovation / state.innovation_variance(h, alone);
  }
  // Huber: r grows with |nu|, so that the correction stays bounded if r dominates s.
  if (sigmas > params_.huber_sigma) r *= sigmas / params_.huber_sigma;
  state.correct(h, innovation, r);
  return std::max(log_false, log_true) / inflation;
}

double MapLocalisationLaw::take_fix(Filter& filter, const Past& past,
                                    const Eigen::Vector3d& displacement_since_W,
                                    const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m,
                                    const Eigen::Vector3d& p_BA, bool is_best) {
  LocalisationState& state = filter.state;
  const auto innovation_of = [&] {
    return Eigen::Vector3d(p_W - (state.p_W() - displacement_since_W + past.q_WB * p_BA) -
                           state.fix_error_W());
  };
  double log_likelihood = 0.0;
  double nis = 0.0;  // of all axes, each given those before
  bool gated = false;
  for (int axis = 0; axis < 3; ++axis) {
    LocalisationState::Vector h = LocalisationState::Vector::Zero();
    h[LocalisationState::kPosition + axis] = 1.0;
    h[LocalisationState::kFix + axis] = 1.0;
    const double r = std::max(std_m[axis] * std_m[axis], kMinFixVariance_m2);
    const double s = state.innovation_variance(h, r);
    const double innovation = innovation_of()[axis];
    const double squares = innovation * innovation / s;
    log_likelihood -= 0.5 * std::min(squares, params_.fix_gate_sigma * params_.fix_gate_sigma) +
                      0.5 * std::log(s);
    if (squares > params_.fix_gate_sigma * params_.fix_gate_sigma) {
      gated = true;
      continue;
    }
    nis += squares;
    state.correct(h, innovation, r);
  }
  if (is_best) ++(gated ? counters_.fixes_gated : counters_.fixes);
  if (is_best && !gated) fix_nis_ = nis;
  return log_likelihood;
}

Eigen::Vector3d MapLocalisationLaw::split_fix(const Eigen::Vector3d& std_m, int mode) {
  // Variances: slow part share * std^2, white part (1 - share) * std^2.
  if (!(params_.fix_slow_share > 0.0)) return std_m;
  const double slow = std::sqrt(params_.fix_slow_share);
  LocalisationNoise& noise = params_.noise;
  noise.fix_horizontal_m.std = slow * std_m.head<2>().norm() / std::sqrt(2.0);
  noise.fix_vertical_m.std = slow * std_m.z();
  const bool is_another = !has_fix_ || mode != fix_mode_;
  fix_mode_ = mode;
  for (int i = 0; i < count_; ++i) {
    filters_[i].state.set_fix_error(noise.fix_horizontal_m, noise.fix_vertical_m, is_another);
  }
  return std::sqrt(1.0 - params_.fix_slow_share) * std_m;
}

void MapLocalisationLaw::correct_fix(Time measured, const Eigen::Vector3d& p_W,
                                     const Eigen::Vector3d& stated_m, const Eigen::Vector3d& p_BA,
                                     int mode) {
  Past past;
  if (!has_started() || !p_W.allFinite() || !stated_m.allFinite() || !recall(measured, past)) {
    ++counters_.refused;
    return;
  }
  const Eigen::Vector3d std_m = split_fix(stated_m, mode);
  const Eigen::Vector3d displacement_since_W = displacement_W_ - past.displacement_W;
  for (int i = 0; i < count_; ++i) {
    filters_[i].log_gain =
        take_fix(filters_[i], past, displacement_since_W, p_W, std_m, p_BA, i == best_);
  }
  weigh();
  last_fix_ = {p_W - past.q_WB * p_BA, displacement_W_ - displacement_since_W, std_m};
  has_fix_ = true;
  // Such an unlikely error of the fixes means that the vehicle is in another alley.
  const Eigen::Vector2d slow_m = state().fix_error_W().head<2>();
  const double std_slow_m = params_.noise.fix_horizontal_m.std;
  if (std_slow_m > 0.0 && slow_m.norm() > params_.lost_fix_sigma * std_slow_m) restart();
}

void MapLocalisationLaw::correct_plane(Time measured, const Eigen::Vector3d& normal_W,
                                       double offset_m, double std_m) {
  Past past;
  if (!has_started() || !std::isfinite(offset_m) || !(std_m > 0.0) || !recall(measured, past)) {
    ++counters_.refused;
    return;
  }
  LocalisationState::Vector h = LocalisationState::Vector::Zero();
  h.segment<3>(LocalisationState::kPosition) = normal_W;
  const Eigen::Vector3d displacement_since_W = displacement_W_ - past.displacement_W;
  const double r = std_m * std_m;
  for (int i = 0; i < count_; ++i) {
    LocalisationState& state = filters_[i].state;
    const double innovation = offset_m - normal_W.dot(state.p_W() - displacement_since_W);
    const double squares = innovation * innovation / state.innovation_variance(h, r);
    const bool gated = squares > params_.fix_gate_sigma * params_.fix_gate_sigma;
    if (i == best_) ++(gated ? counters_.heights_gated : counters_.heights);
    if (!gated) state.correct(h, innovation, r);
  }
}

void MapLocalisationLaw::correct_range(Time measured, int sensor, double range_m, double period_s) {
  VINEROW_DEMAND(sensor >= 0 && sensor < static_cast<int>(sensors_.size()));
  Past past;
  if (!has_started() || !std::isfinite(range_m) || range_m < 0.0 || !recall(measured, past) ||
      (last_range_[sensor] && measured <= *last_range_[sensor])) {
    ++counters_.refused;
    return;
  }
  last_range_[sensor] = measured;
  if (range_m > params_.max_range_m) return;
  const Eigen::Vector3d displacement_since_W = displacement_W_ - past.displacement_W;
  const int echoes_before = counters_.echoes;
  for (int i = 0; i < count_; ++i) {
    filters_[i].log_gain = take_echo(filters_[i], past, displacement_since_W, sensors_[sensor],
                                     range_m, period_s, i == best_);
  }
  const bool is_accepted = counters_.echoes != echoes_before;
  weigh();
  // An echo without a wall counts as a rejected one: after entering the rows on a poor fix, only
  // such echoes show that the alley is wrong.
  watch_gates(!is_accepted, period_s);
}

}  // namespace vinerow::controllers
