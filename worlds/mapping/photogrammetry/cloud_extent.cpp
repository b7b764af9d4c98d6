#include "worlds/mapping/photogrammetry/cloud_extent.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/error.h"

namespace vinerow::mapping {

SurveyArea::SurveyArea(Polygon polygon_W, double margin_m)
    : polygon_(std::move(polygon_W)), margin_m_(margin_m) {
  if (polygon_.size() < 3) {
    throw ConfigError(
        fmt::format("the cloud's area has {} corners, must have at least three", polygon_.size()));
  }
  for (const Eigen::Vector2d& p : polygon_) {
    if (!p.allFinite()) throw ConfigError("the cloud's area has a corner that is not finite");
  }
  if (const auto crossing = find_crossing(polygon_)) {
    throw ConfigError(fmt::format(
        "the cloud's area crosses itself: the edges from corners {} and {} meet, corners must be "
        "in order around it",
        crossing->first, crossing->second));
  }
  if (!(std::abs(signed_area_m2(polygon_)) > 0.0)) {
    throw ConfigError("the cloud's area has no square metre: its corners lie on one line");
  }
  if (!(margin_m >= 0.0) || !std::isfinite(margin_m)) {
    throw ConfigError(
        fmt::format("the margin around the cloud's area is {} m, must be 0 m or more", margin_m));
  }
}

bool SurveyArea::contains(const Eigen::Vector2d& p_W, double further_m) const {
  const double margin_m = margin_m_ + further_m;
  return vinerow::contains(polygon_, p_W) ||
         (margin_m > 0.0 && distance_m(polygon_, p_W) <= margin_m);
}

Eigen::AlignedBox2d SurveyArea::box_W() const {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : polygon_) box.extend(p);
  const Eigen::Vector2d margin(margin_m_, margin_m_);
  return {Eigen::Vector2d(box.min() - margin), Eigen::Vector2d(box.max() + margin)};
}

}  // namespace vinerow::mapping
