#pragma once
/// Where generated meshes live: in memory, or as mesh files that are written once and always read
/// back.

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
  virtual ~MeshStore() = default;
  /// The mesh of this name; made at the first call. One name is one mesh, shared by all who ask.
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

/// Binary PLY files in one folder, read through assimp whether they were there or are new: same
/// bits either way.
///
/// A file carries the digest of its mesh; one that is damaged or cut off is made again. Files
/// appear by renaming, so that several processes may fill the folder at once.
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

/// Where mesh files go unless the user says: $VINEROW_CACHE, $XDG_CACHE_HOME/vinerow,
/// $HOME/.cache/vinerow or the system's folder for temporary files, the first that can be written.
/// @throws ConfigError naming what was tried
std::filesystem::path find_cache_folder();

/// Digest of a mesh's numbers.
std::string mesh_digest(const TriangleMesh& mesh);

/// Feeds every value of a set, by name, in the order of the specs. @param without  names left out
void add_parameters(Hasher& hasher, const ParameterSet& parameters,
                    const std::vector<std::string>& without = {});

}  // namespace vinerow::worlds
