#pragma once
/// Stores of generated meshes: in memory, or as files that are written once and always read back.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/parameters.h"
#include "engine/core/hash.h"

namespace vinerow::worlds {

class MeshStore {
 public:
  /// Of one mesh, which is a stretch of a row or a tree; in full leaf they have a twentieth.
  static constexpr std::size_t kMostTriangles = 3'000'000;

  virtual ~MeshStore() = default;
  /// Mesh of this name, made at the first call and shared by all callers.
  /// @throws ConfigError if it has more than kMostTriangles
  virtual std::shared_ptr<const TriangleMesh> get(const std::string& name,
                                                  const std::function<TriangleMesh()>& make) = 0;
};

class MemoryMeshStore final : public MeshStore {
 public:
  std::shared_ptr<const TriangleMesh> get(const std::string& name,
                                          const std::function<TriangleMesh()>& make) override;

 private:
  std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes_;
};

/// Binary PLY files in one folder. Old and new files are both read through assimp, so that they
/// give the same bits.
///
/// A file contains the digest of its mesh; a damaged or truncated file is replaced. Files are
/// created by renaming, so that several processes may write to the folder at once.
class FileMeshStore final : public MeshStore {
 public:
  explicit FileMeshStore(std::filesystem::path folder);
  /// @throws ConfigError if the file cannot be written
  std::shared_ptr<const TriangleMesh> get(const std::string& name,
                                          const std::function<TriangleMesh()>& make) override;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes_;
};

/// Default folder of mesh files: the first writable one of $VINEROW_CACHE,
/// $XDG_CACHE_HOME/vinerow, $HOME/.cache/vinerow and the system's folder for temporary files.
/// @throws ConfigError naming the folders that were tried
std::filesystem::path find_cache_folder();
/// What the parameter `mesh_folder` of a world is.
constexpr const char* kMeshFolderText =
    "folder for mesh files, made if it is missing; default: $VINEROW_CACHE or the user's cache "
    "folder";

/// Digest of a mesh's numbers.
std::string mesh_digest(const TriangleMesh& mesh);

/// Adds the values of those specs, by name; groups whole.
void add_parameters(Hasher& hasher, const ParameterSet& parameters,
                    const std::vector<ParameterSpec>& specs);

}  // namespace vinerow::worlds
