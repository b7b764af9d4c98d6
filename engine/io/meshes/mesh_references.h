#pragma once
/// References of mesh files to other files, and axes and unit of COLLADA files.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vinerow::io {

/// Contents of the <asset> element of a COLLADA file.
struct ColladaAsset {
  char up_axis = 'Y';  ///< 'X', 'Y' or 'Z'; the format's default is Y
  double unit_m = 1.0;
};

ColladaAsset read_collada_asset(const std::filesystem::path& file);

/// The `mtllib` files that an OBJ file names, as written.
std::vector<std::string> read_material_libraries(const std::filesystem::path& obj_file);

/// Finds a file that a mesh file names: relative to the mesh file's folder, percent-decoded,
/// without `file://`, back slashes replaced. @returns the absolute path, or nullopt if there is no
/// such file
std::optional<std::filesystem::path> find_reference(const std::filesystem::path& mesh_file,
                                                    const std::string& reference);

}  // namespace vinerow::io
