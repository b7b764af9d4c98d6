#include "engine/io/meshes/mesh_writer.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <fstream>
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

constexpr std::string_view kThings = "element thing ";

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
  bytes += "property list uchar int vertex_indices\n";
  if (!mesh.things.empty()) {
    bytes += fmt::format("{}{}\nproperty uint first_triangle\n", kThings, mesh.things.size());
  }
  bytes += "end_header\n";

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
  bytes.append(reinterpret_cast<const char*>(mesh.things.data()),
               mesh.things.size() * sizeof mesh.things[0]);
  WholeFile out(file, "mesh file");
  out.write(kBeginning + digest_of(bytes) + "\n");
  out.write(bytes);
  out.finish();
}

std::vector<std::uint32_t> read_things(const std::filesystem::path& file) {
  // The header and the end alone: files have megabytes in between.
  constexpr std::size_t kHeaderBytes = 1024;
  std::ifstream in(file, std::ios::binary);
  std::string text(kHeaderBytes, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  const std::string_view header = std::string_view(text).substr(0, text.find("end_header\n"));
  const std::size_t at = header.find(kThings);
  if (at == std::string_view::npos) return {};
  std::size_t count = 0;
  const char* const digits = header.data() + at + kThings.size();
  std::from_chars(digits, header.data() + header.size(), count);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || count > size / sizeof(std::uint32_t)) return {};
  std::vector<std::uint32_t> things(count);
  const auto bytes = static_cast<std::streamsize>(count * sizeof(std::uint32_t));
  in.clear();
  in.seekg(-bytes, std::ios::end);
  in.read(reinterpret_cast<char*>(things.data()), bytes);
  return in.gcount() == bytes ? things : std::vector<std::uint32_t>{};
}

bool is_intact_ply(const std::filesystem::path& file) {
  const std::string text = read_bytes(file).value_or("");
  const std::size_t line_end = kBeginning.size() + 32;  // the digest's hexadecimal digits
  return text.size() > line_end && text.rfind(kBeginning, 0) == 0 && text[line_end] == '\n' &&
         text.substr(kBeginning.size(), 32) ==
             digest_of(std::string_view(text).substr(line_end + 1));
}

}  // namespace vinerow::io
