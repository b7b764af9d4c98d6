#pragma once
/// Ground according to a vehicle's map.

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"

namespace vinerow {

/// Scene for planners whose map has its own terrain. For 10 m beyond the terrain's edge the ground
/// has the height of the edge, for headlands that a survey covered only partly. Farther out there
/// is no ground. Rays hit nothing and no box is near anything, because the map's rows, meshes and
/// grid represent the objects on the ground.
class MapGround final : public SceneQuery {
 public:
  /// @param terrain  must outlive this
  explicit MapGround(const HeightField& terrain) : terrain_(terrain) {}

  std::optional<RayHit> cast_ray(const Eigen::Vector3d&, const Eigen::Vector3d&, double,
                                 SurfaceMask) const override {
    return std::nullopt;
  }
  std::optional<double> ground_height_m(double x, double y, double z_from) const override;
  double distance_to_box_m(const Pose&, const Eigen::Vector3d&, double max_distance_m,
                           SurfaceMask) const override {
    return max_distance_m;
  }

 private:
  const HeightField& terrain_;
};

}  // namespace vinerow
