#include "engine/io/meshes/mesh_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <string>
#include <string_view>

#include "engine/api/mesh.h"
#include "engine/core/check.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/whole_file.h"

namespace vinerow::io {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the PLY writer copies memory as little-endian");

template <int N>
void append_floats(std::string& bytes, const Eigen::Matrix<float, N, 1>& value) {
  const std::size_t size = sizeof(float) * N;
  bytes.append(reinterpret_cast<const char*>(value.data()), size);
}

const std::string kBeginning = "ply\nformat binary_little_endian 1.0\ncomment vinerow mesh ";

/// What the header of a file states.
struct PlyLayout {
  std::size_t vertices = 0, triangles = 0, things = 0;
  bool normals = false, uvs = false, colours = false;

  std::size_t vertex_bytes() const {
    const int floats = 3 + (normals ? 3 : 0) + (uvs ? 2 : 0) + (colours ? 3 : 0);
    return sizeof(float) * static_cast<std::size_t>(floats);
  }
  std::size_t body_bytes() const {
    return vertices * vertex_bytes() + triangles * kTriangleBytes + things * sizeof(std::uint32_t);
  }
  static constexpr std::size_t kTriangleBytes = 1 + 3 * sizeof(std::uint32_t);
};

constexpr std::string_view kPlyVertices = "element vertex ", kPlyTriangles = "element face ",
                           kPlyThings = "element thing ", kPlyEnd = "end_header\n",
                           kPlyNormals =
                               "property float nx\nproperty float ny\nproperty float nz\n",
                           kPlyUvs = "property float s\nproperty float t\n",
                           kPlyColours =
                               "property float red\nproperty float green\nproperty float blue\n";

/// The header after its first lines.
std::string header_of(const PlyLayout& layout) {
  std::string text = fmt::format("{}{}\n", kPlyVertices, layout.vertices);
  text += "property float x\nproperty float y\nproperty float z\n";
  if (layout.normals) text += kPlyNormals;
  if (layout.uvs) text += kPlyUvs;
  if (layout.colours) text += kPlyColours;
  text += fmt::format("{}{}\n", kPlyTriangles, layout.triangles);
  text += "property list uchar int vertex_indices\n";
  if (layout.things > 0) {
    text += fmt::format("{}{}\nproperty uint first_triangle\n", kPlyThings, layout.things);
  }
  return text.append(kPlyEnd);
}

/// The layout whose header this is; nothing for a header that header_of() does not write.
std::optional<PlyLayout> layout_of(std::string_view header) {
  const auto count_after = [&](std::string_view element) {
    std::size_t count = 0;
    const std::size_t at = header.find(element);
    if (at == std::string_view::npos) return count;
    std::from_chars(header.data() + at + element.size(), header.data() + header.size(), count);
    return count;
  };
  const auto has = [&](std::string_view lines) {
    return header.find(lines) != std::string_view::npos;
  };
  const PlyLayout layout{count_after(kPlyVertices),
                         count_after(kPlyTriangles),
                         count_after(kPlyThings),
                         has(kPlyNormals),
                         has(kPlyUvs),
                         has(kPlyColours)};
  return header_of(layout) == header ? std::optional(layout) : std::nullopt;
}

/// Copies the next value and moves on.
template <class T>
void take_value(const char*& bytes, T& value) {
  std::memcpy(static_cast<void*>(&value), bytes, sizeof value);
  bytes += sizeof value;
}

std::string digest_of(std::string_view bytes) {
  Hasher hasher;
  hasher.add_bytes(bytes.data(), bytes.size());
  return hasher.hex();
}

}  // namespace

void write_ply(const TriangleMesh& mesh, const std::filesystem::path& file) {
  const std::size_t count = mesh.vertices.size();
  const bool normals = !mesh.normals.empty(), uvs = !mesh.uvs.empty();
  const bool colours = !mesh.colours.empty();
  VINEROW_DEMAND(!normals || mesh.normals.size() == count);
  VINEROW_DEMAND(!uvs || mesh.uvs.size() == count);
  VINEROW_DEMAND(!colours || mesh.colours.size() == count);

  const PlyLayout layout{count, mesh.triangles.size(), mesh.things.size(), normals, uvs, colours};
  std::string bytes = header_of(layout);
  bytes.reserve(bytes.size() + layout.body_bytes());
  for (std::size_t i = 0; i < count; ++i) {
    append_floats<3>(bytes, mesh.vertices[i]);
    if (normals) append_floats<3>(bytes, mesh.normals[i]);
    if (uvs) append_floats<2>(bytes, mesh.uvs[i]);
    if (colours) append_floats<3>(bytes, mesh.colours[i]);
  }
  for (const auto& t : mesh.triangles) {
    bytes += '\3';
    bytes.append(reinterpret_cast<const char*>(t.data()), sizeof t);
  }
  bytes.append(reinterpret_cast<const char*>(mesh.things.data()),
               mesh.things.size() * sizeof mesh.things[0]);
  WholeFile out(file, "mesh file");
  out.write(kBeginning + digest_of(bytes) + "\n");
  out.write(bytes);
  out.finish();
}

std::optional<TriangleMesh> read_intact_ply(const std::filesystem::path& file) {
  const std::string text = read_bytes(file).value_or("");
  const std::size_t line_end = kBeginning.size() + 32;  // the digest's hexadecimal digits
  if (text.size() <= line_end || !text.starts_with(kBeginning) || text[line_end] != '\n') {
    return std::nullopt;
  }
  const std::string_view rest = std::string_view(text).substr(line_end + 1);
  if (text.compare(kBeginning.size(), 32, digest_of(rest)) != 0) return std::nullopt;
  const std::size_t header_bytes = rest.find(kPlyEnd) + kPlyEnd.size();
  const std::optional<PlyLayout> layout = layout_of(rest.substr(0, header_bytes));
  // Counts first: their products could overflow.
  if (!layout || std::max({layout->vertices, layout->triangles, layout->things}) > rest.size() ||
      rest.size() - header_bytes != layout->body_bytes()) {
    return std::nullopt;
  }

  TriangleMesh mesh;
  mesh.vertices.resize(layout->vertices);
  if (layout->normals) mesh.normals.resize(layout->vertices);
  if (layout->uvs) mesh.uvs.resize(layout->vertices);
  if (layout->colours) mesh.colours.resize(layout->vertices);
  mesh.triangles.resize(layout->triangles);
  mesh.things.resize(layout->things);
  const char* bytes = rest.data() + header_bytes;
  for (std::size_t i = 0; i < layout->vertices; ++i) {
    take_value(bytes, mesh.vertices[i]);
    if (layout->normals) take_value(bytes, mesh.normals[i]);
    if (layout->uvs) take_value(bytes, mesh.uvs[i]);
    if (layout->colours) take_value(bytes, mesh.colours[i]);
  }
  for (auto& triangle : mesh.triangles) {
    ++bytes;  // the number of corners
    take_value(bytes, triangle);
  }
  for (std::uint32_t& first : mesh.things) take_value(bytes, first);
  return mesh;
}

}  // namespace vinerow::io
