#include "engine/io/meshes/mesh_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/io/clouds/ply_header.h"
#include "engine/io/files/block_file.h"
#include "engine/io/meshes/polygon_triangles.h"

namespace vinerow::io {
namespace {

/// Triangulating a polygon takes at least quadratic time in its corners.
constexpr std::size_t kMaxCorners = 1'000;
/// Indices have 32 bits.
constexpr std::uint64_t kMaxVertices = std::numeric_limits<std::uint32_t>::max();

/// Sequential reader of the rows of a PLY file's elements.
class PlyRows {
 public:
  explicit PlyRows(const std::filesystem::path& path)
      : file(path, FileKind::kMesh), header(read_ply_header(file)) {}

  /// Prepares for the rows of an element.
  void begin(const PlyElement& element) {
    element_ = &element;
    row_ = 0;
    numbers.assign(element.properties.size(), 0.0);
    lists.resize(element.properties.size());
    row_bytes_ = 0;
    for (const PlyProperty& property : element.properties) {
      row_bytes_ += size_of(property.type);
      if (property.list_count_type) {
        row_bytes_ = 0;
        break;
      }
    }
  }

  /// Maximum number of rows in the rest of the file, as a bound for reserved memory.
  std::size_t max_rows() const {
    // In text, a number takes at least a digit and a separator.
    std::uint64_t bytes = 0;
    for (const PlyProperty& p : element_->properties) {
      bytes += header.ascii ? 2 : size_of(p.list_count_type.value_or(p.type));
    }
    return static_cast<std::size_t>(
        std::min(element_->count, file.remaining() / std::max<std::uint64_t>(bytes, 1) + 1));
  }

  /// Reads the next row into `numbers` and `lists`. @returns false after the last
  bool next() {
    // An element without properties takes no bytes for any count.
    if (row_ == element_->count || element_->properties.empty()) return false;
    if (header.ascii) {
      read_text();
    } else {
      read_binary();
    }
    ++row_;
    return true;
  }

  /// Checks that nothing follows the last element.
  void expect_end() {
    std::string_view line;
    if (header.ascii ? next_line(file, &line) : file.remaining() > 0) {
      file.fail("has more data than its header counts");
    }
  }

  std::uint64_t row() const { return row_; }  ///< of the last next(), from 1

  BlockFile file;
  const PlyHeader header;
  std::vector<double> numbers;             ///< by property; 0 for lists
  std::vector<std::vector<double>> lists;  ///< by property; empty for numbers

 private:
  [[noreturn]] void fail_cut_off() const {
    file.fail(fmt::format("is cut off: element {} {} of {} is incomplete", element_->name, row_ + 1,
                          element_->count));
  }

