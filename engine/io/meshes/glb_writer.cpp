#include "engine/io/meshes/glb_writer.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace vinerow::io {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little,
              "the glTF writer copies memory as little-endian");

// Constants of the specification: primitive modes, buffer view targets.
constexpr int kTriangles = 4, kVertices = 34962, kIndices = 34963;
constexpr const char* kLists[] = {"materials", "meshes", "accessors", "bufferViews"};

void append_word(std::string& bytes, std::size_t number) {
  const auto word = static_cast<std::uint32_t>(number);
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

int append_to(json& list, json entry) {
  list.push_back(std::move(entry));
  return static_cast<int>(list.size()) - 1;
}

}  // namespace

GlbWriter::GlbWriter() {
  root_["asset"] = {{"version", "2.0"}, {"generator", "Vinerow"}};
  root_["scene"] = 0;
  root_["scenes"] = json::array({{{"nodes", {0}}}});
  // Rotation by -90 degrees about x: z up becomes y up.
  constexpr double kHalf = 0.70710678118654752;
  root_["nodes"] = json::array({{{"name", "z_up"}, {"rotation", {-kHalf, 0.0, 0.0, kHalf}}}});
  for (const char* list : kLists) root_[list] = json::array();
}

int GlbWriter::add_material(json material) {
  json& materials = root_["materials"];
  const auto found = std::find(materials.begin(), materials.end(), material);
  if (found != materials.end()) return static_cast<int>(found - materials.begin());
  return append_to(materials, std::move(material));
}

int GlbWriter::add_accessor(const std::string& bytes, json view, json accessor) {
  view["buffer"] = 0;
  view["byteOffset"] = data_.size();
  view["byteLength"] = bytes.size();
  accessor["bufferView"] = append_to(root_["bufferViews"], std::move(view));
  data_ += bytes;
  while (data_.size() % 4 != 0) data_ += '\0';
  return append_to(root_["accessors"], std::move(accessor));
}

int GlbWriter::add_mesh(const std::string& name, std::size_t vertices,
                        std::span<const GlbAttribute> attributes,
                        std::span<const std::uint32_t> corners, int material) {
  json places;
  for (const GlbAttribute& attribute : attributes) {
    json accessor = {
        {"componentType", attribute.number}, {"count", vertices}, {"type", attribute.type}};
    if (attribute.normalised) accessor["normalized"] = true;
    if (!attribute.low.is_null()) accessor["min"] = attribute.low;
    if (!attribute.high.is_null()) accessor["max"] = attribute.high;
    const std::size_t stride = attribute.bytes.size() / vertices;
    places[attribute.name] =
        add_accessor(attribute.bytes, {{"target", kVertices}, {"byteStride", stride}}, accessor);
  }
  // The largest 16-bit number means primitive restart and is not a valid index.
  const bool fits = vertices <= std::numeric_limits<std::uint16_t>::max();
  std::string bytes;
  for (const std::uint32_t corner : corners) {
    // The lower two of its little-endian bytes, or all.
    bytes.append(reinterpret_cast<const char*>(&corner), fits ? 2 : 4);
  }
  const GlbNumber number = fits ? GlbNumber::kUnsignedShort : GlbNumber::kUnsignedInt;
  const int indices =
      add_accessor(bytes, {{"target", kIndices}},
                   {{"componentType", number}, {"count", corners.size()}, {"type", "SCALAR"}});
  const json triangles = {
      {"attributes", places}, {"indices", indices}, {"material", material}, {"mode", kTriangles}};
  return append_to(root_["meshes"], {{"name", name}, {"primitives", json::array({triangles})}});
}

int GlbWriter::add_node(json node, int parent) {
  const int index = append_to(root_["nodes"], std::move(node));
  root_["nodes"][parent]["children"].push_back(index);
  return index;
}

std::string GlbWriter::bytes() const {
  json root = root_;
  for (const char* list : kLists) {
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

json glb_material(const Material& look) {
  return {{"name", look.name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {look.colour.x(), look.colour.y(), look.colour.z(), 1.0}},
            {"metallicFactor", 0.0},
            {"roughnessFactor", look.roughness}}}};
}

}  // namespace vinerow::io
