#include "tools/pictures/plan_view.h"

#include <algorithm>
#include <cmath>

#include "tools/pictures/picture_style.h"

namespace vinerow::tools {

using Eigen::Vector2d;

PlanView::PlanView(const Vector2d& corner, const Vector2d& size_m, int margin_px, int tallest,
                   int strip)
    : PlanProjection{corner, 1.0, static_cast<double>(margin_px), 0.0}, margin(margin_px) {
  const double width_px = kPictureWidth - 2.0 * margin;
  px_per_m = std::min(width_px / size_m.x(), (tallest - 2.0 * margin) / size_m.y());
  map_height = static_cast<int>(std::ceil(size_m.y() * px_per_m)) + 2 * margin;
  height = map_height + strip;
  bottom = map_height - margin;
  // Centre a map that is narrower than the picture.
  corner_W.x() -= 0.5 * (width_px / px_per_m - size_m.x());
}

std::vector<Vector2d> PlanProjection::operator()(const std::vector<Vector2d>& polygon_W) const {
  std::vector<Vector2d> polygon;
  for (const Vector2d& p : polygon_W) polygon.push_back((*this)(p));
  return polygon;
}

}  // namespace vinerow::tools
