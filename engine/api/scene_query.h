#pragma once
/// Geometry queries on the world: rays, distances, ground. Used by sensors, metrics and wheels.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/api/forward.h"
#include "engine/api/surface.h"
#include "engine/math/pose.h"

namespace vinerow {

/// Bit set of surface classes.
using SurfaceMask = std::uint32_t;
constexpr SurfaceMask mask_of(SurfaceClass surface) {
  return 1u << static_cast<int>(surface);
}
constexpr SurfaceMask kGroundMask =
    mask_of(SurfaceClass::kTerrain) | mask_of(SurfaceClass::kObstacle);
constexpr SurfaceMask kPlantMask =
    mask_of(SurfaceClass::kCanopy) | mask_of(SurfaceClass::kPost) | mask_of(SurfaceClass::kTrunk);
constexpr SurfaceMask kAllSurfaces = 0xffffffffu;

struct RayHit {
  double distance_m = 0.0;
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< unit, towards the ray's origin
  SurfaceClass surface = SurfaceClass::kTerrain;
  int mesh = -1;      ///< index into WorldModel::meshes, -1 for the height field
  int triangle = -1;  ///< of the mesh, -1 for the height field
};

/// A ray of cast_rays().
struct SceneRay {
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d dir_W = Eigen::Vector3d::UnitX();  ///< unit
  double max_distance_m = 0.0;
};

/// Surfaces that rays meet.
class RayScene {
 public:
  virtual ~RayScene() = default;

  /// First hit along a ray. Ignores vehicles. @param dir_W unit. No heap, thread safe.
  virtual std::optional<RayHit> cast_ray(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                                         double max_distance_m,
                                         SurfaceMask mask = kAllSurfaces) const = 0;

  /// First hits of many rays: what cast_ray() returns for each of them, in less time if neighbours
  /// lie close together. No heap, thread safe. @param hits  as many as rays
  virtual void cast_rays(std::span<const SceneRay> rays, std::span<std::optional<RayHit>> hits,
                         SurfaceMask mask = kAllSurfaces) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      hits[i] = cast_ray(rays[i].p_W, rays[i].dir_W, rays[i].max_distance_m, mask);
    }
  }

  /// Whether rays meet anything: whether cast_ray() would return a hit, in less time. No heap,
  /// thread safe. @param blocked  as many as rays; true: the ray meets something
  virtual void find_blocked(std::span<const SceneRay> rays, std::span<bool> blocked,
                            SurfaceMask mask = kAllSurfaces) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      blocked[i] = cast_ray(rays[i].p_W, rays[i].dir_W, rays[i].max_distance_m, mask).has_value();
    }
  }
};

/// Rays on the vehicles of a run, link by link. RayHit::mesh is an index into links().
class VehicleScene : public RayScene {
 public:
  /// Moves the links to where they are now. Call it before the rays of an instant.
  virtual void update() = 0;
  /// Links of all vehicles, in the order of the vehicles.
  virtual std::span<const MeshInstance> links() const = 0;
  /// Number of the link's vehicle, in the order of the scenario file.
  virtual int vehicle_of(int link) const = 0;
};

/// Rays on closed hulls of plants, without wires; distances and ground.
class SceneQuery : public RayScene {
 public:
  /// Height of the highest ground at (x, y) at or below z_from. @returns nullopt if there is no
  /// ground
  virtual std::optional<double> ground_height_m(double x, double y, double z_from) const = 0;

  /// True distance from a box to the nearest mesh triangle of the masked classes; 0 if they
  /// overlap.
  /// @param half_extents_m  of the box, axes of X_WBox
  /// @param max_distance_m  search radius; farther triangles are ignored
  /// @returns distance, or max_distance_m if nothing is nearer
  virtual double distance_to_box_m(const Pose& X_WBox, const Eigen::Vector3d& half_extents_m,
                                   double max_distance_m, SurfaceMask mask = kPlantMask) const = 0;
};

}  // namespace vinerow
