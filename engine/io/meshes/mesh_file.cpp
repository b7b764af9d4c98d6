#include "engine/io/meshes/mesh_file.h"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <fstream>
#include <optional>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/io/meshes/collada_check.h"
#include "engine/io/meshes/mesh_ply.h"
#include "engine/io/meshes/mesh_references.h"
#include "engine/math/srgb.h"

namespace vinerow::io {
namespace {

void check_readable(const std::filesystem::path& file, const std::string& extension,
                    const Assimp::Importer& importer) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw ConfigError(fmt::format("mesh file '{}' does not exist", file.string()));
  }
  if (std::filesystem::file_size(file, error) == 0) {
    throw ConfigError(fmt::format("mesh file '{}' is empty (0 bytes)", file.string()));
  }
  if (extension.empty() || !importer.IsExtensionSupported(extension)) {
    throw ConfigError(
        fmt::format("mesh file '{}' has the unknown format '{}', must be one of: .obj, .stl, .dae, "
                    ".gltf, .glb, .ply",
                    file.string(), extension));
  }
}

/// Rotation from the file's axes to z up, and the scale to metres.
Eigen::Matrix3d calc_file_to_metres(const std::filesystem::path& file, const std::string& extension,
                                    const MeshFileOptions& options) {
  char up = 'Z';
  double file_unit_m = 1.0;  // included in assimp's node transforms
  if (extension == ".dae") {
    const ColladaAsset asset = read_collada_asset(file);
    up = asset.up_axis;
    file_unit_m = asset.unit_m;
  } else if (extension == ".gltf" || extension == ".glb") {
    up = 'Y';
  }
  if (options.up_axis == UpAxis::kY) up = 'Y';
  if (options.up_axis == UpAxis::kZ) up = 'Z';

  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (up == 'Y') R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (up == 'X') R << 0, 0, -1, 0, 1, 0, 1, 0, 0;

  const double unit = options.unit_m > 0.0 ? options.unit_m / file_unit_m : 1.0;
  return options.scale.asDiagonal() * (unit * R);
}

/// glTF's factors are linear; the other formats store sRGB.
Eigen::Vector3f linear_colour(const Eigen::Vector3f& colour, bool file_is_linear) {
  if (file_is_linear) return colour;
  const Eigen::Vector3d rgb = colour.cast<double>();
  return Eigen::Vector3d(linear_from_srgb(rgb.x()), linear_from_srgb(rgb.y()),
                         linear_from_srgb(rgb.z()))
      .cast<float>();
}

Eigen::Vector3f linear_colour(const aiColor4D& colour, bool file_is_linear) {
  return linear_colour(Eigen::Vector3f(colour.r, colour.g, colour.b), file_is_linear);
}

void add_note_once(std::vector<std::string>& notes, std::string note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
}

/// Pictures and cameras read PNG and JPEG; another file is a note.
void use_texture(const std::filesystem::path& texture, const std::filesystem::path& file,
                 Material& material, std::vector<std::string>& notes) {
  std::string head(8, '\0');
  std::ifstream in(texture, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (head.starts_with("\xff\xd8\xff") || head == "\x89PNG\r\n\x1a\n") {
    material.texture = texture.string();
    return;
  }
  add_note_once(notes, fmt::format("{}: texture '{}' is neither PNG nor JPEG and is not used",
                                   file.string(), texture.string()));
}

Material convert_material(const aiMaterial& source, const std::filesystem::path& file,
                          bool file_is_linear, std::vector<std::string>& notes) {
  Material material;
  aiString name;
  if (source.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = name.C_Str();
  aiColor4D colour;
  if (source.Get(AI_MATKEY_BASE_COLOR, colour) == aiReturn_SUCCESS ||
      source.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS) {
    material.colour = linear_colour(colour, file_is_linear);
  }
  float roughness = 0.0f;
  if (source.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness) == aiReturn_SUCCESS) {
    material.roughness = roughness;
  }
  // All textures of the material are looked up, but only the base colour is used.
  for (int type = aiTextureType_DIFFUSE; type <= AI_TEXTURE_TYPE_MAX; ++type) {
    const auto texture_type = static_cast<aiTextureType>(type);
    for (unsigned i = 0; i < source.GetTextureCount(texture_type); ++i) {
      aiString reference;
      if (source.GetTexture(texture_type, i, &reference) != aiReturn_SUCCESS) continue;
      const std::string text = reference.C_Str();
      if (!text.empty() && text.front() == '*') {
        add_note_once(notes, fmt::format("{}: the texture embedded in material '{}' is not used",
                                         file.string(), material.name));
        continue;
      }
      const auto found = find_reference(file, text);
      if (!found) {
        add_note_once(notes, fmt::format("{}: texture '{}' of material '{}' is missing",
                                         file.string(), text, material.name));
      } else if (texture_type == aiTextureType_DIFFUSE ||
                 texture_type == aiTextureType_BASE_COLOR) {
        use_texture(*found, file, material, notes);
      }
    }
  }
  return material;
}

Eigen::Matrix4d to_eigen(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return result;
}

TriangleMesh convert_mesh(const aiMesh& source, bool file_is_linear) {
  TriangleMesh mesh;
  mesh.vertices.reserve(source.mNumVertices);
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    const aiVector3D& v = source.mVertices[i];
    mesh.vertices.emplace_back(v.x, v.y, v.z);
  }
  if (source.HasNormals()) {
    mesh.normals.reserve(source.mNumVertices);
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
      const aiVector3D& n = source.mNormals[i];
      mesh.normals.emplace_back(n.x, n.y, n.z);
    }
  }
  if (source.HasTextureCoords(0)) {
    mesh.uvs.reserve(source.mNumVertices);
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
      mesh.uvs.emplace_back(source.mTextureCoords[0][i].x, source.mTextureCoords[0][i].y);
    }
  }
  if (source.HasVertexColors(0)) {
    mesh.colours.reserve(source.mNumVertices);
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
      mesh.colours.push_back(linear_colour(source.mColors[0][i], file_is_linear));
    }
  }
  mesh.triangles.reserve(source.mNumFaces);
  for (unsigned i = 0; i < source.mNumFaces; ++i) {
    const aiFace& face = source.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines
    mesh.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
  }
  return mesh;
}

