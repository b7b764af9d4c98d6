#include "engine/io/meshes/mesh_scene_writer.h"

#include <fmt/format.h>

#include <bit>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/whole_file.h"

namespace vinerow::io {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the glTF writer copies memory as little-endian");

// Constants of the specification: types of components, primitives and buffer views.
constexpr int kFloat = 5126, kUint16 = 5123, kUint32 = 5125, kTriangles = 4;
constexpr int kVertices = 34962, kIndices = 34963;

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

template <class T>
void append_array(std::string& bytes, const T* data, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(data), count * sizeof(T));
}

void append_number(std::string& bytes, std::size_t number) {
  const auto word = static_cast<std::uint32_t>(number);
  append_array(bytes, &word, 1);
}

void pad(std::string& bytes, char with) {
  while (bytes.size() % 4 != 0) bytes += with;
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
  using nlohmann::json;
  json root;
  root["asset"] = {{"version", "2.0"}, {"generator", "Vinerow"}};
  root["scene"] = 0;
  root["scenes"] = json::array({{{"nodes", {0}}}});
  // Rotation about x by -90 degrees: z up becomes y up.
  constexpr double kHalf = 0.70710678118654752;
  root["nodes"] = json::array({{{"name", "z_up"}, {"rotation", {-kHalf, 0.0, 0.0, kHalf}}}});
  root["materials"] = json::array(
      {{{"name", material.name},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {material.colour.x(), material.colour.y(), material.colour.z(), 1.0}},
          {"metallicFactor", 0.0},
          {"roughnessFactor", material.roughness}}}}});
  std::string data;
  json &accessors = root["accessors"] = json::array(), &views = root["bufferViews"] = json::array();
  root["meshes"] = json::array();
  const auto add_view = [&](std::size_t begin, int target) {
    views.push_back({{"buffer", 0},
                     {"byteOffset", begin},
                     {"byteLength", data.size() - begin},
                     {"target", target}});
    pad(data, '\0');
    return views.size() - 1;
  };
  for (const NamedMesh& named : checked(meshes, file)) {
    const TriangleMesh& mesh = *named.mesh;
    std::size_t begin = data.size();
    Eigen::Vector3f low = mesh.vertices.front(), high = low;
    for (const Eigen::Vector3f& v : mesh.vertices) {
      append_array(data, v.data(), 3);
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    accessors.push_back({{"bufferView", add_view(begin, kVertices)},
                         {"componentType", kFloat},
                         {"count", mesh.vertices.size()},
                         {"type", "VEC3"},
                         {"min", {low.x(), low.y(), low.z()}},
                         {"max", {high.x(), high.y(), high.z()}}});
    // The largest 16-bit number means primitive restart and is not a valid index.
    const bool fits = mesh.vertices.size() <= std::numeric_limits<std::uint16_t>::max();
    begin = data.size();
    for (const auto& t : mesh.triangles) {
      if (fits) {
        const std::uint16_t corners[] = {static_cast<std::uint16_t>(t[0]),
                                         static_cast<std::uint16_t>(t[1]),
                                         static_cast<std::uint16_t>(t[2])};
        append_array(data, corners, 3);
      } else {
        append_array(data, t.data(), 3);
      }
    }
    accessors.push_back({{"bufferView", add_view(begin, kIndices)},
                         {"componentType", fits ? kUint16 : kUint32},
                         {"count", 3 * mesh.triangles.size()},
                         {"type", "SCALAR"}});
    const json primitive = {{"attributes", {{"POSITION", accessors.size() - 2}}},
                            {"indices", accessors.size() - 1},
                            {"material", 0},
                            {"mode", kTriangles}};
    root["meshes"].push_back({{"name", named.name}, {"primitives", json::array({primitive})}});
    root["nodes"].push_back({{"name", named.name}, {"mesh", root["meshes"].size() - 1}});
    root["nodes"][0]["children"].push_back(root["nodes"].size() - 1);
  }
  root["buffers"] = json::array({{{"byteLength", data.size()}}});
  std::string text = root.dump();
  pad(text, ' ');
  if (data.size() + text.size() > std::numeric_limits<std::uint32_t>::max() - 64) {
    throw ConfigError(
        fmt::format("mesh file '{}': {} bytes of meshes, glTF holds up to 4 GB; write PLY instead",
                    file.string(), data.size()));
  }
  std::string bytes = "glTF";
  append_number(bytes, 2);
  append_number(bytes, 12 + 8 + text.size() + 8 + data.size());
  append_number(bytes, text.size());
  bytes += "JSON" + text;
  append_number(bytes, data.size());
  bytes.append("BIN\0", 4);
  bytes += data;
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
