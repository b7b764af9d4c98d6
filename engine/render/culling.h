#pragma once
/// What need not be drawn: outside the view, or too small to matter.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>

#include "engine/render/scene.h"

namespace vinerow::render {

/// The six half-spaces of a view. Source: G. Gribb, K. Hartmann, "Fast extraction of viewing
/// frustum planes from the world-view-projection matrix", 2001.
class Frustum {
 public:
  explicit Frustum(const Eigen::Matrix4d& clip_from_world);
  /// False only if the whole box is on the outer side of one plane: never for a visible box.
  bool may_see(const Eigen::AlignedBox3d& box_W) const;

 private:
  std::array<Eigen::Vector4d, 6> planes_;
};

/// Clip space of OpenGL from W. @param aspect width / height
Eigen::Matrix4d calc_clip_from_world(const Camera& camera, double aspect, double near_m,
                                     double far_m);

/// Box around a turned box.
Eigen::AlignedBox3d transform_box(const Pose& X_WM, const Eigen::AlignedBox3d& box_M);

/// "row_3/chunk_7#lod1" -> {"row_3/chunk_7", 1}; without a suffix the level is -1.
struct LodName {
  std::string base;
  int level = -1;
};
LodName split_lod_name(const std::string& name);

/// Distance at which a thing looks as large in a picture of 720 rows and 0.96 rad as it does in
/// this one: what levels of detail are chosen by.
double calc_seen_distance(const Camera& camera, int height_px, const Eigen::AlignedBox3d& box_W);

/// Index among `count` alternatives, 0 = finest.
int pick_lod(double seen_distance_m, int count);

/// Thin things are left out where they would be thinner than about a pixel.
bool is_drawn_at(SurfaceClass surface, double seen_distance_m);

}  // namespace vinerow::render
