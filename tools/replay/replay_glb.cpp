#include "tools/replay/replay_glb.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "engine/core/check.h"

namespace vinerow::tools {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little,
              "the glTF writer copies memory as little-endian");

// Constants of the specification: component types, primitive modes, buffer view targets.
constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125, kTriangles = 4;
constexpr int kVertices = 34962, kIndices = 34963;
constexpr double kMaxShort = 32767.0;

template <class T>
void append_values(std::string& bytes, std::initializer_list<T> values) {
  for (const T value : values) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
}

void append_word(std::string& bytes, std::size_t number) {
  append_values(bytes, {static_cast<std::uint32_t>(number)});
}

/// Value rounded to a micrometre: longer numbers would double a scene's text.
double rounded(double value) {
  return 1e-6 * std::round(1e6 * value);
}

json rounded_array_of(const Eigen::Vector3d& v) {
  return {rounded(v.x()), rounded(v.y()), rounded(v.z())};
}

/// Rotation rounded to the precision of float.
json rotation_of(const Eigen::Quaterniond& q) {
  json out = json::array();
  for (const double c : {q.x(), q.y(), q.z(), q.w()}) out.push_back(1e-8 * std::round(1e8 * c));
  return out;
}

json uniform_scale(double factor) {
  return {factor, factor, factor};
}

/// Linear 16-bit colour. GpuVertex stores square roots of linear colours to keep steps in the dark.
std::uint16_t linear_short(std::uint8_t root) {
  const double share = root / 255.0;
  return static_cast<std::uint16_t>(std::lround(65535.0 * share * share));
}

std::uint8_t linear_byte(std::uint8_t root) {
  return static_cast<std::uint8_t>(std::lround(root * root / 255.0));
}

std::uint8_t unsigned_byte(float share) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(share, 0.0f, 1.0f)));
}

}  // namespace

GlbScene::GlbScene() {
  root_["asset"] = {{"version", "2.0"}, {"generator", "Vinerow"}};
  root_["extensionsUsed"] = {"KHR_mesh_quantization"};
  root_["extensionsRequired"] = {"KHR_mesh_quantization"};
  root_["scene"] = 0;
  root_["scenes"] = json::array({{{"nodes", {0}}}});
  // Rotation by -90 degrees about x: z up becomes y up.
  constexpr double kHalf = 0.70710678118654752;
  root_["nodes"] = json::array({{{"name", "z_up"}, {"rotation", {-kHalf, 0.0, 0.0, kHalf}}}});
  for (const char* list : {"materials", "meshes", "accessors", "bufferViews"}) {
    root_[list] = json::array();
  }
}

int GlbScene::add_material(const GlbMaterial& material) {
  json entry = {
      {"name", material.name},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {material.colour.x(), material.colour.y(), material.colour.z(), 1.0}},
        {"metallicFactor", 0.0},
        {"roughnessFactor", material.roughness}}}};
  if (material.two_sided || material.leaf_cards) entry["doubleSided"] = true;
  if (material.leaf_cards) entry["alphaMode"] = "MASK";
  json& materials = root_["materials"];
  const auto found = std::find(materials.begin(), materials.end(), entry);
  if (found != materials.end()) return static_cast<int>(found - materials.begin());
  materials.push_back(std::move(entry));
  return static_cast<int>(materials.size()) - 1;
}

int GlbScene::add_accessor(const std::string& bytes, std::size_t stride, int component,
                           const char* type, std::size_t count, bool normalised, int target) {
  json view = {{"buffer", 0},
               {"byteOffset", data_.size()},
               {"byteLength", bytes.size()},
               {"target", target}};
  if (target == kVertices) view["byteStride"] = stride;
  root_["bufferViews"].push_back(std::move(view));
  data_ += bytes;
  while (data_.size() % 4 != 0) data_ += '\0';
  json accessor = {{"bufferView", root_["bufferViews"].size() - 1},
                   {"componentType", component},
                   {"count", count},
                   {"type", type}};
  if (normalised) accessor["normalized"] = true;
  root_["accessors"].push_back(std::move(accessor));
  return static_cast<int>(root_["accessors"].size()) - 1;
}

