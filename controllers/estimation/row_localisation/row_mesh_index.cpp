#include "controllers/estimation/row_localisation/row_mesh_index.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "controllers/estimation/row_localisation/ray_shear.h"
#include "engine/api/map.h"
#include "engine/core/check.h"
#include "engine/core/constants.h"
#include "engine/core/error.h"
#include "engine/math/polyline.h"

namespace vinerow::controllers {
namespace {

// Squares of the grid at most: 16 MB of list starts. Chosen.
constexpr double kMaxSquares = 4e6;
// Step by which squares are enlarged until their number is allowed. Chosen.
constexpr double kSquareGrowth = 1.25;
// Enlarges facets in the lists, so that rounding loses none at the edge of a square. Chosen: larger
// than the rounding of coordinates up to some kilometres, negligible against a square.
constexpr double kMargin_m = 1e-6;
// Twice the area below which a triangle has no reliable normal and is not listed. Chosen.
constexpr double kMinDoubleArea_m2 = 1e-12;
// Marks a listed facet in the one square that contains its centre, its home.
constexpr std::uint32_t kHome = 1u << 31;

Eigen::Vector2d horizontal(const Eigen::Vector3f& p) {
  return {p.x(), p.y()};
}

/// Part of a line between low and high on each axis (slab method).
struct Clip {
  double from = 0.0, to = kInfinity;
  void axis(double p, double inverse_dir, double low, double high) {
    if (!std::isfinite(inverse_dir)) {
      if (p < low || p > high) to = -kInfinity;
      return;
    }
    const double t_low = (low - p) * inverse_dir, t_high = (high - p) * inverse_dir;
    from = std::max(from, std::min(t_low, t_high));
    to = std::min(to, std::max(t_low, t_high));
  }
};

}  // namespace

// Set-up: facets with unit normals N; a grid of squares over their extent; for each square the list
// of the facets above it, in one array (listed_) with the start of each list (first_).
//
// Ray p + t u (cast_ray): clip it to the grid, then walk from square to square by the smaller of
// the parameters at which it leaves the square along x and y. In each square, a facet with plane
// N.x = N.a is hit at
//
//   t = N.(a - p) / (N.u) = height / -slope,   slope = N.u < 0,   height = -N.(a - p) >= 0
//
// if the ray passes through the triangle (RayShear). The walk ends if the ray leaves the square
// beyond the nearest hit.
//
// Plane n.(x - p) = 0 (cut): each facet with corners on both sides gives one segment between the
// two edges of the corner that is alone on its side.

RowMeshIndex::RowMeshIndex(const RowMap& map, double cell_m) {
  VINEROW_DEMAND(cell_m > 0.0);
  read_facets(map);
  lay_grid(cell_m);
  list_facets();
}

void RowMeshIndex::read_facets(const RowMap& map) {
  std::size_t count = 0;
  for (const RowMesh& mesh : map.meshes) count += mesh.mesh_W.triangles.size();
  VINEROW_DEMAND(count < kHome);
  if (count == 0) {
    throw ConfigError(
        "the map has no row meshes to measure distances to: give the vehicle a map with row "
        "meshes, such as map: {type: row_mesh}");
  }
  facets_.reserve(count);
  for (const RowMesh& mesh : map.meshes) {
    const auto& vertices = mesh.mesh_W.vertices;
    for (std::size_t k = 0; k < mesh.mesh_W.triangles.size(); ++k) {
      Facet facet;
      facet.row = mesh.row;
      Eigen::Vector3f* corners[] = {&facet.a, &facet.b, &facet.c};
      for (std::size_t n = 0; n < 3; ++n) {
        const std::uint32_t vertex = mesh.mesh_W.triangles[k][n];
        if (vertex >= vertices.size() || !vertices[vertex].allFinite()) {
          throw ConfigError(fmt::format(
              "mesh of map row {}: vertex {} of triangle {} is {} ({} vertices)", mesh.row, vertex,
              k, vertex >= vertices.size() ? "missing" : "not finite", vertices.size()));
        }
        *corners[n] = vertices[vertex];
      }
      const Eigen::Vector3d a = facet.a.cast<double>();
      const Eigen::Vector3d across = (facet.b.cast<double>() - a).cross(facet.c.cast<double>() - a);
      const double area2 = across.norm();
      facet.normal =
          area2 > kMinDoubleArea_m2 ? Eigen::Vector3d(across / area2) : Eigen::Vector3d::Zero();
      facets_.push_back(facet);
    }
  }
}

void RowMeshIndex::lay_grid(double cell_m) {
  low_ = Eigen::Vector2d::Constant(kInfinity);
  high_ = -low_;
  for (const Facet& facet : facets_) {
    const Eigen::Vector2d a = horizontal(facet.a), b = horizontal(facet.b), c = horizontal(facet.c);
    low_ = low_.cwiseMin(a).cwiseMin(b).cwiseMin(c);
    high_ = high_.cwiseMax(a).cwiseMax(b).cwiseMax(c);
    const Eigen::Vector2d centre = (a + b + c) / 3.0;
    facet_reach_m_ =
        std::max({facet_reach_m_, (a - centre).norm(), (b - centre).norm(), (c - centre).norm()});
  }
  low_.array() -= 2.0 * kMargin_m;
  high_.array() += 2.0 * kMargin_m;
  const Eigen::Vector2d size = high_ - low_;
  const auto squares = [&] { return std::ceil(size.x() / cell_m) * std::ceil(size.y() / cell_m); };
  while (squares() > kMaxSquares) cell_m *= kSquareGrowth;
  cell_m_ = cell_m;
  columns_ = std::max(1, static_cast<int>(std::ceil(size.x() / cell_m)));
  lines_ = std::max(1, static_cast<int>(std::ceil(size.y() / cell_m)));
}

RowMeshIndex::Square RowMeshIndex::square_at(double x, double y) const {
  const auto clamped = [](double v, int count) {
    return static_cast<int>(std::clamp(v, 0.0, count - 1.0));
  };
  return {clamped((x - low_.x()) / cell_m_, columns_), clamped((y - low_.y()) / cell_m_, lines_)};
}

template <class Visit>
void RowMeshIndex::for_each_square_below(const Facet& facet, Visit&& visit) const {
  if (facet.normal.isZero()) return;
  const Eigen::Vector2d corners[] = {horizontal(facet.a), horizontal(facet.b), horizontal(facet.c)};
  const Eigen::Vector2d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Eigen::Vector2d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  const Square first = square_at(low.x() - kMargin_m, low.y() - kMargin_m);
  const Square last = square_at(high.x() + kMargin_m, high.y() + kMargin_m);
  const double half_m = 0.5 * cell_m_;
  for (int j = first.j; j <= last.j; ++j) {
    for (int i = first.i; i <= last.i; ++i) {
      // Separating axes: the loop covers those of the grid; one across each edge remains.
      const Eigen::Vector2d middle = low_ + cell_m_ * Eigen::Vector2d(i + 0.5, j + 0.5);
      bool apart = false;
      for (int k = 0; k < 3 && !apart; ++k) {
        const Eigen::Vector2d edge = corners[(k + 1) % 3] - corners[k];
        const Eigen::Vector2d across(-edge.y(), edge.x());
        const double reach = half_m * across.lpNorm<1>() + kMargin_m * across.norm();
        const double one = across.dot(corners[k] - middle);
        const double other = across.dot(corners[(k + 2) % 3] - middle);
        apart = std::min(one, other) > reach || std::max(one, other) < -reach;
      }
      if (!apart) visit(Square{i, j});
    }
  }
}

void RowMeshIndex::list_facets() {
  // Counting sort: count the entries of each square, sum to list starts, then fill.
  first_.assign(static_cast<std::size_t>(columns_) * lines_ + 1, 0);
  for (const Facet& facet : facets_) {
    for_each_square_below(facet, [&](Square square) { ++first_[index_of(square) + 1]; });
  }
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  listed_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t k = 0; k < facets_.size(); ++k) {
    const Facet& facet = facets_[k];
    const Eigen::Vector3d centre =
        (facet.a.cast<double>() + facet.b.cast<double>() + facet.c.cast<double>()) / 3.0;
    const std::size_t home = index_of(square_at(centre.x(), centre.y()));
    for_each_square_below(facet, [&](Square square) {
      const std::size_t index = index_of(square);
      listed_[next[index]++] = index == home ? k | kHome : k;
    });
  }
}