/// Coordinates have 32 bits: their steps are 8 mm at this distance, and half a metre at the
/// northings of UTM, where a post is no body any more.
constexpr double kFarthest_m = 1e5;

/// Transforms a mesh to the result's axes and unit, and removes degenerate triangles.
void place_mesh(TriangleMesh& mesh, const Eigen::Matrix4d& transform, const std::string& name,
                const std::filesystem::path& file) {
  const Eigen::Matrix3d linear = transform.topLeftCorner<3, 3>();
  const Eigen::Vector3d shift = transform.topRightCorner<3, 1>();
  const double determinant = linear.determinant();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = linear * mesh.vertices[i].cast<double>() + shift;
    if (!p.allFinite()) {
      throw ConfigError(
          fmt::format("mesh file '{}': vertex {} of '{}' has a coordinate that is not finite",
                      file.string(), i, name));
    }
    if (p.cwiseAbs().maxCoeff() > kFarthest_m) {
      throw ConfigError(
          fmt::format("mesh file '{}': vertex {} of '{}' is {:.0f} m from the file's origin, must "
                      "be at most {:.0f} m, since coordinates of 32 bits are too coarse there: "
                      "subtract the same offset from all coordinates, or set the unit",
                      file.string(), i, name, p.cwiseAbs().maxCoeff(), kFarthest_m));
    }
    mesh.vertices[i] = p.cast<float>();
  }
  if (!(std::abs(determinant) > 0.0)) mesh.normals.clear();
  if (linear != Eigen::Matrix3d::Identity() && !mesh.normals.empty()) {
    const Eigen::Matrix3d normal_matrix = linear.inverse().transpose();
    for (Eigen::Vector3f& n : mesh.normals) {
      const Eigen::Vector3d turned = normal_matrix * n.cast<double>();
      const double length = turned.norm();
      const bool usable = std::isfinite(length) && length > 0.0;
      n = usable ? Eigen::Vector3f((turned / length).cast<float>()) : Eigen::Vector3f::UnitZ();
    }
  }
  if (determinant < 0.0) {  // a reflection inverts the faces
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  // Degenerate triangles have no normal and disturb contacts and rays.
  std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& t) {
    const Eigen::Vector3f& a = mesh.vertices[t[0]];
    const Eigen::Vector3f& b = mesh.vertices[t[1]];
    const Eigen::Vector3f& c = mesh.vertices[t[2]];
    return !((b - a).cast<double>().cross((c - a).cast<double>()).squaredNorm() > 0.0);
  });
}

struct Reading {
  const std::filesystem::path& file;
  const aiScene& scene;
  const std::vector<Material>& materials;
  bool file_is_linear;
  MeshFile result;
};

void read_node(const aiNode& node, const Eigen::Matrix4d& parent, Reading& reading) {
  const Eigen::Matrix4d transform = parent * to_eigen(node.mTransformation);
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& source = *reading.scene.mMeshes[node.mMeshes[i]];
    TriangleMesh mesh = convert_mesh(source, reading.file_is_linear);
    place_mesh(mesh, transform, source.mName.C_Str(), reading.file);
    if (mesh.triangles.empty()) continue;
    MeshPart part;
    part.name = node.mName.length > 0 ? node.mName.C_Str() : source.mName.C_Str();
    if (node.mNumMeshes > 1) part.name += fmt::format(".{}", i);
    part.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
    if (source.mMaterialIndex < reading.materials.size()) {
      part.material = reading.materials[source.mMaterialIndex];
    }
    reading.result.parts.push_back(std::move(part));
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    read_node(*node.mChildren[i], transform, reading);
  }
}