  void read_binary() {
    // Taking the bytes of a row at once is most of the speed.
    if (row_bytes_ > 0 && row_bytes_ <= BlockFile::kBytes) {
      const std::uint8_t* bytes = file.take(row_bytes_);
      if (bytes == nullptr) fail_cut_off();
      for (std::size_t k = 0; k < element_->properties.size(); ++k) {
        const Scalar type = element_->properties[k].type;
        numbers[k] = value_at(type, bytes);
        bytes += size_of(type);
      }
      return;
    }
    for (std::size_t k = 0; k < element_->properties.size(); ++k) {
      const PlyProperty& property = element_->properties[k];
      if (!property.list_count_type) {
        numbers[k] = take(property.type);
        continue;
      }
      const double count = take(*property.list_count_type);
      const std::size_t size = size_of(property.type);
      check_count(property, count);
      if (count > static_cast<double>(file.remaining() / size)) fail_cut_off();
      lists[k].resize(static_cast<std::size_t>(count));
      if (size * lists[k].size() > BlockFile::kBytes) {
        for (double& value : lists[k]) value = take(property.type);
        continue;
      }
      const std::uint8_t* bytes = file.take(size * lists[k].size());
      if (bytes == nullptr) fail_cut_off();
      for (double& value : lists[k]) {
        value = value_at(property.type, bytes);
        bytes += size;
      }
    }
  }
  double value_at(Scalar type, const std::uint8_t* bytes) const {
    // The usual types of vertices and faces, in this machine's order.
    if (header.order == std::endian::native) {
      if (type == Scalar::kF32) return native<float>(bytes);
      if (type == Scalar::kI32) return native<std::int32_t>(bytes);
      if (type == Scalar::kU32) return native<std::uint32_t>(bytes);
    }
    return load(type, bytes, header.order);
  }
  template <class T>
  static double native(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  double take(Scalar type) {
    const std::uint8_t* bytes = file.take(size_of(type));
    if (bytes == nullptr) fail_cut_off();
    return load(type, bytes, header.order);
  }

  void read_text() {
    std::string_view line;
    if (!next_line(file, &line)) fail_cut_off();
    for (std::size_t k = 0; k < element_->properties.size(); ++k) {
      const PlyProperty& property = element_->properties[k];
      const double value = number_in(file, next_word(&line), property.name);
      if (!property.list_count_type) {
        numbers[k] = value;
        continue;
      }
      check_count(property, value);
      lists[k].clear();
      for (double left = value; left > 0.0; left -= 1.0) {
        lists[k].push_back(number_in(file, next_word(&line), property.name));
      }
    }
    if (!next_word(&line).empty()) {
      file.fail(
          fmt::format("has more numbers in line {} than its header names", file.line_number()));
    }
  }
  void check_count(const PlyProperty& property, double count) const {
    if (count >= 0.0 && count == std::floor(count)) return;
    file.fail(fmt::format("has a list '{}' of {} values in {} {}, must be a whole number >= 0",
                          property.name, count, element_->name, row_ + 1));
  }

  const PlyElement* element_ = nullptr;
  std::size_t row_bytes_ = 0;  ///< of a binary row; 0: it has lists
  std::uint64_t row_ = 0;
};

/// Index of a property by any of its names, if it is a list or a number as requested.
std::optional<std::size_t> find(const PlyElement& element,
                                std::initializer_list<std::string_view> names, bool is_list) {
  for (std::size_t k = 0; k < element.properties.size(); ++k) {
    const PlyProperty& property = element.properties[k];
    if (property.list_count_type.has_value() != is_list) continue;
    if (std::find(names.begin(), names.end(), property.name) != names.end()) return k;
  }
  return std::nullopt;
}

/// Indices of several properties, or nullopt unless all exist.
template <std::size_t N>
std::optional<std::array<std::size_t, N>> find_all(const PlyElement& element,
                                                   const std::array<std::string_view, N>& names) {
  std::array<std::size_t, N> places;
  for (std::size_t k = 0; k < N; ++k) {
    const auto place = find(element, {names[k]}, false);
    if (!place) return std::nullopt;
    places[k] = *place;
  }
  return places;
}

class PlyMeshReader {
 public:
  explicit PlyMeshReader(const std::filesystem::path& path) : rows_(path) {}

  PlyMesh read() {
    for (const PlyElement& element : rows_.header.elements) {
      rows_.begin(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "tristrips") {
        read_strips(element);
      } else {
        while (rows_.next()) {
        }
      }
    }
    rows_.expect_end();
    if (!has_vertices_) rows_.file.fail("has no element 'vertex'");
    // Faces may precede the vertices, so they are resolved after all elements are read.
    for (const Face& face : faces_) add_face(face);
    for (const std::string& comment : rows_.header.comments) {
      std::string_view rest = comment;
      if (next_word(&rest) != "TextureFile") continue;
      while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
      while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
      result_.texture = rest;
      break;
    }
    return std::move(result_);
  }

 private:
  /// Face with the corners [begin, begin + count) of corners_ and, if has_uv, of corner_uvs_.
  struct Face {
    std::size_t begin = 0, uv_begin = 0;
    std::uint32_t count = 0;
    bool has_uv = false;
    std::uint64_t number = 0;  // number in the file, from 1
    const char* element = "face";
  };

