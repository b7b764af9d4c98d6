#include "engine/render/scenery_meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/api/height_field.h"
#include "engine/api/mesh.h"
#include "engine/math/polygon.h"
#include "engine/render/noise.h"

namespace vinerow::render {

namespace {

/// Cross-section of a hedge from foot to foot: lateral as a share of half the width, up as a share
/// of the height above the lowest leaves.
struct SectionPoint {
  double side, up;
  double normal_side, normal_up;
  float v;
};
constexpr SectionPoint kSection[] = {{0.75, 0.0, 0.95, -0.3, -1.0f},
                                     {1.1, 0.6, 0.85, 0.5, -0.5f},
                                     {0.0, 1.0, 0.0, 1.0, 0.0f},
                                     {-1.1, 0.6, -0.85, 0.5, 0.5f},
                                     {-0.75, 0.0, -0.95, -0.3, 1.0f}};
constexpr int kSectionPoints = 5;
constexpr double kSectionStep_m = 12.0;  // the ground deviates by centimetres in between

struct HedgeRow {
  Eigen::Vector2d from, to;
  std::uint32_t number;
};

void add_row(const SceneryField& field, const HedgeRow& row, const HeightField& terrain,
             PreparedMesh& mesh) {
  const double length_m = (row.to - row.from).norm();
  const Eigen::Vector2d d = (row.to - row.from) / length_m;
  const Eigen::Vector3d left(-d.y(), d.x(), 0.0);
  const int steps = std::max(1, static_cast<int>(std::ceil(length_m / kSectionStep_m)));
  for (int k = 0; k <= steps + 2; ++k) {
    // Both ends are tapered.
    const bool is_end = k == 0 || k == steps + 2;
    const double s =
        std::clamp(length_m * (k - 1) / steps, 0.5, length_m - 0.5) + (k == 0           ? -0.5
                                                                       : k == steps + 2 ? 0.5
                                                                                        : 0.0);
    const Eigen::Vector2d p = row.from + s * d;
    const auto step = static_cast<std::uint32_t>(k);
    const double taper = is_end ? 0.35 : 1.0;
    const double half_m =
        0.72 * field.row_width_m * taper * (0.85 + 0.3 * hash01(row.number, step, 41));
    const double high_m = (field.row_top_m - field.row_base_m) * (is_end ? 0.75 : 1.0) *
                          (0.94 + 0.12 * hash01(row.number, step, 42));
    const double ground_m = terrain.height_m(p.x(), p.y());
    for (const SectionPoint& point : kSection) {
      const Eigen::Vector3d at =
          Eigen::Vector3d(p.x(), p.y(), ground_m + field.row_base_m + point.up * high_m) +
          point.side * half_m * left;
      const Eigen::Vector3d normal =
          (point.normal_side * left + Eigen::Vector3d(0, 0, point.normal_up)).normalized();
      GpuVertex vertex{};
      for (int c = 0; c < 3; ++c) {
        vertex.position[c] = static_cast<float>(at[c]);
        vertex.normal[c] = static_cast<std::int8_t>(std::lround(127.0 * normal[c]));
      }
      vertex.uv[0] = static_cast<float>(s);
      vertex.uv[1] = point.v;
      const Eigen::Vector3d colour = field.brightness * Eigen::Vector3d(0.092, 0.158, 0.040);
      for (int c = 0; c < 3; ++c) {
        vertex.colour[c] = static_cast<std::uint8_t>(std::lround(255.0 * std::sqrt(colour[c])));
      }
      vertex.colour[3] = static_cast<std::uint8_t>(hash_cell(row.number, 5u, 43u) & 0xffu);
      mesh.vertices.push_back(vertex);
      mesh.bounds_M.extend(at);
    }
    if (k == 0) continue;
    const auto end = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t i = 0; i + 1 < kSectionPoints; ++i) {
      const std::uint32_t b = end - kSectionPoints + i, a = b - kSectionPoints;
      mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
    }
  }
}

void add_curtain(const SceneryField& field, const HedgeRow& row, const HeightField& terrain,
                 PreparedMesh& mesh) {
  constexpr double kIntoLeaves = 0.2;  // share of the leaves' height
  const double top_m = field.row_base_m + kIntoLeaves * (field.row_top_m - field.row_base_m);
  const double length_m = (row.to - row.from).norm();
  const Eigen::Vector2d d = (row.to - row.from) / length_m;
  const int steps = std::max(1, static_cast<int>(std::ceil(length_m / kSectionStep_m)));
  for (int k = 0; k <= steps; ++k) {
    const double s = length_m * k / steps;
    const Eigen::Vector2d p = row.from + s * d;
    const double ground_m = terrain.height_m(p.x(), p.y());
    for (const double above_m : {-0.1, top_m}) {
      GpuVertex vertex{};
      const Eigen::Vector3d at(p.x(), p.y(), ground_m + above_m);
      for (int c = 0; c < 3; ++c) vertex.position[c] = static_cast<float>(at[c]);
      vertex.normal[0] = static_cast<std::int8_t>(std::lround(-127.0 * d.y()));
      vertex.normal[1] = static_cast<std::int8_t>(std::lround(127.0 * d.x()));
      vertex.uv[0] = static_cast<float>(s);
      vertex.colour[3] = static_cast<std::uint8_t>(hash_cell(row.number, 5u, 43u) & 0xffu);
      mesh.vertices.push_back(vertex);
      mesh.bounds_M.extend(at);
    }
    if (k == 0) continue;
    const auto end = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.indices.insert(mesh.indices.end(), {end - 4, end - 2, end - 3, end - 3, end - 2, end - 1});
  }
}

void add_leaf_card(TriangleMesh& mesh, const Eigen::Vector3d& middle, const Eigen::Vector3d& side,
                   const Eigen::Vector3d& up, const Eigen::Vector3d& normal,
                   const Eigen::Vector3d& colour) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 4; ++i) {
    const double u = i == 1 || i == 2 ? 1.0 : -1.0, v = i >= 2 ? 1.0 : -1.0;
    mesh.vertices.push_back((middle + u * side + v * up).cast<float>());
    mesh.uvs.emplace_back(static_cast<float>(0.5 + 0.5 * u), static_cast<float>(0.5 + 0.5 * v));
    mesh.normals.push_back(normal.cast<float>());
    mesh.colours.push_back(colour.cast<float>());
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

std::vector<HedgeRow> rows_of(const SceneryField& field) {
  std::vector<HedgeRow> rows;
  if (field.pitch_m <= 0.0 || field.planted_W.size() < 3) return rows;
  const Eigen::Vector2d normal(-field.along_W.y(), field.along_W.x());
  const double offset_m = normal.dot(field.corners_W.front());
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Eigen::Vector2d& corner : field.planted_W) {
    low = std::min(low, normal.dot(corner));
    high = std::max(high, normal.dot(corner));
  }
  const auto first = static_cast<int>(std::ceil((low - offset_m) / field.pitch_m));
  const auto last = static_cast<int>(std::floor((high - offset_m) / field.pitch_m));
  for (int k = first; k <= last; ++k) {
    const Eigen::Vector2d p = (offset_m + k * field.pitch_m) * normal;
    const Eigen::Vector2d t = clip_line(field.planted_W, p, field.along_W);
    constexpr double kMin_m = 6.0;
    if (t[1] - t[0] < kMin_m) continue;
    rows.push_back({p + t[0] * field.along_W, p + t[1] * field.along_W,
                    static_cast<std::uint32_t>(k + 100000)});
  }
  return rows;
}

}  // namespace

