#include "engine/render/culling.h"

#include <algorithm>
#include <cmath>

namespace vinerow::render {

Frustum::Frustum(const Eigen::Matrix4d& clip_from_world) {
  for (int axis = 0; axis < 3; ++axis) {
    planes_[2 * axis] = clip_from_world.row(3) + clip_from_world.row(axis);
    planes_[2 * axis + 1] = clip_from_world.row(3) - clip_from_world.row(axis);
  }
}

bool Frustum::may_see(const Eigen::AlignedBox3d& box_W) const {
  if (box_W.isEmpty()) return false;
  for (const Eigen::Vector4d& plane : planes_) {
    // The corner that is farthest along the plane's normal.
    Eigen::Vector3d corner;
    for (int i = 0; i < 3; ++i) corner[i] = plane[i] > 0.0 ? box_W.max()[i] : box_W.min()[i];
    if (plane.head<3>().dot(corner) + plane[3] < 0.0) return false;
  }
  return true;
}

Eigen::Matrix4d calc_clip_from_world(const Camera& camera, double aspect, double near_m,
                                     double far_m) {
  const Pose X_CW = camera.X_WC.inverse();
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.topLeftCorner<3, 3>() = X_CW.q.toRotationMatrix();
  view.topRightCorner<3, 1>() = X_CW.p;
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  if (camera.orthographic) {
    const double half = 0.5 * camera.ortho_height_m;
    projection(0, 0) = 1.0 / (half * aspect);
    projection(1, 1) = -1.0 / half;
    projection(2, 2) = 2.0 / (far_m - near_m);
    projection(2, 3) = -(far_m + near_m) / (far_m - near_m);
    projection(3, 3) = 1.0;
  } else {
    const double scale = 1.0 / std::tan(0.5 * camera.fov_rad);
    projection(0, 0) = scale / aspect;
    projection(1, 1) = -scale;
    projection(2, 2) = (far_m + near_m) / (far_m - near_m);
    projection(2, 3) = -2.0 * far_m * near_m / (far_m - near_m);
    projection(3, 2) = 1.0;
  }
  return projection * view;
}

Eigen::AlignedBox3d transform_box(const Pose& X_WM, const Eigen::AlignedBox3d& box_M) {
  Eigen::AlignedBox3d box_W;
  if (box_M.isEmpty()) return box_W;
  for (int i = 0; i < 8; ++i) {
    box_W.extend(X_WM * box_M.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
  return box_W;
}

LodName split_lod_name(const std::string& name) {
  const std::size_t place = name.rfind("#lod");
  if (place == std::string::npos || place + 5 != name.size()) return {name, -1};
  const char digit = name.back();
  if (digit < '0' || digit > '9') return {name, -1};
  return {name.substr(0, place), digit - '0'};
}

double calc_seen_distance(const Camera& camera, int height_px, const Eigen::AlignedBox3d& box_W) {
  const double reference = 2.0 * std::tan(0.48) / 720.0;  // m per pixel and m of distance
  if (camera.orthographic) return camera.ortho_height_m / height_px / reference;
  const double distance = std::sqrt(box_W.squaredExteriorDistance(camera.X_WC.p));
  return distance * 2.0 * std::tan(0.5 * camera.fov_rad) / height_px / reference;
}

int pick_lod(double seen_distance_m, int count) {
  constexpr double kFirst = 10.0;
  constexpr double kSecond = 34.0;
  const int wanted = seen_distance_m < kFirst ? 0 : seen_distance_m < kSecond ? 1 : 2;
  return std::min(wanted, count - 1);
}

bool is_drawn_at(SurfaceClass surface, double seen_distance_m) {
  switch (surface) {
    case SurfaceClass::kWire:
      return seen_distance_m < 18.0;
    case SurfaceClass::kTrunk:
      return seen_distance_m < 60.0;
    case SurfaceClass::kPost:
      return seen_distance_m < 160.0;
    default:
      return true;
  }
}

}  // namespace vinerow::render