  void read_vertices(const PlyElement& element) {
    if (has_vertices_) rows_.file.fail("has the element 'vertex' twice");
    has_vertices_ = true;
    const auto xyz = find_all<3>(element, {"x", "y", "z"});
    if (!xyz) rows_.file.fail("has vertices without x, y and z");
    const auto normal = find_all<3>(element, {"nx", "ny", "nz"});
    auto uv = find_all<2>(element, {"s", "t"});
    if (!uv) uv = find_all<2>(element, {"u", "v"});
    if (!uv) uv = find_all<2>(element, {"texture_u", "texture_v"});
    auto rgb = find_all<3>(element, {"red", "green", "blue"});
    if (!rgb) rgb = find_all<3>(element, {"diffuse_red", "diffuse_green", "diffuse_blue"});
    double full = 1.0;
    if (rgb) {
      const Scalar type = element.properties[rgb->front()].type;
      result_.linear_colours = is_real(type);
      if (type == Scalar::kU8) full = 255.0;
      if (type == Scalar::kU16) full = 65535.0;
      if (!is_real(type) && full == 1.0) {
        rgb.reset();
        result_.notes.push_back(
            fmt::format("{}: its colours are not used: they must be uchar, ushort, float or double",
                        rows_.file.name().string()));
      }
    }
    TriangleMesh& mesh = result_.mesh;
    const std::size_t max_vertices = rows_.max_rows();
    if (max_vertices > kMaxVertices) {
      rows_.file.fail(fmt::format("has more than {} vertices", kMaxVertices));
    }
    mesh.vertices.reserve(max_vertices);
    if (normal) mesh.normals.reserve(max_vertices);
    if (uv) mesh.uvs.reserve(max_vertices);
    if (rgb) mesh.colours.reserve(max_vertices);
    const auto vector_at = [&](const std::array<std::size_t, 3>& at) {
      const std::vector<double>& n = rows_.numbers;
      return Eigen::Vector3d(n[at[0]], n[at[1]], n[at[2]]);
    };
    while (rows_.next()) {
      mesh.vertices.push_back(vector_at(*xyz).cast<float>());
      if (normal) mesh.normals.push_back(vector_at(*normal).cast<float>());
      if (uv) {
        mesh.uvs.emplace_back(static_cast<float>(rows_.numbers[(*uv)[0]]),
                              static_cast<float>(rows_.numbers[(*uv)[1]]));
      }
      if (rgb) {
        mesh.colours.push_back(vector_at(*rgb).cast<float>() / static_cast<float>(full));
      }
    }
  }

  std::size_t indices_of(const PlyElement& element) const {
    const auto place = find(element, {"vertex_indices", "vertex_index"}, true);
    if (!place) {
      rows_.file.fail(
          fmt::format("has the element '{}' without a list vertex_indices", element.name));
    }
    return *place;
  }

  void read_faces(const PlyElement& element) {
    const std::size_t at = indices_of(element);
    const auto uv_at = find(element, {"texcoord"}, true);
    faces_.reserve(faces_.size() + rows_.max_rows());
    while (rows_.next()) {
      const std::vector<double>& corners = rows_.lists[at];
      if (corners.size() < 3) continue;  // points and lines
      if (corners.size() > kMaxCorners) {
        rows_.file.fail(fmt::format("has a face of {} corners, face {}; at most {} are allowed",
                                    corners.size(), rows_.row(), kMaxCorners));
      }
      Face face;
      face.begin = corners_.size();
      face.count = static_cast<std::uint32_t>(corners.size());
      face.number = rows_.row();
      corners_.insert(corners_.end(), corners.begin(), corners.end());
      if (uv_at && rows_.lists[*uv_at].size() == 2 * corners.size()) {
        face.has_uv = true;
        face.uv_begin = corner_uvs_.size();
        const std::vector<double>& uvs = rows_.lists[*uv_at];
        for (std::size_t k = 0; k < uvs.size(); k += 2) {
          corner_uvs_.emplace_back(static_cast<float>(uvs[k]), static_cast<float>(uvs[k + 1]));
        }
      }
      faces_.push_back(face);
    }
  }

  /// A strip a b c d e has the triangles abc, cbd, cde: every second one has the opposite order.
  void read_strips(const PlyElement& element) {
    const std::size_t at = indices_of(element);
    while (rows_.next()) {
      const std::vector<double>& strip = rows_.lists[at];
      std::size_t since = 0;
      for (std::size_t k = 0; k < strip.size(); ++k) {
        since = strip[k] == -1.0 ? 0 : since + 1;
        if (since < 3) continue;
        const bool turned = since % 2 == 0;
        Face face;
        face.begin = corners_.size();
        face.count = 3;
        face.number = rows_.row();
        face.element = "strip";
        corners_.push_back(strip[turned ? k - 1 : k - 2]);
        corners_.push_back(strip[turned ? k - 2 : k - 1]);
        corners_.push_back(strip[k]);
        faces_.push_back(face);
      }
    }
  }

