#pragma once
/// A scene of plain shapes with closed forms: walls, panels and round posts, of any surface.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "engine/api/scene_query.h"

namespace vinerow::test {

/// A rectangle in the plane through `middle_W`; endless without half lengths.
struct Panel {
  Eigen::Vector3d middle_W;
  Eigen::Vector3d normal_W;  ///< unit, horizontal
  SurfaceClass surface = SurfaceClass::kCanopy;
  double half_width_m = std::numeric_limits<double>::infinity();
  double half_height_m = std::numeric_limits<double>::infinity();
};

/// A vertical cylinder without ends.
struct RoundPost {
  Eigen::Vector2d axis_W;
  double radius_m;
  SurfaceClass surface = SurfaceClass::kPost;
};

class ShapeScene final : public SceneQuery {
 public:
  std::vector<Panel> panels;
  std::vector<RoundPost> posts;

  std::optional<RayHit> cast_ray(const Eigen::Vector3d& p, const Eigen::Vector3d& dir,
                                 double max_distance_m, SurfaceMask mask) const override {
    std::optional<RayHit> nearest;
    const auto consider = [&](double distance, SurfaceClass surface, Eigen::Vector3d normal) {
      if (!(distance >= 0.0) || distance > max_distance_m || !(mask & mask_of(surface))) return;
      if (nearest && distance >= nearest->distance_m) return;
      if (normal.dot(dir) > 0.0) normal = -normal;
      nearest = RayHit{distance, normal, surface, -1};
    };
    for (const Panel& panel : panels) {
      const double closing = -panel.normal_W.dot(dir);
      if (std::abs(closing) < 1e-12) continue;
      const double distance = panel.normal_W.dot(p - panel.middle_W) / closing;
      const Eigen::Vector3d off = p + distance * dir - panel.middle_W;
      const Eigen::Vector3d along(-panel.normal_W.y(), panel.normal_W.x(), 0.0);
      if (std::abs(off.dot(along)) > panel.half_width_m) continue;
      if (std::abs(off.z()) > panel.half_height_m) continue;
      consider(distance, panel.surface, panel.normal_W);
    }
    for (const RoundPost& post : posts) {
      const Eigen::Vector2d from = p.head<2>() - post.axis_W, way = dir.head<2>();
      const double a = way.squaredNorm(), b = from.dot(way);
      const double root = b * b - a * (from.squaredNorm() - post.radius_m * post.radius_m);
      if (root < 0.0 || a < 1e-12) continue;
      const double distance = (-b - std::sqrt(root)) / a;
      const Eigen::Vector2d normal = (from + distance * way) / post.radius_m;
      consider(distance, post.surface, {normal.x(), normal.y(), 0.0});
    }
    return nearest;
  }
  std::optional<double> ground_height_m(double, double, double) const override { return 0.0; }
  double distance_to_box_m(const Pose&, const Eigen::Vector3d&, double max_distance_m,
                           SurfaceMask) const override {
    return max_distance_m;
  }
};

}  // namespace vinerow::test
