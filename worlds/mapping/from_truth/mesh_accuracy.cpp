#include "worlds/mapping/from_truth/mesh_accuracy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/math/polyline.h"

namespace vinerow::mapping {
namespace {

constexpr double kReach_m = 0.4;        // beyond this it is another plant, or a gap
constexpr double kStep_m = 0.05;        // of points along the row
constexpr double kFinestLine_m = 0.05;  // between lines of points
constexpr std::size_t kLags = 40;

struct Facet {
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d normal, along;  // along the row, in the facet
  double area_m2;
};

Eigen::Vector3d row_direction(const PlantRow& row, const Eigen::Vector3d& p) {
  double nearest = 1e300;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  for (std::size_t k = 0; k + 1 < row.line_W.size(); ++k) {
    const Eigen::Vector3d &a = row.line_W[k], &b = row.line_W[k + 1];
    if (a == b) continue;
    const double apart = (nearest_on_segment<3>(p, a, b) - p).squaredNorm();
    if (apart < nearest) {
      nearest = apart;
      direction = (b - a).normalized();
    }
  }
  return direction;
}

std::vector<Facet> read_facets(const std::vector<PlantRow>& rows,
                               const std::vector<RowMesh>& meshes) {
  std::vector<Facet> facets;
  for (const RowMesh& mesh : meshes) {
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const PlantRow& r) { return r.id == mesh.row; });
    if (row == rows.end()) continue;
    for (const auto& triangle : mesh.mesh_W.triangles) {
      Facet facet;
      for (std::size_t k = 0; k < 3; ++k) {
        facet.corners[k] = mesh.mesh_W.vertices[triangle[k]].cast<double>();
      }
      const auto& [a, b, c] = facet.corners;
      const Eigen::Vector3d across = (b - a).cross(c - a);
      if (across.norm() < 1e-12) continue;
      facet.normal = across.normalized();
      facet.area_m2 = 0.5 * across.norm();
      const Eigen::Vector3d ahead = row_direction(*row, (a + b + c) / 3.0);
      const double looks_ahead = ahead.dot(facet.normal);
      if (std::abs(looks_ahead) > 0.7) continue;
      facet.along = (ahead - looks_ahead * facet.normal).normalized();
      facets.push_back(facet);
    }
  }
  return facets;
}

/// Sums over points and pairs of points on one line.
struct Sums {
  double error = 0.0;
  std::array<double, kLags> product{};
  std::array<std::int64_t, kLags> pairs{};
  std::int64_t far_points = 0;

  void add(const std::vector<std::optional<double>>& line) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (!line[i]) {
        ++far_points;
        continue;
      }
      error += *line[i];
      for (std::size_t lag = 0; lag < kLags && i + lag < line.size(); ++lag) {
        if (!line[i + lag]) continue;
        product[lag] += *line[i] * *line[i + lag];
        ++pairs[lag];
      }
    }
  }
};

}  // namespace

MeshAccuracy measure_accuracy(const SceneQuery& scene, const std::vector<PlantRow>& rows,
                              const std::vector<RowMesh>& meshes, std::int64_t wanted_points) {
  const std::vector<Facet> facets = read_facets(rows, meshes);
  double area_m2 = 0.0;
  for (const Facet& facet : facets) area_m2 += facet.area_m2;
  const double line_m =
      std::max(kFinestLine_m, area_m2 / (kStep_m * static_cast<double>(wanted_points)));

  Sums sums;
  std::vector<std::optional<double>> line;
  for (std::size_t k = 0; k < facets.size(); ++k) {
    const Facet& facet = facets[k];
    const Eigen::Vector3d across = facet.normal.cross(facet.along);
    std::array<Eigen::Vector2d, 3> flat;
    double low = 1e300, high = -1e300;
    for (std::size_t n = 0; n < 3; ++n) {
      const Eigen::Vector3d p = facet.corners[n] - facet.corners[0];
      flat[n] = {p.dot(facet.along), p.dot(across)};
      low = std::min(low, flat[n].y());
      high = std::max(high, flat[n].y());
    }
    // Where the first line lies changes evenly from facet to facet, so that narrow facets get
    // their share too.
    constexpr double kGolden = 0.6180339887498949;
    const double phase = std::fmod(kGolden * static_cast<double>(k + 1), 1.0);
    for (double y = low + phase * line_m; y < high; y += line_m) {
      double from = 1e300, to = -1e300;
      for (std::size_t n = 0; n < 3; ++n) {
        const Eigen::Vector2d &a = flat[n], &b = flat[(n + 1) % 3];
        if ((a.y() > y) == (b.y() > y)) continue;
        const double x = a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        from = std::min(from, x);
        to = std::max(to, x);
      }
      line.clear();
      for (double x = from + phase * kStep_m; x < to; x += kStep_m) {
        const Eigen::Vector3d p = facet.corners[0] + x * facet.along + y * across;
        const auto hit = scene.cast_ray(p + kReach_m * facet.normal, -facet.normal, 2.0 * kReach_m,
                                        mask_of(SurfaceClass::kCanopy));
        line.push_back(hit ? std::optional(kReach_m - hit->distance_m) : std::nullopt);
      }
      sums.add(line);
    }
  }

  MeshAccuracy result;
  result.points = sums.pairs[0];
  result.far_points = sums.far_points;
  if (result.points == 0) return result;
  const auto covariance = [&](std::size_t lag) {
    return sums.product[lag] / static_cast<double>(sums.pairs[lag]);
  };
  result.mean_m = sums.error / static_cast<double>(result.points);
  result.rms_m = std::sqrt(covariance(0));
  double before = 1.0;
  for (std::size_t lag = 1; lag < kLags && sums.pairs[lag] > 30; ++lag) {
    const double now = covariance(lag) / covariance(0), wanted = std::exp(-1.0);
    const auto steps = static_cast<double>(lag);
    result.correlation_length_m = kStep_m * steps;
    if (now <= wanted) {
      result.correlation_length_m = kStep_m * (steps - (wanted - now) / (before - now));
      break;
    }
    before = now;
  }
  return result;
}

}  // namespace vinerow::mapping
