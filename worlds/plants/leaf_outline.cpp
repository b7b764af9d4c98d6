#include "worlds/plants/leaf_outline.h"

#include <array>
#include <cmath>
#include <vector>

#include "engine/core/check.h"
#include "engine/math/angles.h"

namespace vinerow::worlds {
namespace {

struct Polar {
  double angle_deg, radius;
};

/// The left half, from the tip to the stalk's sinus: lobes and the sinuses between them.
constexpr std::array<Polar, 7> kHalf = {
    {{0, 1.0}, {17, 0.84}, {30, 0.64}, {52, 0.9}, {82, 0.6}, {112, 0.7}, {152, 0.52}}};

std::vector<Eigen::Vector2d> mirror(std::span<const Polar> half) {
  std::vector<Eigen::Vector2d> points;
  const auto add = [&](const Polar& p, double sign) {
    const double angle = sign * rad_from_deg(p.angle_deg);
    points.emplace_back(p.radius * std::cos(angle), p.radius * std::sin(angle));
  };
  for (const Polar& p : half) add(p, 1.0);
  for (std::size_t i = half.size() - 1; i > 0; --i) add(half[i], -1.0);
  return points;
}

/// Of the triangles between the junction and each edge, but for the open one at the stalk.
double fan_area(std::span<const Eigen::Vector2d> points) {
  double area = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == open_edge(points.size())) continue;
    const Eigen::Vector2d &a = points[i], &b = points[(i + 1) % points.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

/// Right and left of the midrib alike, from widths along it. @param widths  at equal steps between
/// the stalk and the tip
std::vector<Eigen::Vector2d> along_midrib(std::span<const double> widths) {
  std::vector<Eigen::Vector2d> points = {{1.0, 0.0}};
  const auto count = static_cast<double>(widths.size() + 1);
  for (std::size_t i = widths.size(); i > 0; --i) {
    points.emplace_back(static_cast<double>(i) / count, 0.5 * widths[i - 1]);
  }
  for (std::size_t i = 1; i <= widths.size(); ++i) {
    points.emplace_back(static_cast<double>(i) / count, -0.5 * widths[i - 1]);
  }
  return points;
}

struct Outlines {
  std::vector<Eigen::Vector2d> levels[3];
};

const Outlines& outlines_of(LeafKind kind) {
  static const Outlines grapevine = {
      {mirror(kHalf), mirror(std::array<Polar, 4>{{{0, 1.0}, {52, 0.82}, {110, 0.66}, {152, 0.5}}}),
       mirror(std::array<Polar, 3>{{{0, 1.0}, {70, 0.8}, {152, 0.5}}})}};
  static const Outlines apple = {{along_midrib(std::array{0.46, 0.6, 0.5}),
                                  along_midrib(std::array{0.6, 0.5}),
                                  along_midrib(std::array{0.6})}};
  static const Outlines olive = {{along_midrib(std::array{0.19, 0.17}),
                                  along_midrib(std::array{0.21}), along_midrib(std::array{0.21})}};
  return kind == LeafKind::kGrapevine ? grapevine : kind == LeafKind::kApple ? apple : olive;
}

}  // namespace

std::span<const Eigen::Vector2d> leaf_outline(LeafKind kind, int level) {
  VINEROW_DEMAND(level >= 0 && level <= 2);
  return outlines_of(kind).levels[level];
}

double leaf_length_m(LeafKind kind, double area_m2, int level) {
  return std::sqrt(area_m2 / fan_area(leaf_outline(kind, level)));
}

}  // namespace vinerow::worlds