int GlbScene::add_mesh(const std::string& name, const render::PreparedMesh& mesh, int material,
                       bool coloured, bool cards) {
  VINEROW_DEMAND(!mesh.vertices.empty() && !mesh.indices.empty());
  Eigen::AlignedBox3d box;
  for (const render::GpuVertex& v : mesh.vertices) {
    const Eigen::Vector3d p = Eigen::Map<const Eigen::Vector3f>(v.position).cast<double>();
    VINEROW_DEMAND(p.allFinite());
    box.extend(p);
  }
  const double half_m = std::max(0.5 * box.sizes().maxCoeff(), 1e-6);
  const Placement placement{box.center(), half_m / kMaxShort};
  placements_.push_back(placement);

  // The specification requires attributes to start at multiples of four bytes.
  std::string positions, normals, colours, uvs;
  Eigen::Vector3i low = Eigen::Vector3i::Constant(std::numeric_limits<int>::max()), high = -low;
  for (const render::GpuVertex& v : mesh.vertices) {
    const Eigen::Vector3d p = Eigen::Map<const Eigen::Vector3f>(v.position).cast<double>();
    const Eigen::Vector3i steps =
        ((p - placement.centre_M) / placement.step_m).array().round().cast<int>();
    low = low.cwiseMin(steps);
    high = high.cwiseMax(steps);
    append_values(positions,
                  {static_cast<std::int16_t>(steps.x()), static_cast<std::int16_t>(steps.y()),
                   static_cast<std::int16_t>(steps.z()), std::int16_t{0}});
    append_values(normals, {v.normal[0], v.normal[1], v.normal[2], std::int8_t{0}});
    if (coloured && cards) {
      // 8 bits for leaves: they are many, and their pattern hides the steps of dark colours.
      append_values(colours, {linear_byte(v.colour[0]), linear_byte(v.colour[1]),
                              linear_byte(v.colour[2]), std::uint8_t{0}});
    } else if (coloured) {
      append_values(colours, {linear_short(v.colour[0]), linear_short(v.colour[1]),
                              linear_short(v.colour[2]), std::uint16_t{0}});
    }
    if (cards) {
      append_values(
          uvs, {unsigned_byte(v.uv[0]), unsigned_byte(v.uv[1]), std::uint8_t{0}, std::uint8_t{0}});
    }
  }
  const std::size_t count = mesh.vertices.size();
  json attributes;
  const int at = add_accessor(positions, 8, kShort, "VEC3", count, false, kVertices);
  root_["accessors"][at]["min"] = {low.x(), low.y(), low.z()};
  root_["accessors"][at]["max"] = {high.x(), high.y(), high.z()};
  attributes["POSITION"] = at;
  attributes["NORMAL"] = add_accessor(normals, 4, kByte, "VEC3", count, true, kVertices);
  if (coloured) {
    attributes["COLOR_0"] =
        add_accessor(colours, cards ? 4 : 8, cards ? kUnsignedByte : kUnsignedShort, "VEC3", count,
                     true, kVertices);
  }
  if (cards) {
    attributes["TEXCOORD_0"] = add_accessor(uvs, 4, kUnsignedByte, "VEC2", count, true, kVertices);
  }

  // 0xFFFF restarts a strip and is not a valid index.
  const bool fits = count <= std::numeric_limits<std::uint16_t>::max();
  std::string corners;
  for (const std::uint32_t i : mesh.indices) {
    if (fits) {
      append_values(corners, {static_cast<std::uint16_t>(i)});
    } else {
      append_values(corners, {i});
    }
  }
  const int indices = add_accessor(corners, 0, fits ? kUnsignedShort : kUnsignedInt, "SCALAR",
                                   mesh.indices.size(), false, kIndices);
  root_["meshes"].push_back({{"name", name},
                             {"primitives", json::array({{{"attributes", attributes},
                                                          {"indices", indices},
                                                          {"material", material},
                                                          {"mode", kTriangles}}})}});
  return static_cast<int>(root_["meshes"].size()) - 1;
}

int GlbScene::add_node(const std::string& name, int mesh, const Pose& X_PM, json extras,
                       int parent) {
  const Placement& placement = placements_.at(static_cast<std::size_t>(mesh));
  json node = {{"name", name},
               {"mesh", mesh},
               {"translation", rounded_array_of(X_PM * placement.centre_M)},
               {"rotation", rotation_of(X_PM.q)},
               {"scale", uniform_scale(placement.step_m)}};
  if (!extras.is_null()) node["extras"] = std::move(extras);
  root_["nodes"].push_back(std::move(node));
  const int index = static_cast<int>(root_["nodes"].size()) - 1;
  root_["nodes"][std::max(parent, 0)]["children"].push_back(index);
  return index;
}

int GlbScene::add_frame(const std::string& name, const Pose& X_PF, json extras) {
  json node = {
      {"name", name}, {"translation", rounded_array_of(X_PF.p)}, {"rotation", rotation_of(X_PF.q)}};
  if (!extras.is_null()) node["extras"] = std::move(extras);
  root_["nodes"].push_back(std::move(node));
  const int index = static_cast<int>(root_["nodes"].size()) - 1;
  root_["nodes"][0]["children"].push_back(index);
  return index;
}

std::string GlbScene::bytes() const {
  json root = root_;
  for (const char* list : {"materials", "meshes", "accessors", "bufferViews"}) {
    if (root[list].empty()) root.erase(list);  // the specification forbids empty lists
  }
  if (!data_.empty()) root["buffers"] = json::array({{{"byteLength", data_.size()}}});
  std::string text = root.dump();
  while (text.size() % 4 != 0) text += ' ';
  std::string bytes = "glTF";
  append_word(bytes, 2);
  append_word(bytes, 12 + 8 + text.size() + (data_.empty() ? 0 : 8 + data_.size()));
  append_word(bytes, text.size());
  bytes += "JSON" + text;
  if (!data_.empty()) {
    append_word(bytes, data_.size());
    bytes.append("BIN\0", 4);
    bytes += data_;
  }
  return bytes;
}

}  // namespace vinerow::tools
