#pragma once
/// Trees of boxes over the triangles of meshes, each built when a search first needs it.

#include <deque>
#include <map>

#include "engine/api/mesh.h"
#include "engine/math/box_tree.h"
#include "engine/physics/lazy.h"

namespace vinerow::physics {

/// Distances and the first rays of a world share it. Meshes outlive it.
class MeshTrees {
 public:
  using Tree = BoxTree<float, 3>;

  /// Tree of a mesh, the same at every call. Not thread safe, but the tree is.
  const Lazy<Tree>& of(const TriangleMesh& mesh);
  /// Builds the trees of all meshes so far.
  void prepare() const;

 private:
  std::map<const TriangleMesh*, const Lazy<Tree>*> known_;
  std::deque<Lazy<Tree>> trees_;
};

}  // namespace vinerow::physics
