#pragma once
/// Pictures of point clouds and meshes in 3D, drawn on the CPU: splats and triangles with a depth
/// buffer.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/render/scene.h"
#include "tools/pictures/picture_canvas.h"

namespace vinerow::tools {

/// One perspective view. Everything is drawn at four times the pixels and put together at the end;
/// what is nearer hides what is behind it, in any order of drawing.
class CloudView {
 public:
  /// @param camera  perspective; fov_rad is of the picture's height
  CloudView(const render::Camera& camera, int width, int height);

  /// A disc that faces the camera. @param size_m  across; at least a pixel is drawn
  void splat(const Eigen::Vector3d& p_W, float size_m, const Rgb& colour);
  /// Lit by the sun from the upper left behind the camera, from both sides.
  void triangle(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const Eigen::Vector3d& c_W,
                const Rgb& colour);
  /// A little nearer than it is, so that edges lie on their triangles.
  void line(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, double width_px,
            const Rgb& colour);

  /// What was drawn, with edges where depth jumps, on a plain background. Source of the edges: C.
  /// Boucheny, "Interactive scientific visualization of large datasets: towards a perception-based
  /// approach" (thesis, Grenoble 2009), eye-dome lighting.
  /// @param edges  how dark they are; less where splats are many pixels wide
  render::Image finish(const Rgb& background, float edges = 1.0f) const;

  /// Pixels of the finished picture; nullopt behind the camera.
  std::optional<Eigen::Vector2d> pixel_of(const Eigen::Vector3d& p_W) const;

 private:
  static constexpr int kFine = 2;  ///< pixels drawn for one of the picture, in each direction
  struct Projected {
    float x, y, depth_m;
  };
  bool project(const Eigen::Vector3d& p_W, Projected& out) const;
  void put(int x, int y, float depth_m, const Rgb& colour);

  int width_, height_;  ///< as drawn
  double px_per_rad_;
  Eigen::Matrix3d R_CW_;
  Eigen::Vector3d eye_W_;
  std::vector<float> depth_m_;
  std::vector<std::array<std::uint8_t, 3>> pixels_;
};

/// Camera that looks at a box of points from a direction and has all of them in the picture.
/// @param azimuth_rad    where the camera looks, counter-clockwise from east
/// @param elevation_rad  how far down it looks
/// @param margin         free border as a share of the picture
render::Camera camera_around(const std::vector<Eigen::Vector3d>& points_W, double azimuth_rad,
                             double elevation_rad, double aspect, double margin = 0.04);

}  // namespace vinerow::tools
