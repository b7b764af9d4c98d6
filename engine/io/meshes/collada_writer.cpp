#include "engine/io/meshes/collada_writer.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/math/srgb.h"

namespace vinerow::io {
namespace {

using Rgb8 = std::array<int, 3>;  ///< sRGB, 0 to 255

/// Triangles of each colour.
using TrianglesByColour = std::map<Rgb8, std::vector<std::array<std::uint32_t, 3>>>;

// Each colour is a material, and viewers draw materials one by one.
constexpr std::size_t kMaxColours = 256;

int byte_from_linear(double linear) {
  return static_cast<int>(std::lround(255.0 * srgb_from_linear(std::clamp(linear, 0.0, 1.0))));
}

TrianglesByColour split_by_colour(const TriangleMesh& mesh, const Material& material) {
  const bool has_colours = mesh.colours.size() == mesh.vertices.size();
  TrianglesByColour result;
  // Two bits make at most 64 colours, so this ends.
  for (int step = 1;; step *= 2) {
    result.clear();
    for (const auto& triangle : mesh.triangles) {
      if (std::ranges::any_of(triangle, [&](auto i) { return i >= mesh.vertices.size(); }))
        continue;
      Eigen::Vector3f colour = material.colour;
      if (has_colours) {
        const auto& tints = mesh.colours;
        colour = colour.cwiseProduct(
            (tints[triangle[0]] + tints[triangle[1]] + tints[triangle[2]]) / 3.0f);
      }
      Rgb8 rounded;
      for (int i = 0; i < 3; ++i) {
        rounded[static_cast<std::size_t>(i)] = byte_from_linear(colour[i]) / step * step + step / 2;
      }
      result[rounded].push_back(triangle);
    }
    if (result.size() <= kMaxColours) return result;
  }
}

/// Document with one geometry, in which each colour has a material.
class ColladaDocument {
 public:
  ColladaDocument(const TriangleMesh& mesh, const TrianglesByColour& colours) {
    xml_.PushHeader(false, true);
    open("COLLADA",
         {{"xmlns", "http://www.collada.org/2005/11/COLLADASchema"}, {"version", "1.4.1"}});
    add_asset();
    add_materials(colours);
    add_geometry(mesh, colours);
    add_scene(colours.size());
    close();
  }

  std::string text() const { return xml_.CStr(); }

 private:
  using Attributes = std::vector<std::pair<const char*, std::string>>;

  void open(const char* name, const Attributes& attributes = {}) {
    xml_.OpenElement(name);
    for (const auto& [key, value] : attributes) xml_.PushAttribute(key, value.c_str());
  }
  void close(int levels = 1) {
    for (int i = 0; i < levels; ++i) xml_.CloseElement();
  }
  void leaf(const char* name, const Attributes& attributes, const std::string& text = {}) {
    open(name, attributes);
    if (!text.empty()) xml_.PushText(text.c_str());
    close();
  }

  void add_asset() {
    open("asset");
    // The schema requires dates. A fixed one keeps the files of equal runs equal.
    leaf("created", {}, "2000-01-01T00:00:00Z");
    leaf("modified", {}, "2000-01-01T00:00:00Z");
    leaf("unit", {{"name", "meter"}, {"meter", "1"}});
    leaf("up_axis", {}, "Z_UP");
    close();
  }

  void add_materials(const TrianglesByColour& colours) {
    open("library_effects");
    std::size_t number = 0;
    for (const auto& [rgb, unused] : colours) {
      const std::string text =
          fmt::format("{:.5f} {:.5f} {:.5f} 1", rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0);
      open("effect", {{"id", fmt::format("effect_{}", number++)}});
      open("profile_COMMON");
      open("technique", {{"sid", "common"}});
      open("lambert");
      // Without it, RViz shows the sides that its lamp does not reach nearly black.
      open("ambient");
      leaf("color", {}, text);
      close();
      open("diffuse");
      leaf("color", {}, text);
      close(5);
    }
    close();
    open("library_materials");
    for (std::size_t i = 0; i < colours.size(); ++i) {
      open("material", {{"id", fmt::format("material_{}", i)}});
      leaf("instance_effect", {{"url", fmt::format("#effect_{}", i)}});
      close();
    }
    close();
  }

  void add_source(const std::string& id, std::span<const Eigen::Vector3f> vectors) {
    std::string numbers;
    for (const Eigen::Vector3f& v : vectors) {
      fmt::format_to(std::back_inserter(numbers), "{} {} {} ", v.x(), v.y(), v.z());
    }
    open("source", {{"id", id}});
    leaf("float_array", {{"id", id + "_array"}, {"count", std::to_string(3 * vectors.size())}},
         numbers);
    open("technique_common");
    open("accessor", {{"source", "#" + id + "_array"},
                      {"count", std::to_string(vectors.size())},
                      {"stride", "3"}});
    for (const char* axis : {"X", "Y", "Z"}) leaf("param", {{"name", axis}, {"type", "float"}});
    close(3);
  }

  void add_geometry(const TriangleMesh& mesh, const TrianglesByColour& colours) {
    const bool has_normals = mesh.normals.size() == mesh.vertices.size();
    open("library_geometries");
    open("geometry", {{"id", "shape"}});
    open("mesh");
    add_source("positions", mesh.vertices);
    if (has_normals) add_source("normals", mesh.normals);
    open("vertices", {{"id", "vertices"}});
    leaf("input", {{"semantic", "POSITION"}, {"source", "#positions"}});
    close();
    std::size_t number = 0;
    for (const auto& [rgb, triangles] : colours) {
      open("triangles", {{"material", fmt::format("symbol_{}", number++)},
                         {"count", std::to_string(triangles.size())}});
      leaf("input", {{"semantic", "VERTEX"}, {"source", "#vertices"}, {"offset", "0"}});
      if (has_normals) {
        leaf("input", {{"semantic", "NORMAL"}, {"source", "#normals"}, {"offset", "0"}});
      }
      std::string corners;
      for (const auto& t : triangles) {
        fmt::format_to(std::back_inserter(corners), "{} {} {} ", t[0], t[1], t[2]);
      }
      leaf("p", {}, corners);
      close();
    }
    close(3);
  }

  void add_scene(std::size_t colours) {
    open("library_visual_scenes");
    open("visual_scene", {{"id", "scene"}});
    open("node", {{"id", "node"}});
    open("instance_geometry", {{"url", "#shape"}});
    open("bind_material");
    open("technique_common");
    for (std::size_t i = 0; i < colours; ++i) {
      leaf("instance_material",
           {{"symbol", fmt::format("symbol_{}", i)}, {"target", fmt::format("#material_{}", i)}});
    }
    close(6);
    open("scene");
    leaf("instance_visual_scene", {{"url", "#scene"}});
    close();
  }

  tinyxml2::XMLPrinter xml_;
};

}  // namespace

void write_collada(const TriangleMesh& mesh, const Material& material,
                   const std::filesystem::path& file) {
  const auto is_finite = [](const Eigen::Vector3f& v) { return v.allFinite(); };
  if (!std::ranges::all_of(mesh.vertices, is_finite) ||
      !std::ranges::all_of(mesh.normals, is_finite)) {
    throw ConfigError(
        fmt::format("mesh file '{}': a vertex is not finite, it is not written", file.string()));
  }
  const TrianglesByColour colours = split_by_colour(mesh, material);
  if (colours.empty()) {
    throw ConfigError(fmt::format("mesh file '{}': no triangles to write", file.string()));
  }
  write_whole_file(file, ColladaDocument(mesh, colours).text(), "mesh file");
}

}  // namespace vinerow::io
