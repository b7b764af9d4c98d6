#pragma once
/// Projection of the world to a top view.

#include <Eigen/Core>
#include <vector>

namespace vinerow::tools {

/// World to pixels: north up, a margin around the content, a strip below for the legend.
struct PlanView {
  Eigen::Vector2d corner_W;  ///< lower left corner inside the margin
  double px_per_m;
  int margin, map_height, height;  ///< px; height of the map with margin, and with the strip

  /// @param corner_W, size_m  box to show, as large as it fits  @param tallest  maximum height of
  /// the map with its margin, px  @param strip  height of the strip below the map, px
  PlanView(const Eigen::Vector2d& corner_W, const Eigen::Vector2d& size_m, int margin, int tallest,
           int strip);

  /// Position in pixels.
  Eigen::Vector2d operator()(const Eigen::Vector2d& p_W) const {
    return {margin + (p_W.x() - corner_W.x()) * px_per_m,
            map_height - margin - (p_W.y() - corner_W.y()) * px_per_m};
  }
  Eigen::Vector2d operator()(const Eigen::Vector3d& p_W) const {
    return (*this)(Eigen::Vector2d(p_W.head<2>()));
  }
  std::vector<Eigen::Vector2d> operator()(const std::vector<Eigen::Vector2d>& polygon_W) const;

  /// World position of a pixel.
  Eigen::Vector2d world(double x, double y) const {
    return corner_W + Eigen::Vector2d(x - margin, map_height - margin - y) / px_per_m;
  }
};

}  // namespace vinerow::tools
