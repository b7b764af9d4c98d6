#include "engine/io/meshes/mesh_writer.h"

#include <fmt/format.h>

#include <bit>
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

  std::string bytes = fmt::format("element vertex {}\n", count);
  bytes += "property float x\nproperty float y\nproperty float z\n";
  if (normals) bytes += "property float nx\nproperty float ny\nproperty float nz\n";
  if (uvs) bytes += "property float s\nproperty float t\n";
  if (colours) bytes += "property float red\nproperty float green\nproperty float blue\n";
  bytes += fmt::format("element face {}\n", mesh.triangles.size());
  bytes += "property list uchar int vertex_indices\nend_header\n";

  bytes.reserve(bytes.size() + count * 44 + mesh.triangles.size() * 13);
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
  WholeFile out(file, "mesh file");
  out.write(kBeginning + digest_of(bytes) + "\n");
  out.write(bytes);
  out.finish();
}

bool is_intact_ply(const std::filesystem::path& file) {
  const std::string text = read_bytes(file).value_or("");
  const std::size_t line_end = kBeginning.size() + 32;  // the digest's hexadecimal digits
  return text.size() > line_end && text.rfind(kBeginning, 0) == 0 && text[line_end] == '\n' &&
         text.substr(kBeginning.size(), 32) ==
             digest_of(std::string_view(text).substr(line_end + 1));
}

}  // namespace vinerow::io
