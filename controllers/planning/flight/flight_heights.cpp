#include "controllers/planning/flight/flight_heights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "controllers/parts/paths/box_filter.h"
#include "controllers/parts/paths/lift.h"
#include "engine/api/map.h"
#include "engine/math/polyline.h"

namespace vinerow::controllers {
namespace {

constexpr double kFlightStep_m = 0.05;

int last_of(const HeightProfile& profile) {
  return static_cast<int>(profile.samples_m().size()) - 1;
}

}  // namespace

FlightGround::FlightGround(const RowMap& map, const SceneQuery* scene, double flat_m)
    : map_(map), scene_(scene), flat_m_(flat_m) {}

std::optional<double> FlightGround::ground_m(const Eigen::Vector2d& p) const {
  if (scene_ == nullptr) return flat_m_;
  return scene_->ground_height_m(p.x(), p.y(), kAboveEverything_m);
}

std::optional<double> FlightGround::canopy_top_m(const Eigen::Vector2d& p, double reach_m) const {
  std::optional<double> top_m;
  for (const PlantRow& row : map_.rows) {
    const auto [q, edge, distance_m] = nearest_from_above(row.line_W, p);
    if (distance_m > 0.5 * row.canopy_width_m + reach_m) continue;
    // The row's line and the ground may differ in height: the higher one counts.
    const double foot_m =
        scene_ == nullptr ? q.z() : std::max(q.z(), ground_m(q.head<2>()).value_or(q.z()));
    top_m = std::max(top_m.value_or(-kAboveEverything_m), foot_m + row.canopy_top_m);
  }
  return top_m;
}

FlightGround::Nearest FlightGround::find_nearest_row(const Eigen::Vector2d& p) const {
  Nearest nearest;
  nearest.distance_m = nearest.centre_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < map_.rows.size(); ++i) {
    const double centre_m = nearest_from_above(map_.rows[i].line_W, p).distance_m;
    const double distance_m = centre_m - 0.5 * map_.rows[i].canopy_width_m;
    if (distance_m < nearest.distance_m) nearest = {distance_m, centre_m, static_cast<int>(i)};
  }
  return nearest;
}

double HeightProfile::at(double distance_m) const {
  const int last = static_cast<int>(heights_m_.size()) - 1;
  const double place = std::clamp(distance_m / step_m_, 0.0, static_cast<double>(last));
  const int i = std::min(static_cast<int>(place), std::max(last - 1, 0));
  const double share = place - i;
  return last == 0 ? heights_m_[0] : (1.0 - share) * heights_m_[i] + share * heights_m_[i + 1];
}

Result<HeightProfile> make_ground_profile(const Path& path, const FlightGround& ground) {
  const int parts = std::max(1, static_cast<int>(std::ceil(path.length_m() / kFlightStep_m)));
  const double step_m = path.length_m() / parts;
  std::vector<double> heights_m;
  heights_m.reserve(parts + 1);
  int segment = 0;
  for (int i = 0; i <= parts; ++i) {
    segment = path.segment_at(i * step_m, segment);
    const Eigen::Vector2d p = path.pose_at(i * step_m, segment).p;
    const auto height_m = ground.ground_m(p);
    if (!height_m) {
      return Failure{
          fmt::format("path leaves the ground: no ground at ({:.2f}, {:.2f})", p.x(), p.y())};
    }
    heights_m.push_back(*height_m);
  }
  return HeightProfile(step_m, std::move(heights_m));
}

HeightProfile make_row_profile(const HeightProfile& ground, double above_m, double smooth_m) {
  const int half = calc_half_window(0.5 * smooth_m, ground.step_m());
  std::vector<double> heights_m = smooth_box(ground.samples_m(), half, Beyond::kTurnedAbout);
  heights_m = smooth_box(heights_m, half, Beyond::kTurnedAbout);
  for (double& height_m : heights_m) height_m += above_m;
  return HeightProfile(ground.step_m(), std::move(heights_m));
}

HeightProfile make_return_profile(const Path& path, const HeightProfile& ground_m,
                                  const FlightGround& ground, double above_m, double reach_m,
                                  double smooth_m) {
  const double step_m = ground_m.step_m();
  const HeightProfile base = make_row_profile(ground_m, above_m, smooth_m);
  std::vector<double> excess_m;
  int segment = 0;
  for (int i = 0; i <= last_of(ground_m); ++i) {
    segment = path.segment_at(i * step_m, segment);
    const Eigen::Vector2d p = path.pose_at(i * step_m, segment).p;
    double needed_m = ground_m.samples_m()[i];
    // One step more, for canopies between the samples.
    if (const auto top_m = ground.canopy_top_m(p, reach_m + step_m)) {
      needed_m = std::max(needed_m, *top_m);
    }
    excess_m.push_back(std::max(0.0, needed_m + above_m - base.samples_m()[i]));
  }
  // The two averages together reach 2 half steps and the dilation one more. So all samples of an
  // average are at least the original one, and its result is not below it.
  const int half = calc_half_window(smooth_m, step_m);
  excess_m = dilate(excess_m, 2 * half + 1);
  excess_m = smooth_box(excess_m, half, Beyond::kConstant);
  excess_m = smooth_box(excess_m, half, Beyond::kConstant);
  for (int i = 0; i <= last_of(ground_m); ++i) excess_m[i] += base.samples_m()[i];
  return HeightProfile(step_m, std::move(excess_m));
}

}  // namespace vinerow::controllers
