#include "engine/render/drawables.h"

#include <algorithm>

#include "engine/imaging/texture.h"
#include "engine/render/builtin_textures.h"

namespace vinerow::render {

namespace {

CardKind card_kind(const Material& material) {
  if (!material.leaf_cards) return CardKind::kNone;
  if (material.texture == "builtin:tree_leaf") return CardKind::kTree;
  return CardKind::kVine;
}

}  // namespace

const GpuMesh* DrawableStore::find_mesh(const std::shared_ptr<const TriangleMesh>& mesh,
                                        CardKind cards) {
  Kept& kept = meshes_[{mesh.get(), cards}];
  if (!kept.gpu) {
    kept.mesh = mesh;
    kept.gpu = std::make_unique<GpuMesh>(upload_mesh(gl_, prepare_mesh(*mesh, cards)));
  }
  return kept.gpu.get();
}

GLuint DrawableStore::find_image(const std::string& name) {
  const auto known = images_.find(name);
  if (known != images_.end()) return known->second;
  GLuint texture = 0;
  if (name == "builtin:wood") {
    texture = upload_texture(gl_, imaging::mip_chain(wood_texture()), false);
  } else if (name == "builtin:bark") {
    texture = upload_texture(gl_, imaging::mip_chain(bark_texture()), false);
  } else if (!name.starts_with("builtin:")) {
    Result<imaging::Pixels> pixels = imaging::read_image(name);
    if (pixels) {
      // OpenGL's first row is the lowest.
      imaging::Pixels flipped(pixels->width, pixels->height);
      for (int y = 0; y < flipped.height; ++y) {
        std::copy_n(pixels->at(0, flipped.height - 1 - y), 4 * flipped.width, flipped.at(0, y));
      }
      texture = upload_texture(gl_, imaging::mip_chain(flipped), false);
    }
  }
  return images_[name] = texture;
}

Drawable DrawableStore::make_drawable(const std::shared_ptr<const TriangleMesh>& mesh,
                                      const Pose& X_WM, SurfaceClass surface,
                                      const Material& material) {
  Drawable drawable;
  drawable.leaf_cards = material.leaf_cards && mesh->uvs.size() == mesh->vertices.size();
  drawable.mesh = find_mesh(mesh, drawable.leaf_cards ? card_kind(material) : CardKind::kNone);
  drawable.X_WM = X_WM;
  drawable.box_W = transform_box(X_WM, drawable.mesh->bounds_M);
  drawable.surface = surface;
  for (int c = 0; c < 3; ++c) drawable.material.colour[c] = material.colour[c];
  drawable.material.colour[3] = material.roughness;
  if (!material.leaf_cards && !material.texture.empty()) {
    drawable.material.image = find_image(material.texture);
    const bool grain = material.texture.starts_with("builtin:");
    const bool has_uvs = mesh->uvs.size() == mesh->vertices.size();
    if (drawable.material.image != 0) drawable.material.texture_mode = grain ? 2 : has_uvs ? 1 : 0;
  }
  return drawable;
}

std::vector<LodGroup> DrawableStore::make_groups(const std::vector<MeshInstance>& instances) {
  std::vector<LodGroup> groups;
  std::map<std::string, std::size_t> by_name;
  std::vector<std::vector<int>> levels;
  for (const MeshInstance& instance : instances) {
    if (!instance.visible || !instance.mesh || instance.mesh->triangles.empty()) continue;
    const LodName name = split_lod_name(instance.name);
    std::size_t place = groups.size();
    if (name.level >= 0) place = by_name.try_emplace(name.base, place).first->second;
    if (place == groups.size()) {
      groups.emplace_back();
      levels.emplace_back();
    }
    LodGroup& group = groups[place];
    std::vector<int>& order = levels[place];
    const auto at = std::upper_bound(order.begin(), order.end(), name.level) - order.begin();
    order.insert(order.begin() + at, name.level);
    group.levels.insert(
        group.levels.begin() + at,
        make_drawable(instance.mesh, instance.X_WM, instance.surface, instance.material));
    group.box_W.extend(group.levels[at].box_W);
  }
  return groups;
}

}  // namespace vinerow::render