std::optional<RowMeshIndex::Hit> RowMeshIndex::cast_ray(const Eigen::Vector3d& p,
                                                        const Eigen::Vector3d& u,
                                                        double max_distance_m) const {
  if (!p.allFinite() || !u.allFinite() || !(max_distance_m >= 0.0)) return std::nullopt;
  const double inverse_x = 1.0 / u.x(), inverse_y = 1.0 / u.y();
  Clip clip;
  clip.to = max_distance_m;
  clip.axis(p.x(), inverse_x, low_.x(), high_.x());
  clip.axis(p.y(), inverse_y, low_.y(), high_.y());
  if (!(clip.from <= clip.to)) return std::nullopt;

  Square square = square_at(p.x() + clip.from * u.x(), p.y() + clip.from * u.y());
  const int step_i = u.x() > 0.0 ? 1 : -1, step_j = u.y() > 0.0 ? 1 : -1;
  const bool runs_x = std::isfinite(inverse_x), runs_y = std::isfinite(inverse_y);
  // Ray parameter at which the ray leaves the square along one axis.
  const auto leaves = [&](double low, int cell, int step, double from, double inverse) {
    return (low + cell_m_ * (cell + (step > 0 ? 1 : 0)) - from) * inverse;
  };
  double leave_x = runs_x ? leaves(low_.x(), square.i, step_i, p.x(), inverse_x) : kInfinity;
  double leave_y = runs_y ? leaves(low_.y(), square.j, step_j, p.y(), inverse_y) : kInfinity;

  const RayShear shear(u);
  double nearest_m = max_distance_m;
  const Facet* hit = nullptr;
  while (true) {
    const std::size_t index = index_of(square);
    for (std::uint32_t k = first_[index]; k < first_[index + 1]; ++k) {
      const Facet& facet = facets_[listed_[k] & ~kHome];
      const double slope = facet.normal.dot(u);
      if (slope >= 0.0) continue;  // seen from behind
      // Compare t with the nearest hit without a division.
      const double height_m = -facet.normal.dot(facet.a.cast<double>() - p);
      if (!(height_m >= 0.0 && height_m < -slope * nearest_m)) continue;
      if (!shear.passes_through(facet.a, facet.b, facet.c, p)) continue;
      nearest_m = height_m / -slope;
      hit = &facet;
    }
    const double leave_m = std::min(leave_x, leave_y);
    if (leave_m >= nearest_m || leave_m > clip.to) break;
    if (leave_x < leave_y) {
      square.i += step_i;
      if (square.i < 0 || square.i >= columns_) break;
      leave_x = leaves(low_.x(), square.i, step_i, p.x(), inverse_x);
    } else {
      square.j += step_j;
      if (square.j < 0 || square.j >= lines_) break;
      leave_y = leaves(low_.y(), square.j, step_j, p.y(), inverse_y);
    }
  }
  if (!hit) return std::nullopt;
  return Hit{nearest_m, hit->normal, hit->normal.dot(hit->a.cast<double>()), hit->row,
             static_cast<int>(hit - facets_.data())};
}

