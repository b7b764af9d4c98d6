#pragma once
/// The ground as a vehicle's map has it.

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"

namespace vinerow {

/// What planners are told of the ground where the map brings a terrain of its own. Beyond its edge
/// the edge's height goes on for 10 m, as headlands do that a survey has not wholly seen; farther
/// out there is no ground. And a map of the ground has nothing that a ray could hit, or that could
/// be near a box: what stands on it are the map's rows, meshes and grid.
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