PreparedMesh make_hedges(const SceneryField& field, const HeightField& terrain) {
  PreparedMesh mesh;
  for (const HedgeRow& row : rows_of(field)) add_row(field, row, terrain, mesh);
  return mesh;
}

PreparedMesh make_stems(const SceneryField& field, const HeightField& terrain) {
  PreparedMesh mesh;
  for (const HedgeRow& row : rows_of(field)) add_curtain(field, row, terrain, mesh);
  return mesh;
}

double scenery_crown_base_m(const SceneryTreeSize& size) {
  return std::min(0.28 * size.height_m, 2.2);
}

std::shared_ptr<TriangleMesh> make_scenery_crown(const SceneryTreeSize& size, int kind) {
  auto mesh = std::make_shared<TriangleMesh>();
  Scatter scatter(500u + static_cast<std::uint32_t>(kind));
  const double base_m = scenery_crown_base_m(size);
  const Eigen::Vector3d centre(0, 0, 0.5 * (size.height_m + base_m));
  const Eigen::Vector3d half(0.5 * size.crown_width_m, 0.5 * size.crown_width_m,
                             0.5 * (size.height_m - base_m));
  constexpr int kCards = 60;
  for (int i = 0; i < kCards; ++i) {
    // Evenly over the sphere (Fibonacci lattice), mostly near the crown's surface.
    const double z = 1.0 - (2.0 * i + 1.0) / kCards;
    const double azimuth = 2.39996323 * i + scatter.between(-0.3f, 0.3f);
    const double r = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d out(r * std::cos(azimuth), r * std::sin(azimuth), z);
    const double depth = scatter.between(0.55f, 0.88f);
    const Eigen::Vector3d middle = centre + depth * out.cwiseProduct(half);
    const Eigen::Vector3d tilt(scatter.between(-0.6f, 0.6f), scatter.between(-0.6f, 0.6f),
                               scatter.between(-0.2f, 0.6f));
    const Eigen::Vector3d face = (out + tilt).normalized();
    const Eigen::Vector3d helper =
        std::abs(face.z()) > 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
    const double card_m = std::max(0.4, 0.21 * std::min(size.crown_width_m, size.height_m)) *
                          scatter.between(0.8f, 1.25f);
    const Eigen::Vector3d side = card_m * helper.cross(face).normalized();
    const Eigen::Vector3d up = card_m * face.cross(side).normalized();
    const double shade = (0.55 + 0.45 * (0.5 + 0.5 * z)) * scatter.between(0.8f, 1.2f);
    add_leaf_card(*mesh, middle, side, up, (out + 0.3 * Eigen::Vector3d::UnitZ()).normalized(),
                  shade * Eigen::Vector3d(0.062, 0.108, 0.030));
  }
  return mesh;
}

std::shared_ptr<TriangleMesh> make_scenery_trunk(const SceneryTreeSize& size) {
  auto mesh = std::make_shared<TriangleMesh>();
  constexpr std::uint32_t kSides = 6;
  const double radius_m = 0.03 * size.height_m;
  for (std::uint32_t i = 0; i < 2 * kSides; ++i) {
    const double azimuth = 6.28318531 * (i % kSides) / kSides;
    const bool is_top = i >= kSides;
    const double r = is_top ? 0.5 * radius_m : radius_m;
    mesh->vertices.emplace_back(Eigen::Vector3d(r * std::cos(azimuth), r * std::sin(azimuth),
                                                is_top ? 0.6 * size.height_m : -0.4)
                                    .cast<float>());
  }
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t next = (i + 1) % kSides;
    mesh->triangles.push_back({i, next, kSides + next});
    mesh->triangles.push_back({i, kSides + next, kSides + i});
  }
  return mesh;
}

}  // namespace vinerow::render
