#include "engine/physics/mesh_trees.h"

#include <vector>

namespace vinerow::physics {
namespace {

MeshTrees::Tree make_tree(const TriangleMesh& mesh) {
  std::vector<Eigen::AlignedBox3f> boxes;
  boxes.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    Eigen::AlignedBox3f box;
    for (const std::uint32_t v : triangle) box.extend(mesh.vertices[v]);
    boxes.push_back(box);
  }
  return MeshTrees::Tree(boxes);
}

}  // namespace

const Lazy<MeshTrees::Tree>& MeshTrees::of(const TriangleMesh& mesh) {
  const Lazy<Tree>*& tree = known_[&mesh];
  if (!tree) tree = &trees_.emplace_back([&mesh] { return make_tree(mesh); });
  return *tree;
}

void MeshTrees::prepare() const {
  for (const Lazy<Tree>& tree : trees_) tree.get();
}

}  // namespace vinerow::physics
