#include "engine/metrics/coverage_lanes.h"

#include <algorithm>
#include <map>

namespace vinerow::metrics {
namespace {

using Eigen::Vector2d;

struct Picture {
  const PictureFootprint* footprint = nullptr;
  double along_m = 0.0;
};

struct Lane {
  std::vector<Picture> pictures;  ///< sorted by position along the lanes
  double across_m = 0.0;          ///< mean
};

Vector2d middle_of_footprint(const PictureFootprint& footprint) {
  Vector2d sum = Vector2d::Zero();
  for (const Vector2d& corner : footprint.polygon_W) sum += corner;
  return sum / static_cast<double>(footprint.polygon_W.size());
}

/// Unit direction of the lanes: from the first to the last picture of the longest lane.
Vector2d direction_of(const std::map<int, std::vector<const PictureFootprint*>>& by_lane) {
  Vector2d longest = Vector2d::Zero();
  for (const auto& [lane, footprints] : by_lane) {
    const Vector2d displacement =
        middle_of_footprint(*footprints.back()) - middle_of_footprint(*footprints.front());
    if (displacement.norm() > longest.norm()) longest = displacement;
  }
  return longest.norm() > 0.0 ? Vector2d(longest.normalized()) : Vector2d::Zero();
}

void add_overlaps(const Lane& from, const Lane& to, std::vector<double>& overlaps) {
  for (const Picture& picture : from.pictures) {
    if (!picture.footprint->touches_parcel) continue;
    const auto after = std::lower_bound(
        to.pictures.begin(), to.pictures.end(), picture.along_m,
        [](const Picture& other, double along_m) { return other.along_m < along_m; });
    if (after == to.pictures.end()) continue;
    const bool abreast = after->along_m == picture.along_m;
    if (after == to.pictures.begin() && !abreast) continue;
    Polygon strip = after->footprint->polygon_W;
    if (!abreast) {
      const Polygon& before = (after - 1)->footprint->polygon_W;
      strip.insert(strip.end(), before.begin(), before.end());
      strip = convex_hull(std::move(strip));
    }
    overlaps.push_back(signed_area_m2(clip(picture.footprint->polygon_W, strip)) /
                       picture.footprint->area_m2);
  }
}

}  // namespace

std::vector<double> side_overlaps(const std::vector<PictureFootprint>& footprints) {
  std::map<int, std::vector<const PictureFootprint*>> by_lane;
  for (const PictureFootprint& footprint : footprints) {
    if (footprint.lane >= 0) by_lane[footprint.lane].push_back(&footprint);
  }
  const Vector2d along = direction_of(by_lane);
  if (by_lane.size() < 2 || along.isZero()) return {};

  std::vector<Lane> lanes;
  for (const auto& [number, members] : by_lane) {
    Lane lane;
    for (const PictureFootprint* footprint : members) {
      const Vector2d middle = middle_of_footprint(*footprint);
      lane.pictures.push_back({footprint, along.dot(middle)});
      lane.across_m += Vector2d(-along.y(), along.x()).dot(middle);
    }
    lane.across_m /= static_cast<double>(members.size());
    std::stable_sort(lane.pictures.begin(), lane.pictures.end(),
                     [](const Picture& a, const Picture& b) { return a.along_m < b.along_m; });
    lanes.push_back(std::move(lane));
  }
  std::stable_sort(lanes.begin(), lanes.end(),
                   [](const Lane& a, const Lane& b) { return a.across_m < b.across_m; });
  std::vector<double> overlaps;
  for (std::size_t i = 0; i + 1 < lanes.size(); ++i) {
    add_overlaps(lanes[i], lanes[i + 1], overlaps);
    add_overlaps(lanes[i + 1], lanes[i], overlaps);
  }
  return overlaps;
}

}  // namespace vinerow::metrics