MeshFile load_ply(const std::filesystem::path& file, const Eigen::Matrix4d& to_metres,
                  bool join_vertices) {
  PlyMesh ply = read_ply_mesh(file);
  if (join_vertices) join_equal_vertices(ply.mesh);
  if (!ply.linear_colours) {
    for (Eigen::Vector3f& colour : ply.mesh.colours) colour = linear_colour(colour, false);
  }
  place_mesh(ply.mesh, to_metres, file.stem().string(), file);
  if (ply.mesh.triangles.empty()) {
    throw ConfigError(fmt::format("mesh file '{}' has no triangles", file.string()));
  }
  MeshFile result;
  result.notes = std::move(ply.notes);
  MeshPart part;
  part.material.colour = linear_colour(Eigen::Vector3f::Constant(0.6f), ply.linear_colours);
  if (!ply.texture.empty()) {
    if (const auto found = find_reference(file, ply.texture)) {
      use_texture(*found, file, part.material, result.notes);
    } else {
      result.notes.push_back(
          fmt::format("{}: texture '{}' is missing", file.string(), ply.texture));
    }
  }
  part.mesh = std::make_shared<const TriangleMesh>(std::move(ply.mesh));
  result.parts.push_back(std::move(part));
  return result;
}

}  // namespace

Eigen::AlignedBox3d MeshFile::bounds() const {
  Eigen::AlignedBox3d box;
  for (const MeshPart& part : parts) box.extend(part.mesh->bounds());
  return box;
}

std::string doubt_unit(const std::filesystem::path& file, const Eigen::AlignedBox3d& bounds,
                       const Eigen::Vector3d& max_m, const std::string& remedy) {
  const Eigen::Vector3d size_m = bounds.sizes();
  if ((size_m.array() <= max_m.array()).all()) return "";
  return fmt::format("{} is read as {:.4g} x {:.4g} x {:.4g} m; if it is in millimetres, {}",
                     file.string(), size_m.x(), size_m.y(), size_m.z(), remedy);
}

MeshFile load_mesh(const std::filesystem::path& file, const MeshFileOptions& options) {
  Assimp::Importer importer;
  const std::string extension = lower_extension(file);
  check_readable(file, extension, importer);
  Eigen::Matrix4d to_metres = Eigen::Matrix4d::Identity();
  to_metres.topLeftCorner<3, 3>() = calc_file_to_metres(file, extension, options);
  if (extension == ".ply") return load_ply(file, to_metres, options.join_vertices);

  if (extension == ".dae") check_collada(file);
  // assimp would turn Z-up COLLADA into Y-up; the axes are handled above for all formats alike.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  unsigned steps = aiProcess_Triangulate | aiProcess_SortByPType;
  if (options.join_vertices) steps |= aiProcess_JoinIdenticalVertices;
  const aiScene* scene = importer.ReadFile(file.string(), steps);
  if (scene == nullptr) {
    // assimp has no error text for a file without usable content.
    const std::string reason = importer.GetErrorString();
    // Only points and lines: assimp's text for the case of no triangles below.
    if (reason.find("No meshes") != std::string::npos) {
      throw ConfigError(fmt::format("mesh file '{}' has no triangles", file.string()));
    }
    throw ConfigError(fmt::format("mesh file '{}' cannot be read: {}", file.string(),
                                  reason.empty() ? "it has no geometry" : reason));
  }

  const bool file_is_linear = extension == ".gltf" || extension == ".glb";
  std::vector<std::string> notes;
  if (extension == ".obj") {
    for (const std::string& library : read_material_libraries(file)) {
      if (!find_reference(file, library)) {
        notes.push_back(
            fmt::format("{}: material library '{}' is missing", file.string(), library));
      }
    }
  }
  std::vector<Material> materials;
  for (unsigned i = 0; i < scene->mNumMaterials; ++i) {
    materials.push_back(convert_material(*scene->mMaterials[i], file, file_is_linear, notes));
  }
  Reading reading{file, *scene, materials, file_is_linear, {}};
  if (scene->mRootNode != nullptr) read_node(*scene->mRootNode, to_metres, reading);
  if (reading.result.parts.empty()) {
    throw ConfigError(fmt::format("mesh file '{}' has no triangles", file.string()));
  }
  reading.result.notes = std::move(notes);
  return std::move(reading.result);
}

TriangleMesh merge_parts(const MeshFile& file) {
  const auto all_have = [&](auto member) {
    return std::all_of(file.parts.begin(), file.parts.end(), [&](const MeshPart& part) {
      return ((*part.mesh).*member).size() == part.mesh->vertices.size();
    });
  };
  const bool normals = all_have(&TriangleMesh::normals);
  const bool uvs = all_have(&TriangleMesh::uvs);
  const bool colours = all_have(&TriangleMesh::colours);
  TriangleMesh merged;
  for (const MeshPart& part : file.parts) {
    const auto first = static_cast<std::uint32_t>(merged.vertices.size());
    const TriangleMesh& mesh = *part.mesh;
    merged.vertices.insert(merged.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    if (normals)
      merged.normals.insert(merged.normals.end(), mesh.normals.begin(), mesh.normals.end());
    if (uvs) merged.uvs.insert(merged.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
    if (colours)
      merged.colours.insert(merged.colours.end(), mesh.colours.begin(), mesh.colours.end());
    for (const auto& t : mesh.triangles) {
      merged.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  return merged;
}

}  // namespace vinerow::io
