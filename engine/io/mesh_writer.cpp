#include "engine/io/mesh_writer.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <fstream>

#include "engine/core/check.h"
#include "engine/core/error.h"

namespace vinerow::io {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the PLY writer copies memory as little-endian");

template <int N>
void append(std::string& bytes, const Eigen::Matrix<float, N, 1>& value) {
  const std::size_t size = sizeof(float) * N;
  bytes.append(reinterpret_cast<const char*>(value.data()), size);
}

}  // namespace

void write_ply(const TriangleMesh& mesh, const std::filesystem::path& file,
               const std::string& comment) {
  const std::size_t count = mesh.vertices.size();
  const bool normals = !mesh.normals.empty(), uvs = !mesh.uvs.empty();
  const bool colours = !mesh.colours.empty();
  VINEROW_DEMAND(!normals || mesh.normals.size() == count);
  VINEROW_DEMAND(!uvs || mesh.uvs.size() == count);
  VINEROW_DEMAND(!colours || mesh.colours.size() == count);

  std::string bytes = "ply\nformat binary_little_endian 1.0\n";
  if (!comment.empty()) bytes += "comment " + comment + "\n";
  bytes += fmt::format("element vertex {}\n", count);
  bytes += "property float x\nproperty float y\nproperty float z\n";
  if (normals) bytes += "property float nx\nproperty float ny\nproperty float nz\n";
  if (uvs) bytes += "property float s\nproperty float t\n";
  if (colours) bytes += "property float red\nproperty float green\nproperty float blue\n";
  bytes += fmt::format("element face {}\n", mesh.triangles.size());
  bytes += "property list uchar int vertex_indices\nend_header\n";

  bytes.reserve(bytes.size() + count * 44 + mesh.triangles.size() * 13);
  for (std::size_t i = 0; i < count; ++i) {
    append<3>(bytes, mesh.vertices[i]);
    if (normals) append<3>(bytes, mesh.normals[i]);
    if (uvs) append<2>(bytes, mesh.uvs[i]);
    if (colours) append<3>(bytes, mesh.colours[i]);
  }
  for (const auto& t : mesh.triangles) {
    bytes += '\3';
    bytes.append(reinterpret_cast<const char*>(t.data()), sizeof t);
  }
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw ConfigError(fmt::format("mesh file '{}' cannot be written", file.string()));
}

std::string read_ply_comment(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string kComment = "comment ";
  for (std::string line; std::getline(stream, line) && line != "end_header";) {
    if (line.rfind(kComment, 0) == 0) return line.substr(kComment.size());
  }
  return "";
}

}  // namespace vinerow::io
