// The scenery around a world: fields and tracks on the ground, rows, trees.
#include <array>
#include <limits>

#include "engine/render/gl_renderer.h"
#include "engine/render/land_use.h"
#include "engine/render/noise.h"
#include "engine/render/scenery_meshes.h"
#include "engine/render/texture_units.h"

namespace vinerow::render {

void GlRenderer::upload_land_use(const LandUse& land) {
  land_rect_ = {static_cast<float>(land.corner_W.x()), static_cast<float>(land.corner_W.y()),
                static_cast<float>(1.0 / land.size_m.x()),
                static_cast<float>(1.0 / land.size_m.y())};
  gl_.ActiveTexture(GL_TEXTURE0 + kUnitLand);
  upload_texture(gl_, {land.pixels}, true);
  gl_.ActiveTexture(GL_TEXTURE0 + kUnitFields);
  GLuint table = 0;
  gl_.GenTextures(1, &table);
  gl_.BindTexture(GL_TEXTURE_2D, table);
  const std::vector<float> none(12, 0.0f);
  const std::vector<float>& rows = land.table.empty() ? none : land.table;
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 3, static_cast<GLsizei>(rows.size() / 12), 0,
                 GL_RGBA, GL_FLOAT, rows.data());
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.ActiveTexture(GL_TEXTURE0 + kUnitImage);
}

void GlRenderer::make_scenery(const Scenery& scenery) {
  if (scenery.empty() || !terrain_) return;
  upload_land_use(make_land_use(scenery, *terrain_, light_.sun_direction_W));
  hedge_ = make_program("hedge", shaders::hedge());
  stem_ = make_program("stems", shaders::stems());
  for (const SceneryField& field : scenery.fields) {
    hedges_.push_back(upload_mesh(gl_, make_hedges(field, *terrain_)));
    stems_.push_back(upload_mesh(gl_, make_stems(field, *terrain_)));
  }
  add_trees(scenery);
}

void GlRenderer::add_trees(const Scenery& scenery) {
  struct Tree {
    std::shared_ptr<const TriangleMesh> crown, trunk;
  };
  std::array<Tree, kSceneryTreeKinds> kinds;
  for (int i = 0; i < kSceneryTreeKinds; ++i) {
    kinds[i] = {make_scenery_crown(kSceneryTrees[i], i), make_scenery_trunk(kSceneryTrees[i])};
  }
  Material leaves;
  leaves.leaf_cards = true;
  leaves.texture = "builtin:tree_leaf";
  leaves.colour = {1, 1, 1};
  Material bark;
  bark.colour = {0.10f, 0.078f, 0.06f};
  for (std::size_t i = 0; i < scenery.trees.size(); ++i) {
    const SceneryTree& tree = scenery.trees[i];
    if (tree.kind < 0 || tree.kind >= kSceneryTreeKinds) continue;
    const double half_turn = 3.14159265 * hash01(static_cast<std::uint32_t>(i), 1u, 51u);
    Pose X_WT;
    X_WT.p = {tree.p_W.x(), tree.p_W.y(), terrain_->height_m(tree.p_W.x(), tree.p_W.y())};
    X_WT.q = Eigen::Quaterniond(std::cos(half_turn), 0.0, 0.0, std::sin(half_turn));
    const auto add = [&](const std::shared_ptr<const TriangleMesh>& mesh, SurfaceClass surface,
                         const Material& material) {
      LodGroup group;
      group.levels.push_back(store_.make_drawable(mesh, X_WT, surface, material));
      group.box_W = group.levels.front().box_W;
      groups_.push_back(std::move(group));
    };
    add(kinds[tree.kind].crown, SurfaceClass::kCanopy, leaves);
    // Not kTrunk, which is omitted at a distance (is_drawn_at): these trunks are thicker.
    add(kinds[tree.kind].trunk, SurfaceClass::kObstacle, bark);
  }
}

void GlRenderer::draw_hedges(const Camera& camera, const Frustum& frustum) {
  // Beyond this distance a stem is thinner than a pixel.
  constexpr double kStems_m = 120.0;
  gl_.Disable(GL_CULL_FACE);
  const auto draw = [&](const Program& program, const std::vector<GpuMesh>& meshes,
                        double reach_m) {
    gl_.UseProgram(program.id);
    for (const GpuMesh& mesh : meshes) {
      if (mesh.index_count == 0 || mesh.bounds_M.exteriorDistance(camera.X_WC.p) > reach_m)
        continue;
      if (!settings_.cull || frustum.may_see(mesh.bounds_M)) draw_mesh(mesh);
    }
  };
  draw(hedge_, hedges_, std::numeric_limits<double>::infinity());
  draw(stem_, stems_, kStems_m);
}

}  // namespace vinerow::render
