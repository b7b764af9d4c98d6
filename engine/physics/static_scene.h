#pragma once
/// Constant data that physics derives from a world: ray scene, trees, collision shapes, and the
/// possible normals of its surfaces.
///
/// Building it is most of the work of making a PhysicsWorld; trees of meshes are built when a ray,
/// a distance or a contact first needs them. Any number of physics worlds can use one scene, one
/// after the other or at the same time on several threads.

#include <atomic>
#include <memory>
#include <mutex>

#include "engine/api/world_model.h"
#include "engine/physics/contact_normals.h"
#include "engine/physics/world_scene.h"

namespace vinerow::physics {

class StaticGeometry;

class StaticScene {
 public:
  /// @param world  not null; heights and meshes are read in place
  /// @throws ConfigError on bad geometry, e.g. "mesh 'x' has no triangles"
  explicit StaticScene(std::shared_ptr<const WorldModel> world);
  ~StaticScene();

  const WorldModel& world() const { return *world_; }
  /// Rays and distances.
  const WorldScene& queries() const { return queries_; }
  /// Builds now what would be built later, for runs that a clock paces; that of light only if
  /// something has asked for it. Thread safe.
  void prepare() const;
  /// Surfaces as light meets them. Built at the first call; thread safe.
  const RayScene& light() const;
  const ContactNormals& normals() const { return normals_; }
  const StaticGeometry& geometry() const { return *geometry_; }

 private:
  std::shared_ptr<const WorldModel> world_;
  WorldScene queries_;
  ContactNormals normals_;
  std::unique_ptr<const StaticGeometry> geometry_;
  mutable std::once_flag light_once_;
  mutable std::unique_ptr<const SurfaceRays> light_;
  mutable std::atomic<bool> has_light_ = false;
};

}  // namespace vinerow::physics
