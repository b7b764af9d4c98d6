#include "vehicles/parts/wind_shelter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/map.h"

namespace vinerow::vehicles {
namespace {

/// Finest grid, and the largest number of nodes: larger blocks get a coarser grid.
constexpr double kFinestCell_m = 0.5;
constexpr double kMaxNodes = 250'000.0;
constexpr double kFar_m = std::numeric_limits<double>::infinity();

/// Strip along a straight piece of an alley or a row.
struct Strip {
  Eigen::Vector2d start, along;
  double length_m, half_width_m;

  /// Distance of a point from the strip, 0 inside.
  double distance_m(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d d = p - start;
    const double s = along.dot(d), n = std::abs(along.x() * d.y() - along.y() * d.x());
    return std::hypot(std::max({0.0, -s, s - length_m}), std::max(0.0, n - half_width_m));
  }
  Eigen::Vector2d axis() const {
    return {along.x() * along.x() - along.y() * along.y(), 2.0 * along.x() * along.y()};
  }
};

std::vector<Strip> strips_of(const std::vector<Eigen::Vector3d>& line, double width_m) {
  std::vector<Strip> strips;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Eigen::Vector2d start = line[i - 1].head<2>(), step = line[i].head<2>() - start;
    const double length_m = step.norm();
    if (length_m > 0.0) strips.push_back({start, step / length_m, length_m, 0.5 * width_m});
  }
  return strips;
}

struct RowStrip {
  Strip strip;
  double top_m;
};

/// 1 at 0 to 0 at 1, with flat ends.
double fade(double share) {
  const double x = std::clamp(share, 0.0, 1.0);
  return 1.0 - x * x * (3.0 - 2.0 * x);
}

}  // namespace

Eigen::Vector3d ShelterFactors::apply(const Eigen::Vector3d& wind_W,
                                      const Eigen::Vector2d& axis) const {
  // along * projection on the rows + across * the rest; the projection in terms of the double
  // angle is (1 + [c s; s -c]) / 2.
  const double mean = 0.5 * (along + across), half = 0.5 * (along - across);
  return {mean * wind_W.x() + half * (axis.x() * wind_W.x() + axis.y() * wind_W.y()),
          mean * wind_W.y() + half * (axis.y() * wind_W.x() - axis.x() * wind_W.y()),
          across * wind_W.z()};
}

