#include "controllers/estimation/map_localisation_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow {
namespace {

using State = LocalisationState;

constexpr double kLeastWeight = 1e-6;  // a filter that is less likely is dropped
constexpr double kLeastPrior = 0.02;   // an alley beside is never ruled out by the start alone
constexpr double kSame_m = 0.3;        // filters as near as this are one

/// Nearest point of an alley's line, seen from above, and the direction there.
struct NearestPoint {
  Eigen::Vector3d p_W;
  Eigen::Vector2d along;
  double distance_m;
};

NearestPoint nearest_on(const std::vector<Eigen::Vector3d>& line_W, const Eigen::Vector3d& p_W) {
  NearestPoint nearest{p_W, {1, 0}, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i + 1 < line_W.size(); ++i) {
    const Eigen::Vector3d edge = line_W[i + 1] - line_W[i];
    const Eigen::Vector2d flat = edge.head<2>();
    const double t =
        std::clamp((p_W - line_W[i]).head<2>().dot(flat) / flat.squaredNorm(), 0.0, 1.0);
    const Eigen::Vector3d q_W = line_W[i] + t * edge;
    const double distance_m = (p_W - q_W).head<2>().norm();
    if (distance_m < nearest.distance_m) nearest = {q_W, flat.normalized(), distance_m};
  }
  return nearest;
}

}  // namespace

MapLocalisationLaw::MapLocalisationLaw(const MapLocalisationParams& params, const RowMap& map,
                                       const RowMeshIndex& index,
                                       std::vector<RangeSensorModel> sensors)
    : params_(params), map_(map), index_(index), sensors_(std::move(sensors)) {
  params_.bank = std::clamp(params_.bank, 1, kMostFilters);
}

void MapLocalisationLaw::start(Time now, const Eigen::Vector3d& p_W,
                               const Eigen::Matrix3d& covariance_m2) {
  now_ = now;
  way_W_.setZero();
  past_count_ = past_next_ = 0;
  has_fix_ = false;
  gated_share_ = 0.0;
  begin_bank(p_W, covariance_m2);
}

void MapLocalisationLaw::add_filter(const Eigen::Vector3d& p_W,
                                    const Eigen::Matrix3d& covariance_m2, double weight) {
  if (count_ == params_.bank) return;
  Filter& filter = filters_[count_++];
  const double own_m2 = params_.map_shift_std_m * params_.map_shift_std_m;
  const Eigen::Vector3d shift_std_m = (map_.accuracy.offset_std_m.array().square() + own_m2).sqrt();
  filter.state.start(params_.noise, p_W, covariance_m2, shift_std_m);
  filter.weight = weight;
}

