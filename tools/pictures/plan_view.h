#pragma once
/// Projection of the world to a top view.

#include <Eigen/Core>
#include <vector>

namespace vinerow::tools {

/// World to pixels, north up.
struct PlanProjection {
  Eigen::Vector2d corner_W = {0, 0};  ///< world position of `left`, `bottom`
  double px_per_m = 1.0, left = 0.0, bottom = 0.0;

  /// Position in pixels.
  Eigen::Vector2d operator()(const Eigen::Vector2d& p_W) const {
    return {left + (p_W.x() - corner_W.x()) * px_per_m,
            bottom - (p_W.y() - corner_W.y()) * px_per_m};
  }
  Eigen::Vector2d operator()(const Eigen::Vector3d& p_W) const {
    return (*this)(Eigen::Vector2d(p_W.head<2>()));
  }
  std::vector<Eigen::Vector2d> operator()(const std::vector<Eigen::Vector2d>& polygon_W) const;

  /// World position of a pixel.
  Eigen::Vector2d world(double x, double y) const {
    return corner_W + Eigen::Vector2d(x - left, bottom - y) / px_per_m;
  }
};

/// Such a projection with a margin around the content and a strip below for the legend.
struct PlanView : PlanProjection {
  int margin, map_height, height;  ///< px; height of the map with margin, and with the strip

  /// @param corner_W, size_m  box to show, as large as it fits  @param tallest  maximum height of
  /// the map with its margin, px  @param strip  height of the strip below the map, px
  PlanView(const Eigen::Vector2d& corner_W, const Eigen::Vector2d& size_m, int margin, int tallest,
           int strip);
};

}  // namespace vinerow::tools