void RowMeshIndex::cut(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double radius_m,
                       std::vector<Segment>& segments) const {
  segments.clear();
  if (!p.allFinite() || !n.allFinite() || !(radius_m >= 0.0)) return;
  const Eigen::Vector2d p_2d = p.head<2>();
  const double reach_m = radius_m + facet_reach_m_;
  if ((p_2d.array() + reach_m < low_.array()).any() ||
      (p_2d.array() - reach_m > high_.array()).any()) {
    return;
  }
  // A facet that reaches into the radius has its centre in one of these squares.
  const Square from = square_at(p.x() - reach_m, p.y() - reach_m);
  const Square to = square_at(p.x() + reach_m, p.y() + reach_m);
  for (int j = from.j; j <= to.j; ++j) {
    const std::uint32_t end = first_[index_of({to.i, j}) + 1];
    for (std::uint32_t k = first_[index_of({from.i, j})]; k < end; ++k) {
      // A facet is listed in several squares but counts only in its home.
      if ((listed_[k] & kHome) == 0) continue;
      const Facet& facet = facets_[listed_[k] & ~kHome];
      const Eigen::Vector3d corners[] = {facet.a.cast<double>(), facet.b.cast<double>(),
                                         facet.c.cast<double>()};
      const double above[] = {n.dot(corners[0] - p), n.dot(corners[1] - p), n.dot(corners[2] - p)};
      const bool one_side = above[0] >= 0.0;
      if ((above[1] >= 0.0) == one_side && (above[2] >= 0.0) == one_side) continue;
      // The plane crosses two edges: those of the corner that is alone on its side.
      const std::size_t lone = (above[1] >= 0.0) == (above[2] >= 0.0)   ? 0
                               : (above[0] >= 0.0) == (above[2] >= 0.0) ? 1
                                                                        : 2;
      const auto crossing = [&](std::size_t v) -> Eigen::Vector3d {
        // From the upper end, so that both facets of the edge get the same bits.
        const std::size_t upper = above[v] >= 0.0 ? v : lone, lower = upper == v ? lone : v;
        const double share = above[upper] / (above[upper] - above[lower]);
        return corners[upper] + share * (corners[lower] - corners[upper]);
      };
      // The segment starts where the facet's border goes down through the plane.
      const std::size_t next = (lone + 1) % 3, before = (lone + 2) % 3;
      const bool peak = above[lone] >= 0.0;
      const Segment segment{crossing(peak ? next : before), crossing(peak ? before : next),
                            facet.normal, facet.row};
      const Eigen::Vector2d nearest_2d =
          nearest_on_segment<2>(p_2d, segment.from_W.head<2>(), segment.to_W.head<2>());
      if ((nearest_2d - p_2d).norm() > radius_m) continue;
      segments.push_back(segment);
    }
  }
}

}  // namespace vinerow::controllers