void MapLocalisationLaw::begin_bank(const Eigen::Vector3d& p_W,
                                    const Eigen::Matrix3d& covariance_m2) {
  count_ = 0;
  best_ = 0;
  const double std_m = std::sqrt(covariance_m2.topLeftCorner<2, 2>().trace() / 2.0);
  if (params_.bank > 1 && std_m > params_.bank_std_m) {
    // A vehicle stands in an alley, not in a row: one filter in the middle of each within reach.
    struct Candidate {
      NearestPoint at;
      double weight;
    };
    std::array<Candidate, kMostFilters> candidates;
    int found = 0;
    for (const Alley& alley : map_.alleys) {
      const NearestPoint at = nearest_on(alley.line_W, p_W);
      if (!(at.distance_m < 3.0 * std_m + alley.width_m)) continue;
      const double spread_m = std::hypot(std_m, params_.start_lateral_std_m);
      const Candidate candidate{
          at, std::exp(-0.5 * std::pow(at.distance_m / spread_m, 2)) + kLeastPrior};
      // The likeliest first; of equals the first in the map.
      int place = found < params_.bank ? found++ : found;
      while (place > 0 && candidates[place - 1].weight < candidate.weight) {
        if (place < params_.bank) candidates[place] = candidates[place - 1];
        --place;
      }
      if (place < params_.bank) candidates[place] = candidate;
    }
    for (int i = 0; i < found; ++i) {
      const Eigen::Vector2d along = candidates[i].at.along, across(-along.y(), along.x());
      Eigen::Matrix3d covariance = covariance_m2;
      const double across_m2 = std::pow(params_.start_lateral_std_m, 2);
      covariance.topLeftCorner<2, 2>() =
          std_m * std_m * along * along.transpose() + across_m2 * across * across.transpose();
      const Eigen::Vector3d middle_W(candidates[i].at.p_W.x(), candidates[i].at.p_W.y(), p_W.z());
      add_filter(middle_W, covariance, candidates[i].weight);
    }
  }
  if (count_ == 0) add_filter(p_W, covariance_m2, 1.0);
  for (int i = 0; i < count_; ++i) filters_[i].log_gain = 0.0;
  weigh();
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
    way_W_ += dt_s * v_W;
    for (int i = 0; i < count_; ++i) filters_[i].state.predict(v_W, dt_s);
  }
  past_[past_next_] = {now, way_W_, q_WB};
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
      past.way_W += share * (newer.way_W - past.way_W);
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
                                     const Eigen::Vector3d& way_since_W,
                                     const RangeSensorModel& sensor, double range_m,
                                     double period_s, bool is_best) {
  State& state = filter.state;
  const double log_false = std::log(params_.false_share / params_.max_range_m);
  const Pose X_MB{
      Eigen::AngleAxisd(-state.heading_error_rad(), Eigen::Vector3d::UnitZ()) * past.q_WB,
      state.p_W() - way_since_W - state.map_shift_W()};
  const auto prediction = predict_range(index_, X_MB, sensor, params_.max_range_m);
  const double inflation =
      correlation_inflation(map_.accuracy.correlation_length_m,
                            std::max(v_W_.head<2>().norm(), params_.least_speed_mps), period_s);
  if (!prediction) {
    if (is_best) ++counters_.echoes_unexplained;
    return log_false / inflation;
  }
  // What closes a run of plants is where map and truth differ most: it tells nothing.
  if (const PlantRow* row = find_row(prediction->hit.row)) {
    const Eigen::Vector2d along = nearest_on(row->line_W, X_MB.p).along;
    if (std::abs(prediction->hit.normal_W.head<2>().dot(along)) > params_.most_along) {
      if (is_best) ++counters_.echoes_unexplained;
      return log_false / inflation;
    }
  }
  const Eigen::Vector3d gradient = prediction->gradient_p();
  State::Vector h = State::Vector::Zero();
  h.segment<3>(State::kPosition) = gradient;
  h.segment<3>(State::kMap) = -gradient;
  h[State::kHeading] = -prediction->gradient_yaw(X_MB.p);
  double r = range_variance(*prediction, X_MB.p, map_.accuracy.surface_std_m, inflation,
                            sensor.bound_m, params_.heading_white_std_rad);
  const double innovation = range_m - prediction->range_m;
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
    echo_sum_.nis += sigmas * sigmas;
    ++echo_sum_.count;
  }
  if (sigmas > params_.huber_sigma) r *= sigmas / params_.huber_sigma;
  state.correct(h, innovation, r);
  return std::max(log_false, log_true) / inflation;
}

