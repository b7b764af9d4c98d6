#pragma once
/// Drawable objects of the static world and of the vehicles' links.

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/vehicle.h"
#include "engine/render/culling.h"
#include "engine/render/gpu_mesh.h"

namespace vinerow::render {

struct GpuMaterial {
  float colour[4] = {1, 1, 1, 1};  ///< a: roughness
  GLuint image = 0;
  int texture_mode = 0;  ///< 0 none, 1 by uv, 2 grain along z
};

struct Drawable {
  const GpuMesh* mesh = nullptr;
  Pose X_WM;
  Eigen::AlignedBox3d box_W;
  GpuMaterial material;
  SurfaceClass surface = SurfaceClass::kObstacle;
  bool leaf_cards = false;
};

/// Levels of detail of one object, finest first; one of them is drawn.
struct LodGroup {
  std::vector<Drawable> levels;
  Eigen::AlignedBox3d box_W;
};

/// Store that uploads each mesh and image once and keeps them as long as the context.
class DrawableStore {
 public:
  explicit DrawableStore(const Gl& gl) : gl_(gl) {}

  /// Visible instances in the world's order, grouped by object with its levels of detail.
  std::vector<LodGroup> make_groups(const std::vector<MeshInstance>& instances);
  Drawable make_drawable(const std::shared_ptr<const TriangleMesh>& mesh, const Pose& X_WM,
                         SurfaceClass surface, const Material& material);

 private:
  const GpuMesh* find_mesh(const std::shared_ptr<const TriangleMesh>& mesh, CardKind cards);
  GLuint find_image(const std::string& name);

  struct Kept {
    std::shared_ptr<const TriangleMesh> mesh;  // keeps the address from being reused
    std::unique_ptr<GpuMesh> gpu;
  };
  const Gl& gl_;
  std::map<std::pair<const TriangleMesh*, CardKind>, Kept> meshes_;
  std::map<std::string, GLuint> images_;
};

}  // namespace vinerow::render
