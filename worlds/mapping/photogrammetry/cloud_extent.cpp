#include "worlds/mapping/photogrammetry/cloud_extent.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.h"
#include "engine/math/polyline.h"

namespace vinerow::mapping {

SurveyArea::SurveyArea(Polygon polygon_W, double margin_m)
    : polygon_(std::move(polygon_W)), margin_m_(margin_m) {
  if (polygon_.size() < 3) {
    throw ConfigError(fmt::format("area_m has {} corner{}, must have at least three",
                                  polygon_.size(), polygon_.size() == 1 ? "" : "s"));
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

double SurveyArea::inside_m(const Eigen::Vector2d& p_W) const {
  if (!vinerow::contains(polygon_, p_W)) return 0.0;
  constexpr double kRounding_m = 1e-6;
  double inside_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    const Eigen::Vector2d &a = polygon_[i], &b = polygon_[(i + 1) % polygon_.size()];
    inside_m = std::min(inside_m, distance_to_segment_m<2>(p_W, a, b));
  }
  return std::max(0.0, inside_m - kRounding_m);
}

Eigen::AlignedBox2d SurveyArea::box_W() const {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : polygon_) box.extend(p);
  const Eigen::Vector2d margin(margin_m_, margin_m_);
  return {Eigen::Vector2d(box.min() - margin), Eigen::Vector2d(box.max() + margin)};
}

}  // namespace vinerow::mapping