double MapLocalisationLaw::take_fix(Filter& filter, const Past& past,
                                    const Eigen::Vector3d& way_since_W, const Eigen::Vector3d& p_W,
                                    const Eigen::Vector3d& std_m, const Eigen::Vector3d& p_BA,
                                    bool is_best) {
  State& state = filter.state;
  const auto innovation_of = [&] {
    return Eigen::Vector3d(p_W - (state.p_W() - way_since_W + past.q_WB * p_BA) -
                           state.fix_error_W());
  };
  double log_likelihood = 0.0;
  bool gated = false;
  for (int axis = 0; axis < 3; ++axis) {
    State::Vector h = State::Vector::Zero();
    h[State::kPosition + axis] = 1.0;
    h[State::kFix + axis] = 1.0;
    const double r = std::max(std_m[axis] * std_m[axis], 1e-6);
    const double s = state.innovation_variance(h, r);
    const double innovation = innovation_of()[axis];
    const double squares = innovation * innovation / s;
    log_likelihood -= 0.5 * std::min(squares, params_.fix_gate_sigma * params_.fix_gate_sigma) +
                      0.5 * std::log(s);
    if (squares > params_.fix_gate_sigma * params_.fix_gate_sigma) {
      gated = true;
      continue;
    }
    if (is_best) {
      fix_sum_.nis += squares;
      ++fix_sum_.count;
    }
    state.correct(h, innovation, r);
  }
  if (is_best) ++(gated ? counters_.fixes_gated : counters_.fixes);
  return log_likelihood;
}

void MapLocalisationLaw::correct_fix(Time measured, const Eigen::Vector3d& p_W,
                                     const Eigen::Vector3d& std_m, const Eigen::Vector3d& p_BA) {
  Past past;
  if (!has_started() || !p_W.allFinite() || !std_m.allFinite() || !recall(measured, past)) {
    ++counters_.refused;
    return;
  }
  const Eigen::Vector3d way_since_W = way_W_ - past.way_W;
  for (int i = 0; i < count_; ++i) {
    filters_[i].log_gain = take_fix(filters_[i], past, way_since_W, p_W, std_m, p_BA, i == best_);
  }
  weigh();
  last_fix_ = {p_W - past.q_WB * p_BA, way_W_ - way_since_W, std_m};
  has_fix_ = true;
  // A fix's error that is this unlikely means another alley.
  const Eigen::Vector2d slow_m = state().fix_error_W().head<2>();
  const double std_slow_m = params_.noise.fix_horizontal_m.std;
  if (std_slow_m > 0.0 && slow_m.norm() > params_.lost_fix_sigma * std_slow_m) begin_anew();
}

void MapLocalisationLaw::correct_plane(Time measured, const Eigen::Vector3d& normal_W,
                                       double offset_m, double std_m) {
  Past past;
  if (!has_started() || !std::isfinite(offset_m) || !(std_m > 0.0) || !recall(measured, past)) {
    ++counters_.refused;
    return;
  }
  State::Vector h = State::Vector::Zero();
  h.segment<3>(State::kPosition) = normal_W;
  const Eigen::Vector3d way_since_W = way_W_ - past.way_W;
  const double r = std_m * std_m;
  for (int i = 0; i < count_; ++i) {
    State& state = filters_[i].state;
    const double innovation = offset_m - normal_W.dot(state.p_W() - way_since_W);
    const double squares = innovation * innovation / state.innovation_variance(h, r);
    const bool gated = squares > params_.fix_gate_sigma * params_.fix_gate_sigma;
    if (i == best_) ++(gated ? counters_.heights_gated : counters_.heights);
    if (!gated) state.correct(h, innovation, r);
  }
}

void MapLocalisationLaw::correct_range(Time measured, int sensor, double range_m, double period_s) {
  VINEROW_DEMAND(sensor >= 0 && sensor < static_cast<int>(sensors_.size()));
  Past past;
  if (!has_started() || !std::isfinite(range_m) || range_m < 0.0 || !recall(measured, past)) {
    ++counters_.refused;
    return;
  }
  if (range_m > params_.max_range_m) return;
  const Eigen::Vector3d way_since_W = way_W_ - past.way_W;
  const int taken_before = counters_.echoes;
  for (int i = 0; i < count_; ++i) {
    filters_[i].log_gain =
        take_echo(filters_[i], past, way_since_W, sensors_[sensor], range_m, period_s, i == best_);
  }
  const bool gated = counters_.echoes == taken_before;
  weigh();
  watch_gates(gated, period_s);
}

