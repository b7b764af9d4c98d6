// The bank of filters: one for each possible alley, reweighted, dropped, and restarted when lost.

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/estimation/row_localisation/map_localisation_law.h"
#include "engine/api/map.h"
#include "engine/math/polyline.h"

namespace vinerow::controllers {
namespace {

constexpr double kMinWeight = 1e-6;  // a filter with a smaller weight is dropped
constexpr double kMinPrior = 0.02;   // the start alone never rules out a neighbouring alley
constexpr double kSame_m = 0.3;      // filters closer than this are the same hypothesis,
constexpr double kMuchWider = 3.0;   // except if their deviation is this many times larger

/// Whether a filter adds nothing to another one. A filter at the same position with a much larger
/// deviation is kept, since it may move elsewhere: if the other filter is lost, it is the only one
/// left in their alley.
bool follows(const LocalisationState& state, const LocalisationState& other) {
  const auto variance_m2 = [](const LocalisationState& s) {
    return s.covariance().topLeftCorner<2, 2>().trace();
  };
  return (other.p_W() - state.p_W()).norm() < kSame_m &&
         variance_m2(state) < kMuchWider * kMuchWider * variance_m2(other);
}

}  // namespace

Eigen::Array3d MapLocalisationLaw::map_shift_variance_m2() const {
  const double own_m2 = params_.map_shift_std_m * params_.map_shift_std_m;
  return map_.accuracy.offset_std_m.array().square() + own_m2;
}

void MapLocalisationLaw::add_filter(const Eigen::Vector3d& p_W,
                                    const Eigen::Matrix3d& covariance_m2, double weight) {
  if (count_ == params_.bank) return;
  Filter& filter = filters_[count_++];
  const Eigen::Vector3d shift_std_m = map_shift_variance_m2().sqrt();
  filter.state.start(params_.noise, p_W, covariance_m2, shift_std_m);
  filter.weight = weight;
}

void MapLocalisationLaw::start_bank(const Eigen::Vector3d& p_W,
                                    const Eigen::Matrix3d& covariance_m2) {
  count_ = 0;
  best_ = 0;
  const double std_m = std::sqrt(covariance_m2.topLeftCorner<2, 2>().trace() / 2.0);
  if (params_.bank > 1 && std_m > params_.bank_std_m) {
    // A vehicle is in an alley, not in a row: one filter in the middle of each alley within reach.
    struct Candidate {
      LinePoint at;
      double weight;
    };
    std::array<Candidate, kMaxFilters> candidates;
    int found = 0;
    for (const Alley& alley : map_.alleys) {
      const LinePoint at = nearest_from_above(alley.line_W, p_W.head<2>());
      if (!(at.distance_m < 3.0 * std_m + alley.width_m)) continue;
      const double spread_m = std::hypot(std_m, params_.start_lateral_std_m);
      const Candidate candidate{at,
                                std::exp(-0.5 * std::pow(at.distance_m / spread_m, 2)) + kMinPrior};
      // The likeliest first; among equals the first in the map.
      int place = found < params_.bank ? found++ : found;
      while (place > 0 && candidates[place - 1].weight < candidate.weight) {
        if (place < params_.bank) candidates[place] = candidates[place - 1];
        --place;
      }
      if (place < params_.bank) candidates[place] = candidate;
    }
    for (int i = 0; i < found; ++i) {
      const Eigen::Vector2d along = candidates[i].at.edge.head<2>().normalized();
      const Eigen::Vector2d across(-along.y(), along.x());
      Eigen::Matrix3d covariance = covariance_m2;
      const double across_m2 = std::pow(params_.start_lateral_std_m, 2);
      covariance.topLeftCorner<2, 2>() =
          std_m * std_m * along * along.transpose() + across_m2 * across * across.transpose();
      const Eigen::Vector3d middle_W(candidates[i].at.p.x(), candidates[i].at.p.y(), p_W.z());
      add_filter(middle_W, covariance, candidates[i].weight);
    }
  }
  if (count_ == 0) add_filter(p_W, covariance_m2, 1.0);
  reweight();
}

void MapLocalisationLaw::reweight() {
  for (int i = 0; i < count_; ++i) filters_[i].log_gain = 0.0;
  weigh();
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
    // No filter is sound: restart at the position of the first one with a wide covariance.
    ++counters_.lost;
    const Eigen::Vector3d p_W = filters_[0].state.p_W();
    count_ = 0;
    add_filter(p_W.allFinite() ? p_W : Eigen::Vector3d(Eigen::Vector3d::Zero()),
               Eigen::Matrix3d::Identity(), 1.0);
    best_ = 0;
    return;
  }
  for (int i = 0; i < count_; ++i) filters_[i].weight /= sum;
  // Drop filters that are unlikely or follow another one.
  int kept = 0;
  for (int i = 0; i < count_; ++i) {
    bool goes = filters_[i].weight < kMinWeight;
    for (int k = 0; k < count_ && !goes; ++k) {
      const bool is_stronger = filters_[k].weight > filters_[i].weight ||
                               (filters_[k].weight == filters_[i].weight && k < i);
      goes = k != i && is_stronger && follows(filters_[i].state, filters_[k].state);
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
  restart();
}

void MapLocalisationLaw::restart() {
  ++counters_.lost;
  gated_share_ = 0.0;
  const LocalisationNoise& noise = params_.noise;
  Filter old = filters_[best_];
  old.weight = 1.0;
  if (!has_fix_) {
    start_bank(old.state.p_W(), Eigen::Matrix3d::Identity());
    keep(old);
    return;
  }
  const Eigen::Vector3d slow_m(noise.fix_horizontal_m.std, noise.fix_horizontal_m.std,
                               noise.fix_vertical_m.std);
  const Eigen::Vector3d variance_m2 = last_fix_.std_m.cwiseAbs2() + slow_m.cwiseAbs2();
  start_bank(last_fix_.p_W + displacement_W_ - last_fix_.displacement_W, variance_m2.asDiagonal());
  // As likely as all new filters together, except for the slow error of the fixes that it implies.
  const double slow_sigma =
      old.state.fix_error_W().head<2>().norm() / std::max(noise.fix_horizontal_m.std, 1e-3);
  old.weight = std::exp(-0.5 * slow_sigma * slow_sigma);
  keep(old);
}

void MapLocalisationLaw::keep(const Filter& filter) {
  if (params_.bank == 1) return;
  // If the bank is full, it replaces the least likely new filter, which was added last.
  count_ = std::min(count_, params_.bank - 1);
  filters_[count_++] = filter;
  reweight();
}

Eigen::Matrix3d MapLocalisationLaw::position_covariance() const {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int i = 0; i < count_; ++i) {
    const LocalisationState& other = filters_[i].state;
    const Eigen::Vector3d offset_m = other.p_W() - state().p_W();
    covariance += filters_[i].weight * (Eigen::Matrix3d(other.covariance().topLeftCorner<3, 3>()) +
                                        offset_m * offset_m.transpose());
  }
  return covariance;
}

Eigen::Vector3d MapLocalisationLaw::position_on_map() const {
  return state().p_W() - state().map_shift_W();
}

Eigen::Matrix3d MapLocalisationLaw::position_on_map_covariance() const {
  Eigen::Matrix3d covariance = map_shift_variance_m2().matrix().asDiagonal();
  for (int i = 0; i < count_; ++i) {
    const LocalisationState& other = filters_[i].state;
    const auto block = [&](int row, int column) {
      return Eigen::Matrix3d(other.covariance().block<3, 3>(row, column));
    };
    const Eigen::Matrix3d shared = block(LocalisationState::kPosition, LocalisationState::kMap);
    const Eigen::Vector3d offset_m = other.p_W() - other.map_shift_W() - position_on_map();
    covariance +=
        filters_[i].weight * (block(LocalisationState::kPosition, LocalisationState::kPosition) +
                              block(LocalisationState::kMap, LocalisationState::kMap) - shared -
                              shared.transpose() + offset_m * offset_m.transpose());
  }
  return covariance;
}

}  // namespace vinerow::controllers
