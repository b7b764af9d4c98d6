#pragma once
/// Exact distance from an oriented box to the triangles of a world.

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "engine/api/forward.h"
#include "engine/api/scene_query.h"
#include "engine/physics/mesh_trees.h"

namespace vinerow::physics {

/// Tree over the instances, and one tree per mesh, shared by its instances and built when a search
/// first comes near one of them. Triangles and vertices are read in place from the WorldModel; the
/// search is exact, in double precision.
class MeshDistance {
 public:
  using Tree = MeshTrees::Tree;

  /// @param world  checked; outlives this object
  /// @param trees  not null
  explicit MeshDistance(const WorldModel& world,
                        std::shared_ptr<MeshTrees> trees = std::make_shared<MeshTrees>());

  /// SceneQuery::distance_to_box_m.
  double to_box_m(const Pose& X_WBox, const Eigen::Vector3d& half_extents_m, double max_distance_m,
                  SurfaceMask mask) const;

 private:
  struct Entry {
    const MeshInstance* instance;
    const Lazy<Tree>* tree;
  };
  const WorldModel& world_;
  std::shared_ptr<MeshTrees> trees_;
  std::vector<Entry> entries_;
  Tree instances_;
};

}  // namespace vinerow::physics
