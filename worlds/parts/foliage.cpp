#include "worlds/parts/foliage.h"

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"
#include "worlds/parts/primitives.h"

namespace vinerow::worlds {
namespace {

/// A leaf at a point of the crown.
/// @param outward  unit, away from the crown's middle
/// @param depth    0 at the surface, 1 in the middle
/// @param height   0 at the crown's bottom, 1 at its top
void append_leaf(TriangleMesh& mesh, const Eigen::Vector3d& p, const Eigen::Vector3d& outward,
                 double depth, double height, double length_m, RandomStream& random) {
  // Leaves turn their face outward and up to the light, with scatter; their tips hang.
  const Eigen::Vector3d face =
      (outward + 0.45 * Eigen::Vector3d::UnitZ() + 0.75 * random_direction(random)).normalized();
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ() + 0.8 * random_direction(random);
  down -= down.dot(face) * face;
  if (down.norm() < 0.1) down = any_orthogonal(face);
  down.normalize();
  const double size_m = length_m * random.uniform(0.75, 1.25);
  LeafCard card;
  card.stem = p - 0.5 * size_m * down;
  card.tip = p + 0.5 * size_m * down;
  card.side = 0.5 * size_m * face.cross(down);
  card.normal = (1.0 * outward + 0.55 * face + 0.25 * Eigen::Vector3d::UnitZ()).normalized();
  // Linear RGB of grapevine leaves from young (yellow-green, near the top) to old (blue-green).
  const double age = std::clamp(1.0 - height + 0.35 * random.normal(), 0.0, 1.0);
  const Eigen::Vector3d young(0.14, 0.245, 0.045), old(0.05, 0.125, 0.03), dry(0.2, 0.16, 0.05);
  Eigen::Vector3d colour = (1.0 - age) * young + age * old;
  if (random.uniform() < 0.006) colour = dry;
  const double shade = (1.0 - 0.62 * depth) * (0.72 + 0.28 * height) * random.uniform(0.82, 1.18);
  card.colour = (shade * colour).cast<float>();
  append_card(mesh, card);
}

}  // namespace

FoliageDetail vine_foliage_detail(double leaf_cards_per_m, int level) {
  // Fewer cards, larger by the root: the same area, a little more to hide the larger gaps.
  constexpr double kFewer[] = {1.0, 0.11, 0.028};
  constexpr double kLength_m = 0.13;
  return {leaf_cards_per_m * kFewer[level], kLength_m / std::sqrt(kFewer[level])};
}

FoliageDetail tree_foliage_detail(double leaf_cards, int level) {
  constexpr double kFewer[] = {1.0, 0.12, 0.035};
  constexpr double kLength_m = 0.24;
  return {leaf_cards * kFewer[level], kLength_m / std::sqrt(kFewer[level])};
}

TriangleMesh make_vine_foliage(const CanopyShape& shape, const FoliageDetail& detail,
                               RandomStream random) {
  TriangleMesh mesh;
  const double length_m = shape.length_m();
  const int cards = std::max(4, static_cast<int>(std::lround(detail.cards_per_m * length_m)));
  for (int i = 0; i < cards; ++i) {
    // Stratified along the row: no clumps nor holes at the joints of stretches.
    const double u_m = length_m * (i + random.uniform()) / cards;
    const double angle = random.uniform(0.0, 2.0 * kPi);
    // Most leaves are in the outer shell; some inside stop the eye from looking through.
    const bool inside = random.uniform() < 0.16;
    const double depth =
        inside ? random.uniform(0.45, 1.0) : 0.45 * std::pow(random.uniform(), 1.5);
    const CanopySection section = shape.section(u_m);
    const Eigen::Vector2d middle(section.shift_m, 0.5 * (section.base_m + section.top_m));
    const Eigen::Vector2d surface = shape.surface_point(u_m, angle);
    // Half a leaf stands inside the surface, so that tips reach the hull and not beyond it.
    const double half_m = 0.5 * detail.card_length_m;
    const Eigen::Vector2d normal = shape.surface_normal(u_m, angle);
    Eigen::Vector2d p = middle + (1.0 - depth) * (surface - middle) -
                        std::min(half_m, 0.3 * section.width_m) * 0.8 * normal;
    // Far cards are large: they stay inside the section's height.
    const double margin_m = std::min(half_m, 0.45 * (section.top_m - section.base_m));
    p.y() = std::clamp(p.y(), section.base_m + 0.9 * margin_m, section.top_m - 0.7 * margin_m);
    const Eigen::Vector3d outward(0.0, normal.x(), normal.y());
    const double height = (p.y() - section.base_m) / (section.top_m - section.base_m);
    append_leaf(mesh, {u_m, p.x(), p.y()}, outward, depth, height, detail.card_length_m, random);
  }
  return mesh;
}

TriangleMesh make_crown_foliage(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_axes_m,
                                const FoliageDetail& detail, RandomStream random) {
  TriangleMesh mesh;
  const int cards = std::max(8, static_cast<int>(std::lround(detail.cards_per_m)));
  const Eigen::Vector3d inner =
      (half_axes_m.array() - 0.4 * detail.card_length_m).max(0.3 * half_axes_m.array());
  for (int i = 0; i < cards; ++i) {
    const Eigen::Vector3d direction = random_direction(random);
    const bool inside = random.uniform() < 0.15;
    const double depth = inside ? random.uniform(0.4, 0.9) : 0.4 * std::pow(random.uniform(), 1.5);
    const Eigen::Vector3d p = centre + (1.0 - depth) * direction.cwiseProduct(inner);
    const Eigen::Vector3d outward = direction.cwiseQuotient(half_axes_m).normalized();
    append_leaf(mesh, p, outward, depth, 0.5 + 0.5 * direction.z(), detail.card_length_m, random);
  }
  return mesh;
}

Material leaf_material() {
  Material material;
  material.name = "leaves";
  material.colour = {1.0f, 1.0f, 1.0f};  // the cards' own colours count
  material.texture = "builtin:vine_leaf";
  material.leaf_cards = true;
  material.roughness = 0.75f;
  return material;
}

}  // namespace vinerow::worlds
