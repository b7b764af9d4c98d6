#include "worlds/mapping/folder/map_files.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>

#include "engine/core/error.h"
#include "engine/io/meshes/mesh_file.h"
#include "engine/io/meshes/mesh_writer.h"

namespace vinerow::mapping {
namespace {

/// Reads "row_03_hull_00.ply"; nothing of other names.
bool parse_name(const std::string& name, int& row, int& hull) {
  int end = 0;
  return std::sscanf(name.c_str(), "row_%d_hull_%d.ply%n", &row, &hull, &end) == 2 &&
         end == static_cast<int>(name.size());
}

std::map<std::pair<int, int>, std::filesystem::path> mesh_files(const std::string& folder) {
  std::map<std::pair<int, int>, std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    int row = 0, hull = 0;
    if (parse_name(entry.path().filename().string(), row, hull)) {
      files[{row, hull}] = entry.path();
    }
  }
  return files;
}

}  // namespace

void save_meshes(const std::vector<RowMesh>& meshes, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw ConfigError(
        fmt::format("folder '{}' cannot be created for the map: {}", folder, error.message()));
  }
  for (const auto& [numbers, file] : mesh_files(folder)) std::filesystem::remove(file, error);
  std::map<int, int> hulls;
  for (const RowMesh& mesh : meshes) {
    io::write_ply(mesh.mesh_W,
                  std::filesystem::path(folder) /
                      fmt::format("row_{:02}_hull_{:02}.ply", mesh.row, hulls[mesh.row]++));
  }
}

std::vector<RowMesh> load_meshes(const std::string& folder) {
  std::vector<RowMesh> meshes;
  for (const auto& [numbers, file] : mesh_files(folder)) {
    io::MeshFileOptions options;
    options.join_vertices = false;
    meshes.push_back({numbers.first, io::merge_parts(io::load_mesh(file, options))});
    // Colours and normals mean nothing on a map.
    TriangleMesh& mesh = meshes.back().mesh_W;
    mesh.normals.clear();
    mesh.uvs.clear();
    mesh.colours.clear();
  }
  if (meshes.empty()) {
    throw ConfigError(fmt::format(
        "folder '{}' holds no row meshes: their files are called row_<number>_hull_<number>.ply",
        folder));
  }
  return meshes;
}

}  // namespace vinerow::mapping
