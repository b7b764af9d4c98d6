#include "engine/playback/clear_view.h"

#include <algorithm>
#include <cmath>

#include "engine/api/mesh.h"
#include "engine/math/angles.h"

namespace vinerow::playback {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Limits of a good view: least visible share of the vehicle, largest share of near content.
constexpr double kEnoughSeen = 0.75;
constexpr double kMaxNear = 0.03;
/// Distance from the eye below which content is near: it fills a corner of the picture.
constexpr double kNear_m = 1.3;
/// Numbers of rays across and down the picture that search for near content.
constexpr int kAcross = 16, kDown = 9;
/// Distance before its point at which a ray ends, because the point may touch the ground.
constexpr double kBefore_m = 0.08;

/// Bounding box of points in the picture, in units of the picture's height.
AlignedBox2d seen_box(const render::Camera& camera, const std::vector<Vector3d>& points_W) {
  AlignedBox2d box;
  Vector2d pixel;
  for (const Vector3d& p : points_W) {
    if (render::project(camera, 1, 1, p, pixel)) box.extend(pixel);
  }
  return box;
}

bool is_in_picture(const render::Camera& camera, double aspect, const Vector3d& p_W) {
  Vector2d pixel;
  return render::project(camera, 1, 1, p_W, pixel) && std::abs(pixel.x() - 0.5) < 0.5 * aspect &&
         std::abs(pixel.y() - 0.5) < 0.5;
}

}  // namespace

std::vector<Vector3d> points_of(const std::vector<VehicleLink>& links,
                                const std::vector<Pose>& X_WL) {
  constexpr double kOutwards = 0.7;
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < std::min(links.size(), X_WL.size()); ++i) {
    if (!links[i].mesh || links[i].mesh->vertices.empty()) continue;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3f& v : links[i].mesh->vertices) box.extend(v.cast<double>());
    points.push_back(X_WL[i] * Vector3d(box.center()));
    for (int k = 0; k < 8; ++k) {
      const Vector3d corner = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k));
      points.push_back(X_WL[i] * Vector3d(box.center() + kOutwards * (corner - box.center())));
    }
  }
  return points;
}

ViewQuality judge_view(const render::Camera& camera, double aspect, const Subject& subject,
                       const SceneQuery& scene) {
  ViewQuality quality;
  const Vector3d& eye = camera.X_WC.p;
  int seen = 0;
  for (const Vector3d& p : subject.points_W) {
    const Vector3d line_of_sight = p - eye;
    const double reach_m = line_of_sight.norm() - kBefore_m;
    if (!is_in_picture(camera, aspect, p)) continue;
    if (reach_m <= 0.0 || !scene.cast_ray(eye, line_of_sight.normalized(), reach_m)) ++seen;
  }
  if (!subject.points_W.empty()) quality.seen = double{1} * seen / subject.points_W.size();
  const AlignedBox2d own = seen_box(camera, subject.points_W);
  for (const auto& other : subject.others_W) {
    const AlignedBox2d common = own.intersection(seen_box(camera, other));
    if (common.isEmpty() || !(own.volume() > 0.0)) continue;
    quality.seen *= 1.0 - std::min(1.0, common.volume() / own.volume());
  }
  const double up = std::tan(0.5 * camera.fov_rad);
  int near = 0;
  for (int j = 0; j < kDown; ++j) {
    for (int i = 0; i < kAcross; ++i) {
      const Vector3d direction_C((2.0 * (i + 0.5) / kAcross - 1.0) * up * aspect,
                                 (2.0 * (j + 0.5) / kDown - 1.0) * up, 1.0);
      if (scene.cast_ray(eye, (camera.X_WC.q * direction_C).normalized(), kNear_m)) ++near;
    }
  }
  quality.near = double{1} * near / (kAcross * kDown);
  return quality;
}

std::vector<render::ChaseOptions> chase_candidates(const render::ChaseOptions& requested) {
  // A camera that was requested behind the vehicle moves a little to either side.
  const double side_rad = requested.side_rad;
  constexpr double kSmall_rad = rad_from_deg(1.0);
  const std::vector<double> sides_rad =
      std::abs(side_rad) > kSmall_rad
          ? std::vector{side_rad, 0.5 * side_rad, 0.0, -0.5 * side_rad, -side_rad}
          : std::vector{side_rad, rad_from_deg(12.0), rad_from_deg(-12.0), rad_from_deg(25.0),
                        rad_from_deg(-25.0)};
  constexpr double kRises[] = {0.0, 0.15, 0.3, 0.5, 0.75};  // shares of the distance
  std::vector<render::ChaseOptions> candidates;
  for (std::size_t change = 0; change < sides_rad.size() + std::size(kRises) - 1; ++change) {
    for (std::size_t rise = 0; rise <= change; ++rise) {
      const std::size_t side = change - rise;
      if (rise >= std::size(kRises) || side >= sides_rad.size()) continue;
      candidates.push_back(requested);
      candidates.back().side_rad = sides_rad[side];
      candidates.back().height_m += kRises[rise] * requested.distance_m;
    }
  }
  return candidates;
}

render::Camera find_clear_view(const std::vector<render::Camera>& candidates, double aspect,
                               const Subject& subject, const SceneQuery& scene) {
  const render::Camera* best = &candidates.front();
  double best_score = -1e9;
  for (const render::Camera& camera : candidates) {
    const ViewQuality quality = judge_view(camera, aspect, subject, scene);
    if (quality.seen >= kEnoughSeen && quality.near <= kMaxNear) return camera;
    const double score = quality.seen - 2.0 * quality.near;
    if (score > best_score) best_score = score, best = &camera;
  }
  return *best;
}

}  // namespace vinerow::playback