void MapLocalisationLaw::weigh() {
  double largest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < count_; ++i) largest = std::max(largest, filters_[i].log_gain);
  double sum = 0.0;
  for (int i = 0; i < count_; ++i) {
    filters_[i].weight *= std::exp(filters_[i].log_gain - largest);
    if (!filters_[i].state.is_sound()) filters_[i].weight = 0.0;
    sum += filters_[i].weight;
  }
  if (!(sum > 0.0)) {
    // Every filter has lost its footing: what is left is the first one's position, widely.
    ++counters_.lost;
    const Eigen::Vector3d p_W = filters_[0].state.p_W();
    count_ = 0;
    add_filter(p_W.allFinite() ? p_W : Eigen::Vector3d(Eigen::Vector3d::Zero()),
               Eigen::Matrix3d::Identity(), 1.0);
    best_ = 0;
    return;
  }
  for (int i = 0; i < count_; ++i) filters_[i].weight /= sum;
  // Those that are unlikely, or follow another one, go.
  int kept = 0;
  for (int i = 0; i < count_; ++i) {
    bool goes = filters_[i].weight < kLeastWeight;
    for (int k = 0; k < count_ && !goes; ++k) {
      const bool is_stronger = filters_[k].weight > filters_[i].weight ||
                               (filters_[k].weight == filters_[i].weight && k < i);
      goes = k != i && is_stronger &&
             (filters_[k].state.p_W() - filters_[i].state.p_W()).norm() < kSame_m;
    }
    if (goes) continue;
    if (kept != i) filters_[kept] = filters_[i];
    ++kept;
  }
  count_ = kept;
  sum = 0.0;
  best_ = 0;
  for (int i = 0; i < count_; ++i) {
    sum += filters_[i].weight;
    if (filters_[i].weight > filters_[best_].weight) best_ = i;
  }
  for (int i = 0; i < count_; ++i) filters_[i].weight /= sum;
}

void MapLocalisationLaw::watch_gates(bool gated, double period_s) {
  const double share =
      std::min(1.0, period_s / params_.lost_time_s / static_cast<double>(sensors_.size()));
  gated_share_ += share * ((gated ? 1.0 : 0.0) - gated_share_);
  if (gated_share_ < params_.lost_share) return;
  begin_anew();
}

void MapLocalisationLaw::begin_anew() {
  ++counters_.lost;
  gated_share_ = 0.0;
  if (!has_fix_) {
    begin_bank(state().p_W(), Eigen::Matrix3d::Identity());
    return;
  }
  const LocalisationNoise& noise = params_.noise;
  const Eigen::Vector3d slow_m(noise.fix_horizontal_m.std, noise.fix_horizontal_m.std,
                               noise.fix_vertical_m.std);
  const Eigen::Vector3d variance_m2 = last_fix_.std_m.cwiseAbs2() + slow_m.cwiseAbs2();
  begin_bank(last_fix_.p_W + way_W_ - last_fix_.way_W, variance_m2.asDiagonal());
}

Eigen::Matrix3d MapLocalisationLaw::position_covariance() const {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int i = 0; i < count_; ++i) {
    const State& other = filters_[i].state;
    const Eigen::Vector3d beside_m = other.p_W() - state().p_W();
    covariance += filters_[i].weight * (Eigen::Matrix3d(other.covariance().topLeftCorner<3, 3>()) +
                                        beside_m * beside_m.transpose());
  }
  return covariance;
}

double MapLocalisationLaw::echo_nis() const {
  return echo_sum_.count > 0 ? echo_sum_.nis / echo_sum_.count : 0.0;
}
double MapLocalisationLaw::fix_nis() const {
  return fix_sum_.count > 0 ? fix_sum_.nis / fix_sum_.count : 0.0;
}

}  // namespace vinerow
