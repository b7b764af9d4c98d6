#include "worlds/parts/mesh_store.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <type_traits>
#include <variant>

#include "engine/core/check.h"
#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/io/meshes/mesh_writer.h"

namespace vinerow::worlds {
namespace {

/// What load_mesh would leave out: triangles without area.
void drop_degenerate(TriangleMesh& mesh) {
  const auto flat = [&](const std::array<std::uint32_t, 3>& t) {
    const Eigen::Vector3f& a = mesh.vertices[t[0]];
    const Eigen::Vector3f ab = mesh.vertices[t[1]] - a, ac = mesh.vertices[t[2]] - a;
    return !(ab.cast<double>().cross(ac.cast<double>()).squaredNorm() > 0.0);
  };
  // The things begin where their first remaining triangle is.
  std::uint32_t kept = 0;
  std::size_t thing = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    while (thing < mesh.things.size() && mesh.things[thing] == i) mesh.things[thing++] = kept;
    if (!flat(mesh.triangles[i])) mesh.triangles[kept++] = mesh.triangles[i];
  }
  while (thing < mesh.things.size()) mesh.things[thing++] = kept;
  mesh.triangles.resize(kept);
}

/// A name that no other writer of this machine has: neither another process nor another thread that
/// makes the same mesh at the same time.
std::string partial_name_of(const std::string& name) {
  static std::atomic<int> count = 0;
  return fmt::format("{}.{}.{}.partial.ply", name, ::getpid(), ++count);
}

std::string file_name_of(std::string name) {
  std::replace(name.begin(), name.end(), '/', '-');
  std::replace(name.begin(), name.end(), '#', '.');
  return name + ".ply";
}

/// Plants of very many organs would take all memory.
void check_size(const std::string& name, const TriangleMesh& mesh) {
  if (mesh.triangles.size() <= MeshStore::kMostTriangles) return;
  throw ConfigError(fmt::format(
      "'{}' has {:.1f} million triangles, must be at most {:.1f} million: take fewer organs (of "
      "vines berries, bunches_per_shoot, shoots_per_m, lateral_share; of trees leaf_area_per_m3, "
      "fruits, tree_height_m, row_width_m)",
      name, 1e-6 * static_cast<double>(mesh.triangles.size()),
      1e-6 * static_cast<double>(MeshStore::kMostTriangles)));
}

}  // namespace

std::shared_ptr<const TriangleMesh> MemoryMeshStore::get(
    const std::string& name, const std::function<TriangleMesh()>& make) {
  auto& mesh = meshes_[name];
  if (!mesh) {
    mesh = std::make_shared<const TriangleMesh>(make());
    check_size(name, *mesh);
  }
  return mesh;
}

FileMeshStore::FileMeshStore(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw ConfigError(fmt::format("folder '{}' for mesh files cannot be created: {}",
                                  folder_.string(), error.message()));
  }
}

std::shared_ptr<const TriangleMesh> FileMeshStore::get(const std::string& name,
                                                       const std::function<TriangleMesh()>& make) {
  auto& known = meshes_[name];
  if (known) return known;
  const std::filesystem::path file = folder_ / file_name_of(name);
  if (auto stored = io::read_intact_ply(file)) {
    return known = std::make_shared<const TriangleMesh>(*std::move(stored));
  }
  TriangleMesh fresh = make();
  check_size(name, fresh);
  drop_degenerate(fresh);
  const std::filesystem::path partial = folder_ / partial_name_of(file_name_of(name));
  io::write_ply(fresh, partial);
  std::error_code error;
  std::filesystem::rename(partial, file, error);
  if (error) {
    throw ConfigError(
        fmt::format("mesh file '{}' cannot be written: {}", file.string(), error.message()));
  }
  auto stored = io::read_intact_ply(file);
  VINEROW_DEMAND(stored && mesh_digest(*stored) == mesh_digest(fresh));
  return known = std::make_shared<const TriangleMesh>(*std::move(stored));
}

std::filesystem::path find_cache_folder() {
  std::vector<std::filesystem::path> candidates;
  const auto add = [&](const char* variable, const char* below) {
    const char* value = std::getenv(variable);
    if (value != nullptr && *value != '\0') {
      candidates.push_back(std::filesystem::path(value) / below);
    }
  };
  add("VINEROW_CACHE", "");
  add("XDG_CACHE_HOME", "vinerow");
  add("HOME", ".cache/vinerow");
  std::error_code error;
  const std::filesystem::path temporary = std::filesystem::temp_directory_path(error);
  if (!error) candidates.push_back(temporary / fmt::format("vinerow-{}", ::getuid()));
  std::vector<std::string> tried;
  for (const std::filesystem::path& folder : candidates) {
    std::filesystem::create_directories(folder, error);
    if (!error && ::access(folder.c_str(), W_OK) == 0) return folder;
    tried.push_back(folder.string());
  }
  throw ConfigError(fmt::format(
      "no folder for generated mesh files can be written (tried: {}); set VINEROW_CACHE to one",
      join(tried)));
}

std::string mesh_digest(const TriangleMesh& mesh) {
  Hasher hasher;
  const auto add = [&](const auto& list) {
    hasher.add(static_cast<std::uint64_t>(list.size()));
    if (!list.empty()) hasher.add_bytes(list.data(), list.size() * sizeof(list[0]));
  };
  add(mesh.vertices);
  add(mesh.triangles);
  add(mesh.normals);
  add(mesh.uvs);
  add(mesh.colours);
  if (!mesh.things.empty()) add(mesh.things);
  return hasher.hex();
}

void add_parameters(Hasher& hasher, const ParameterSet& parameters,
                    const std::vector<ParameterSpec>& specs) {
  const auto add = [&hasher](const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, std::vector<ParameterSet>>) {
      for (const ParameterSet& group : value) add_parameters(hasher, group, group.specs());
    } else if constexpr (std::is_same_v<Value, std::vector<double>> ||
                         std::is_same_v<Value, std::vector<std::string>>) {
      for (const auto& entry : value) hasher.add(entry);
    } else {
      hasher.add(value);
    }
  };
  for (const ParameterSpec& spec : specs) {
    const ParameterSet::Value* value = parameters.find(spec.name);
    if (!value) continue;
    hasher.add(spec.name);
    std::visit(add, *value);
  }
}

}  // namespace vinerow::worlds
