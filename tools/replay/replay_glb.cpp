#include "tools/replay/replay_glb.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "engine/core/check.h"

namespace vinerow::tools {
namespace {

using io::GlbAttribute;
using io::GlbNumber;
using nlohmann::json;

constexpr double kMaxShort = 32767.0;

template <class T>
void append_values(std::string& bytes, std::initializer_list<T> values) {
  for (const T value : values) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
}

json corner_of(const Eigen::Vector3i& v) {
  return {v.x(), v.y(), v.z()};
}

/// Node with its position rounded to a micrometre and its rotation to the precision of float:
/// longer numbers would double a scene's text.
json node_at(const std::string& name, const Pose& X_PN, json extras) {
  json node = {{"name", name}};
  for (const double c : X_PN.p) node["translation"].push_back(1e-6 * std::round(1e6 * c));
  for (const double c : X_PN.q.coeffs()) node["rotation"].push_back(1e-8 * std::round(1e8 * c));
  if (!extras.is_null()) node["extras"] = std::move(extras);
  return node;
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
  root_["extensionsUsed"] = root_["extensionsRequired"] = {"KHR_mesh_quantization"};
}

int GlbScene::add_material(const Material& look, bool two_sided) {
  json entry = io::glb_material(look);
  if (two_sided || look.leaf_cards) entry["doubleSided"] = true;
  if (look.leaf_cards) entry["alphaMode"] = "MASK";
  return GlbWriter::add_material(std::move(entry));
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
  std::vector<GlbAttribute> attributes = {
      {"POSITION", "VEC3", GlbNumber::kShort, std::move(positions), false, corner_of(low),
       corner_of(high)},
      {"NORMAL", "VEC3", GlbNumber::kByte, std::move(normals), true, {}, {}}};
  if (coloured) {
    attributes.push_back({"COLOR_0",
                          "VEC3",
                          cards ? GlbNumber::kUnsignedByte : GlbNumber::kUnsignedShort,
                          std::move(colours),
                          true,
                          {},
                          {}});
  }
  if (cards) {
    attributes.push_back(
        {"TEXCOORD_0", "VEC2", GlbNumber::kUnsignedByte, std::move(uvs), true, {}, {}});
  }
  return GlbWriter::add_mesh(name, mesh.vertices.size(), attributes, mesh.indices, material);
}

int GlbScene::add_node(const std::string& name, int mesh, const Pose& X_PM, json extras,
                       int parent) {
  const Placement& placement = placements_.at(static_cast<std::size_t>(mesh));
  json node = node_at(name, {X_PM.q, X_PM * placement.centre_M}, std::move(extras));
  node["mesh"] = mesh;
  node["scale"] = json::array({placement.step_m, placement.step_m, placement.step_m});
  return GlbWriter::add_node(std::move(node), parent);
}

int GlbScene::add_frame(const std::string& name, const Pose& X_PF, json extras) {
  return GlbWriter::add_node(node_at(name, X_PF, std::move(extras)));
}

}  // namespace vinerow::tools
