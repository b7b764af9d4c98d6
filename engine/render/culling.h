#pragma once
/// Culling of objects outside the view or too small, and levels of detail.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>

#include "engine/render/scene.h"

namespace vinerow::render {

/// View frustum as six half-spaces. Source: G. Gribb, K. Hartmann, "Fast extraction of viewing
/// frustum planes from the world-view-projection matrix", 2001.
class Frustum {
 public:
  explicit Frustum(const Eigen::Matrix4d& clip_from_world);
  /// False only if the whole box is on the outer side of one plane; always true for a visible box.
  bool may_see(const Eigen::AlignedBox3d& box_W) const;

 private:
  std::array<Eigen::Vector4d, 6> planes_;
};

/// OpenGL clip space from W. @param aspect  width / height
Eigen::Matrix4d calc_clip_from_world(const Camera& camera, double aspect, double near_m,
                                     double far_m);

/// Axis-aligned box around a transformed box.
Eigen::AlignedBox3d transform_box(const Pose& X_WM, const Eigen::AlignedBox3d& box_M);

/// Mesh name and level of detail: "row_3/chunk_7#lod1" -> {"row_3/chunk_7", 1}; without a suffix
/// the level is -1.
struct LodName {
  std::string base;
  int level = -1;
};
LodName split_lod_name(const std::string& name);

/// Equivalent distance for levels of detail: the distance at which an object would have the same
/// size in a picture of 720 pixel rows and 0.96 rad as in this one.
double calc_seen_distance(const Camera& camera, int height_px, const Eigen::AlignedBox3d& box_W);

/// Level of detail among `count`, 0 = finest.
int pick_lod(double seen_distance_m, int count);

/// False for thin objects that would be thinner than about one pixel.
bool is_drawn_at(SurfaceClass surface, double seen_distance_m);

}  // namespace vinerow::render
