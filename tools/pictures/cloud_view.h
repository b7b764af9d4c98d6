#pragma once
/// Software renderer for pictures of point clouds and meshes: splats and triangles with a depth
/// buffer.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/render/scene.h"
#include "tools/pictures/picture_canvas.h"

namespace vinerow::tools {

/// Perspective view. It is drawn with four times the pixels and averaged at the end. Nearer objects
/// hide those behind them, in any order of drawing.
class CloudView {
 public:
  /// @param camera  perspective; fov_rad is the vertical field of view
  CloudView(const render::Camera& camera, int width, int height);

  /// Draws a disc that faces the camera. @param size_m  diameter; at least one pixel is drawn
  void splat(const Eigen::Vector3d& p_W, float size_m, const Rgb& colour);
  /// Draws a triangle, lit on both sides by a sun from the upper left behind the camera.
  void triangle(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const Eigen::Vector3d& c_W,
                const Rgb& colour);
  /// Draws a line, moved slightly towards the camera, so that edges are on top of their triangles.
  void line(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, double width_px,
            const Rgb& colour);

  /// Finished picture on a plain background, with dark edges at depth steps. Source of the edges:
  /// C. Boucheny, "Interactive scientific visualization of large datasets: towards a
  /// perception-based approach" (thesis, Grenoble 2009), eye-dome lighting.
  /// @param edges  darkness of the edges; use less if splats are many pixels wide
  render::Image finish(const Rgb& background, float edges = 1.0f) const;

  /// Position in the finished picture, px; nullopt behind the camera.
  std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& p_W) const;

 private:
  static constexpr int kFine = 2;  ///< drawn pixels per pixel of the picture, in each direction
  struct Projected {
    float x, y, depth_m;
  };
  bool project(const Eigen::Vector3d& p_W, Projected& out) const;
  void put(int x, int y, float depth_m, const Rgb& colour);

  int width_, height_;  ///< drawn pixels
  double px_per_rad_;
  Eigen::Matrix3d R_CW_;
  Eigen::Vector3d eye_W_;
  std::vector<float> depth_m_;
  std::vector<std::array<std::uint8_t, 3>> pixels_;
};

/// Camera that looks at points from a direction, with all of them in the picture.
/// @param azimuth_rad    viewing direction, counter-clockwise from east
/// @param elevation_rad  downward angle of the viewing direction
/// @param margin         free border as a share of the picture
render::Camera camera_around(const std::vector<Eigen::Vector3d>& points_W, double azimuth_rad,
                             double elevation_rad, double aspect, double margin = 0.04);

}  // namespace vinerow::tools
