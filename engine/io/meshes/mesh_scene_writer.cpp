#include "engine/io/meshes/mesh_scene_writer.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <limits>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/io/meshes/glb_writer.h"

namespace vinerow::io {
namespace {

/// Removes meshes without triangles: accessors of a glTF file must not be empty.
std::vector<NamedMesh> checked(std::span<const NamedMesh> meshes,
                               const std::filesystem::path& file) {
  std::vector<NamedMesh> result;
  for (const NamedMesh& named : meshes) {
    VINEROW_DEMAND(named.mesh != nullptr);
    for (const Eigen::Vector3f& v : named.mesh->vertices) {
      if (v.allFinite()) continue;
      throw ConfigError(fmt::format(
          "mesh file '{}': mesh '{}' has a vertex that is not finite, it is not written",
          file.string(), named.name));
    }
    if (!named.mesh->triangles.empty()) result.push_back(named);
  }
  if (result.empty()) {
    throw ConfigError(fmt::format("mesh file '{}': no mesh has triangles to write", file.string()));
  }
  return result;
}

void save(const std::string& bytes, const std::filesystem::path& file) {
  write_whole_file(file, bytes, "mesh file");
}

}  // namespace

void write_obj(std::span<const NamedMesh> meshes, const std::filesystem::path& file) {
  std::string text = "# Vinerow: metres, z up\n";
  std::size_t first = 1;
  for (const NamedMesh& named : checked(meshes, file)) {
    text += fmt::format("o {}\n", named.name);
    for (const Eigen::Vector3f& v : named.mesh->vertices) {
      text += fmt::format("v {:.4f} {:.4f} {:.4f}\n", v.x(), v.y(), v.z());
    }
    for (const auto& t : named.mesh->triangles) {
      text += fmt::format("f {} {} {}\n", first + t[0], first + t[1], first + t[2]);
    }
    first += named.mesh->vertices.size();
  }
  save(text, file);
}

void write_glb(std::span<const NamedMesh> meshes, const std::filesystem::path& file,
               const Material& material) {
  GlbWriter glb;
  const int look = glb.add_material(glb_material(material));
  for (const NamedMesh& named : checked(meshes, file)) {
    const TriangleMesh& mesh = *named.mesh;
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& v : mesh.vertices) box.extend(v);
    GlbAttribute positions{"POSITION", "VEC3", GlbNumber::kFloat, {}, false, {}, {}};
    positions.bytes.assign(reinterpret_cast<const char*>(mesh.vertices.data()),
                           sizeof(Eigen::Vector3f) * mesh.vertices.size());
    for (const float low : box.min()) positions.low.push_back(low);
    for (const float high : box.max()) positions.high.push_back(high);
    const int added =
        glb.add_mesh(named.name, mesh.vertices.size(), {&positions, 1},
                     {mesh.triangles.front().data(), 3 * mesh.triangles.size()}, look);
    glb.add_node({{"name", named.name}, {"mesh", added}});
  }
  const std::string bytes = glb.bytes();
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw ConfigError(
        fmt::format("mesh file '{}': is {} bytes long, glTF holds up to 4 GB; write PLY instead",
                    file.string(), bytes.size()));
  }
  save(bytes, file);
}

Material canopy_material() {
  Material material;
  material.name = "canopy";
  material.colour = {0.09f, 0.21f, 0.05f};
  material.roughness = 0.9f;
  return material;
}

TriangleMesh join_meshes(std::span<const NamedMesh> meshes) {
  TriangleMesh result;
  for (const NamedMesh& named : meshes) {
    VINEROW_DEMAND(named.mesh != nullptr);
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.insert(result.vertices.end(), named.mesh->vertices.begin(),
                           named.mesh->vertices.end());
    for (const auto& t : named.mesh->triangles) {
      result.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  return result;
}

}  // namespace vinerow::io
