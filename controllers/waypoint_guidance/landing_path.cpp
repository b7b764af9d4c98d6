#include "controllers/waypoint_guidance/landing_path.h"

#include <algorithm>
#include <cmath>

#include "engine/core/check.h"

namespace vinerow::controllers {
namespace {

/// Half the width of the means: no aircraft follows waves shorter than twice this.
constexpr int kHalf = 3;

/// Means over 2 kHalf + 1 samples, fewer at the ends.
std::vector<double> smooth(const std::vector<double>& values) {
  const int count = static_cast<int>(values.size());
  std::vector<double> means(values.size());
  for (int i = 0; i < count; ++i) {
    const int reach = std::min({kHalf, i, count - 1 - i});
    double sum = 0.0;
    for (int k = i - reach; k <= i + reach; ++k) sum += values[static_cast<std::size_t>(k)];
    means[static_cast<std::size_t>(i)] = sum / (2 * reach + 1);
  }
  return means;
}

}  // namespace

LandingPath::LandingPath(const LandingSlope& slope, const LandingLine& line,
                         const GroundBelow& ground, double lift_m)
    : slope_(slope), length_m_(line.length_m) {
  const auto count = static_cast<std::size_t>((length_m_ + kBeyond_m) / kStep_m) + 2;
  const auto to_go_m = [&](std::size_t i) { return length_m_ - kStep_m * static_cast<double>(i); };
  // Gaps and places beyond the map take the height of the known place nearest to the touchdown.
  std::vector<double> heights_m(count);
  const auto at_place = std::min(static_cast<std::size_t>(length_m_ / kStep_m), count - 1);
  double last_m = 0.0;
  const auto look = [&](std::size_t i) {
    const auto height_m = ground(line.place - to_go_m(i) * line.along);
    if (height_m) last_m = *height_m + lift_m;
    heights_m[i] = last_m;
  };
  const auto under_place = ground(line.place);
  VINEROW_DEMAND(under_place.has_value());
  last_m = *under_place + lift_m;
  for (std::size_t i = at_place; i < count; ++i) look(i);
  last_m = *under_place + lift_m;
  for (std::size_t i = at_place; i-- > 0;) look(i);
  ground_ = smooth(smooth(heights_m));

  const double flare_m = slope_.flare_m();
  const double flare_length_m = slope_.length_m(flare_m);
  const double foot_m = lying(flare_length_m).height_m;
  path_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double left_m = to_go_m(i);
    const double above_m = slope_.at(left_m).height_m - slope_.touchdown_m();
    if (left_m <= flare_length_m) {
      path_[i] = ground_[i] + above_m;
      continue;
    }
    // Before the flare not below it, and clear of it by more with distance.
    constexpr double kClear_m = 2.0, kClearer = 0.05;
    const double clear_m = flare_m + std::min(kClear_m, kClearer * (left_m - flare_length_m));
    path_[i] = std::max(foot_m + above_m, ground_[i] + clear_m);
  }
  path_ = smooth(path_);
}

HeightPoint LandingPath::pick(const std::vector<double>& heights_m, double to_go_m,
                              HeightPoint level) const {
  if (heights_m.empty()) return level;
  const double place = std::clamp((length_m_ - to_go_m) / kStep_m, 0.0,
                                  static_cast<double>(heights_m.size() - 1) - 1e-9);
  const auto index = static_cast<std::size_t>(place);
  const double rise_m = heights_m[index + 1] - heights_m[index];
  return {heights_m[index] + (place - static_cast<double>(index)) * rise_m, rise_m / kStep_m};
}

double LandingPath::highest_m() const {
  const auto count = static_cast<std::ptrdiff_t>(length_m_ / kStep_m) + 1;
  return *std::max_element(path_.begin(), path_.begin() + count);
}

double LandingPath::rise() const {
  // The slide is about as long as the flare.
  const double reach_m = slope_.length_m(slope_.flare_m());
  return (lying(-reach_m).height_m - lying(reach_m).height_m) / (2.0 * reach_m);
}

double LandingPath::steepest_fall() const {
  const double reach_m = slope_.length_m(slope_.flare_m());
  double fall = 0.0;
  for (double to_go_m = reach_m; to_go_m > -kBeyond_m; to_go_m -= kStep_m) {
    fall = std::max(fall, -lying(to_go_m).slope);
  }
  return fall;
}

}  // namespace vinerow::controllers