  void add_face(const Face& face) {
    const std::size_t vertices = vertex_count();
    polygon_.clear();
    for (std::size_t k = 0; k < face.count; ++k) {
      const double index = corners_[face.begin + k];
      if (!(index >= 0.0 && index < static_cast<double>(vertices)) || index != std::floor(index)) {
        rows_.file.fail(fmt::format("is broken: {} {} names vertex {}, it has {} (0 to {})",
                                    face.element, face.number, index, vertices,
                                    vertices == 0 ? 0 : vertices - 1));
      }
      auto vertex = static_cast<std::uint32_t>(index);
      if (face.has_uv) vertex = vertex_with(vertex, corner_uvs_[face.uv_begin + k]);
      polygon_.push_back(vertex);
    }
    triangulate_polygon(result_.mesh.vertices, polygon_, result_.mesh.triangles);
  }

  std::size_t vertex_count() {
    if (!file_vertices_) file_vertices_ = result_.mesh.vertices.size();
    return *file_vertices_;
  }

  /// The vertex itself, or a copy of it with the corner's texture coordinates.
  std::uint32_t vertex_with(std::uint32_t vertex, const Eigen::Vector2f& uv) {
    TriangleMesh& mesh = result_.mesh;
    if (own_uvs_.empty()) {
      own_uvs_.resize(*file_vertices_, false);
      mesh.uvs.assign(*file_vertices_, Eigen::Vector2f::Zero());
    }
    if (!own_uvs_[vertex]) {
      own_uvs_[vertex] = true;
      mesh.uvs[vertex] = uv;
      return vertex;
    }
    if (mesh.uvs[vertex] == uv) return vertex;
    const std::array<std::uint32_t, 3> key = {vertex, std::bit_cast<std::uint32_t>(uv.x()),
                                              std::bit_cast<std::uint32_t>(uv.y())};
    const auto [found, is_new] =
        copies_.try_emplace(key, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      if (mesh.vertices.size() >= kMaxVertices) {
        rows_.file.fail(fmt::format("has more than {} vertices", kMaxVertices));
      }
      const auto repeat = [&](auto& list) {
        const auto value = list[vertex];
        list.push_back(value);
      };
      repeat(mesh.vertices);
      if (!mesh.normals.empty()) repeat(mesh.normals);
      if (!mesh.colours.empty()) repeat(mesh.colours);
      mesh.uvs.push_back(uv);
    }
    return found->second;
  }

  PlyRows rows_;
  PlyMesh result_;
  bool has_vertices_ = false;
  std::optional<std::size_t> file_vertices_;  // number in the file, without copies
  std::vector<Face> faces_;
  std::vector<double> corners_;  // as written
  std::vector<Eigen::Vector2f> corner_uvs_;
  std::vector<std::uint32_t> polygon_;
  std::vector<bool> own_uvs_;  // by vertex: its texture coordinates are set
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> copies_;
};

}  // namespace

PlyMesh read_ply_mesh(const std::filesystem::path& file) {
  return PlyMeshReader(file).read();
}

void join_equal_vertices(TriangleMesh& mesh) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value + 0.0f); };
  const auto key_of = [&](std::uint32_t v) {
    std::array<std::uint32_t, 11> key{};
    std::size_t n = 0;
    const auto add = [&](const auto& list) {
      if (list.empty()) return;
      for (const float value : list[v]) key[n++] = bits(value);
    };
    add(mesh.vertices);
    add(mesh.normals);
    add(mesh.uvs);
    add(mesh.colours);
    return key;
  };
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto key_a = key_of(a), key_b = key_of(b);
    return key_a != key_b ? key_a < key_b : a < b;
  });
  std::vector<std::uint32_t> first(mesh.vertices.size(), kNone);  // equal vertex of lowest index
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool is_same = k > 0 && key_of(order[k]) == key_of(order[k - 1]);
    first[order[k]] = is_same ? first[order[k - 1]] : order[k];
  }
  std::vector<bool> used(mesh.vertices.size(), false);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      corner = first[corner];
      used[corner] = true;
    }
  }
  std::vector<std::uint32_t> place(mesh.vertices.size(), kNone);
  std::uint32_t count = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) continue;
    const auto keep = [&](auto& list) {
      if (!list.empty()) list[count] = list[v];
    };
    keep(mesh.vertices);
    keep(mesh.normals);
    keep(mesh.uvs);
    keep(mesh.colours);
    place[v] = count++;
  }
  const auto cut = [&](auto& list) {
    if (!list.empty()) list.resize(count);
  };
  cut(mesh.vertices);
  cut(mesh.normals);
  cut(mesh.uvs);
  cut(mesh.colours);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = place[corner];
  }
}

}  // namespace vinerow::io
