#pragma once
/// The scene of all tests without a world: ground in closed form, boxes, panels and round posts.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/api/scene_query.h"

namespace vinerow::test {

/// z = z_m + rise_x x + rise_y y
struct GroundPlane {
  double rise_x = 0.0, rise_y = 0.0, z_m = 0.0;
  double at(double x, double y) const { return z_m + (rise_x * x + rise_y * y); }
};

/// A closed box with its axes along W; a ray meets both faces.
struct Box {
  Eigen::Vector3d low, high;
  SurfaceClass surface = SurfaceClass::kCanopy;
};

/// A rectangle in the plane through `middle_W`; without half lengths it is infinite.
struct Panel {
  Eigen::Vector3d middle_W;
  Eigen::Vector3d normal_W;  ///< unit, not vertical
  SurfaceClass surface = SurfaceClass::kCanopy;
  double half_width_m = std::numeric_limits<double>::infinity();   ///< horizontal
  double half_height_m = std::numeric_limits<double>::infinity();  ///< across it
};

/// A vertical cylinder without ends.
struct RoundPost {
  Eigen::Vector2d axis_W;
  double radius_m;
  SurfaceClass surface = SurfaceClass::kPost;
};

/// Rays meet boxes, panels, posts, and a ground that is a plane, but not a ground given as a
/// function. No distances to boxes of the caller: distance_to_box_m() finds nothing.
class PlainScene final : public SceneQuery {
 public:
  /// Ground height, m; nullopt if there is no ground
  using Height = std::function<std::optional<double>(double x, double y)>;

  /// Level ground at z = 0 that rays do not meet.
  PlainScene() = default;
  explicit PlainScene(GroundPlane ground) : plane(ground) {}
  explicit PlainScene(Height ground) : height(std::move(ground)) {}

  std::optional<GroundPlane> plane;
  Height height = [](double, double) { return 0.0; };  ///< if there is no plane
  std::vector<Box> boxes;
  std::vector<Panel> panels;
  std::vector<RoundPost> posts;

  /// An infinite wall of canopy at this x, across the x axis.
  void add_wall(double x_m) { panels.push_back({{x_m, 0, 0}, {-1, 0, 0}}); }
  /// @pre there is ground
  double ground_m(const Eigen::Vector2d& p) const { return *ground(p.x(), p.y()); }

  std::optional<RayHit> cast_ray(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                                 double max_distance_m, SurfaceMask mask) const override {
    std::optional<RayHit> nearest;
    const auto consider = [&](double distance_m, SurfaceClass surface, Eigen::Vector3d normal_W) {
      if (!(distance_m >= 0.0) || distance_m > max_distance_m || !(mask & mask_of(surface))) return;
      if (nearest && distance_m >= nearest->distance_m) return;
      if (normal_W.dot(dir_W) > 0.0) normal_W = -normal_W;
      nearest = RayHit{distance_m, normal_W, surface, -1};
    };
    if (plane) {
      const double closing = plane->rise_x * dir_W.x() + plane->rise_y * dir_W.y() - dir_W.z();
      if (closing > 0.0) {
        consider((p_W.z() - plane->at(p_W.x(), p_W.y())) / closing, SurfaceClass::kTerrain,
                 Eigen::Vector3d(-plane->rise_x, -plane->rise_y, 1.0).normalized());
      }
    }
    for (const Box& box : boxes) {
      double in = -std::numeric_limits<double>::infinity(), out = -in;
      int in_axis = 0, out_axis = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.low[axis] - p_W[axis]) / dir_W[axis];
        const double b = (box.high[axis] - p_W[axis]) / dir_W[axis];
        if (std::min(a, b) > in) in = std::min(a, b), in_axis = axis;
        if (std::max(a, b) < out) out = std::max(a, b), out_axis = axis;
      }
      if (in > out) continue;
      consider(in, box.surface, Eigen::Vector3d::Unit(in_axis));
      consider(out, box.surface, Eigen::Vector3d::Unit(out_axis));
    }
    for (const Panel& panel : panels) {
      const Eigen::Vector3d& n = panel.normal_W;
      const double closing = -n.dot(dir_W);
      if (std::abs(closing) < 1e-12) continue;
      const double distance_m = n.dot(p_W - panel.middle_W) / closing;
      const Eigen::Vector3d off = p_W + distance_m * dir_W - panel.middle_W;
      const Eigen::Vector3d along = Eigen::Vector3d(-n.y(), n.x(), 0.0).normalized();
      if (std::abs(off.dot(along)) > panel.half_width_m) continue;
      if (std::abs(off.dot(n.cross(along))) > panel.half_height_m) continue;
      consider(distance_m, panel.surface, n);
    }
    for (const RoundPost& post : posts) {
      const Eigen::Vector2d from = p_W.head<2>() - post.axis_W, to = dir_W.head<2>();
      const double a = to.squaredNorm(), b = from.dot(to);
      const double root = b * b - a * (from.squaredNorm() - post.radius_m * post.radius_m);
      if (root < 0.0 || a < 1e-12) continue;
      const double distance_m = (-b - std::sqrt(root)) / a;
      const Eigen::Vector2d normal = (from + distance_m * to) / post.radius_m;
      consider(distance_m, post.surface, {normal.x(), normal.y(), 0.0});
    }
    return nearest;
  }

  std::optional<double> ground_height_m(double x, double y, double z_from) const override {
    const std::optional<double> z = ground(x, y);
    return z && *z <= z_from ? z : std::nullopt;
  }

  double distance_to_box_m(const Pose&, const Eigen::Vector3d&, double max_distance_m,
                           SurfaceMask) const override {
    return max_distance_m;
  }

 private:
  std::optional<double> ground(double x, double y) const {
    return plane ? plane->at(x, y) : height(x, y);
  }
};

}  // namespace vinerow::test