WindShelter::WindShelter(const RowMap& map, double attenuation) : attenuation_(attenuation) {
  if (attenuation <= 0.0 || map.rows.empty()) return;
  std::vector<RowStrip> rows;
  std::vector<Strip> alleys;
  double highest_m = 0.0, widest_m = 0.0;
  Eigen::AlignedBox2d box;
  const auto extend = [&box](const Strip& strip) {
    box.extend(strip.start);
    box.extend(Eigen::Vector2d(strip.start + strip.length_m * strip.along));
  };
  for (const PlantRow& row : map.rows) {
    for (const Strip& strip : strips_of(row.line_W, row.canopy_width_m)) {
      rows.push_back({strip, row.canopy_top_m});
      extend(strip);
    }
    highest_m = std::max(highest_m, row.canopy_top_m);
  }
  for (const Alley& alley : map.alleys) {
    for (const Strip& strip : strips_of(alley.line_W, alley.width_m)) {
      alleys.push_back(strip);
      extend(strip);
      widest_m = std::max(widest_m, alley.width_m);
    }
  }
  if (box.isEmpty()) return;
  const double reach_m = highest_m + widest_m + 2.0 * kFinestCell_m;
  const Eigen::Vector2d size_m = box.sizes() + Eigen::Vector2d::Constant(2.0 * reach_m);
  cell_m_ = std::max(kFinestCell_m, std::sqrt(size_m.x() * size_m.y() / kMaxNodes));
  corner_W_ = box.min() - Eigen::Vector2d::Constant(reach_m);
  columns_ = static_cast<int>(size_m.x() / cell_m_) + 2;
  rows_ = static_cast<int>(size_m.y() / cell_m_) + 2;
  const std::size_t count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  spots_.assign(count, Node{0.0f, 0.0f, 0.0f, 0.0f});

  // Calls see(node, distance) for every node that is near a strip.
  const auto around = [&](const Strip& strip, double far_m, const auto& see) {
    Eigen::AlignedBox2d near(strip.start);
    near.extend(Eigen::Vector2d(strip.start + strip.length_m * strip.along));
    const double margin_m = strip.half_width_m + far_m;
    const auto cell = [&](double way_m, int last) {
      return static_cast<int>(std::clamp(way_m / cell_m_, 0.0, static_cast<double>(last)));
    };
    const int i0 = cell(near.min().x() - margin_m - corner_W_.x(), columns_ - 1);
    const int i1 = cell(near.max().x() + margin_m - corner_W_.x() + cell_m_, columns_ - 1);
    const int j0 = cell(near.min().y() - margin_m - corner_W_.y(), rows_ - 1);
    const int j1 = cell(near.max().y() + margin_m - corner_W_.y() + cell_m_, rows_ - 1);
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i) {
        const double distance_m = strip.distance_m(corner_W_ + cell_m_ * Eigen::Vector2d(i, j));
        if (distance_m > far_m) continue;
        see(static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                static_cast<std::size_t>(i),
            distance_m);
      }
    }
  };
  // The nearest row gives the canopy's top, the nearest strip gives direction and distance.
  std::vector<double> row_m(count, kFar_m), strip_m(count, kFar_m);
  const auto take_strip = [&](const Strip& strip, std::size_t node, double distance_m) {
    if (distance_m >= strip_m[node]) return;
    strip_m[node] = distance_m;
    spots_[node].axis_x = static_cast<float>(strip.axis().x());
    spots_[node].axis_y = static_cast<float>(strip.axis().y());
  };
  for (const RowStrip& row : rows) {
    around(row.strip, reach_m, [&](std::size_t node, double distance_m) {
      if (distance_m < row_m[node]) {
        row_m[node] = distance_m;
        spots_[node].top_m = static_cast<float>(row.top_m);
      }
      take_strip(row.strip, node, distance_m);
    });
  }
  for (const Strip& alley : alleys) {
    around(alley, highest_m + 2.0 * cell_m_,
           [&](std::size_t node, double distance_m) { take_strip(alley, node, distance_m); });
  }
  for (std::size_t node = 0; node < count; ++node) {
    Node& spot = spots_[node];
    if (spot.top_m > 0.0f) spot.inside = static_cast<float>(fade(strip_m[node] / spot.top_m));
  }
}

ShelterSpot WindShelter::spot(const Eigen::Vector2d& p_W) const {
  ShelterSpot spot;
  if (none()) return spot;
  const Eigen::Vector2d g = (p_W - corner_W_) / cell_m_;
  if (!(g.x() >= 0.0 && g.y() >= 0.0 && g.x() < columns_ - 1 && g.y() < rows_ - 1)) return spot;
  const int i = static_cast<int>(g.x()), j = static_cast<int>(g.y());
  const double u = g.x() - i, v = g.y() - j;
  const auto blend = [&](float Node::*value) {
    const double low = node(i, j).*value + u * (node(i + 1, j).*value - node(i, j).*value);
    const double high =
        node(i, j + 1).*value + u * (node(i + 1, j + 1).*value - node(i, j + 1).*value);
    return low + v * (high - low);
  };
  spot.inside = blend(&Node::inside);
  if (spot.inside <= 0.0) return spot;
  spot.axis = {blend(&Node::axis_x), blend(&Node::axis_y)};
  spot.top_m = blend(&Node::top_m);
  return spot;
}

ShelterFactors WindShelter::factors(const ShelterSpot& spot, double height_m) const {
  if (spot.inside <= 0.0 || height_m >= spot.top_m) return {};
  const double depth = 1.0 - std::max(0.0, height_m) / spot.top_m;
  const double exponent = -attenuation_ * spot.inside * depth;
  return {std::exp(kAlongShare * exponent), std::exp(exponent)};
}

}  // namespace vinerow::vehicles
