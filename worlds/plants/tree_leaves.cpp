#include "worlds/plants/tree_leaves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/api/mesh.h"
#include "engine/api/parameter_table.h"
#include "engine/math/angles.h"
#include "worlds/parts/primitives.h"
#include "worlds/plants/leaf_mesh.h"

namespace vinerow::worlds {
namespace {

using Eigen::Vector3d;

struct CropFigures {
  LeafKind kind;
  double leaf_area_m2;
  double upward;        ///< how much blades turn up, against one of any direction
  Vector3d young, old;  ///< linear RGB of leaves
  double fruit_diameter_m;
  Vector3d fruit;  ///< linear RGB
};

/// Apple leaves 7 to 10 by 4 to 6 cm, 25 to 40 cm2; olive leaves of some 5 cm2 (Cermak et al., Ann.
/// For. Sci. 64, 2007). Colours are chosen.
const CropFigures& figures_of(Crop crop) {
  static const CropFigures apple = {
      LeafKind::kApple,  0.0030, 0.9, {0.13, 0.23, 0.05}, {0.045, 0.12, 0.03}, 0.07,
      {0.42, 0.05, 0.03}};
  static const CropFigures olive = {
      LeafKind::kOlive, 0.0005, 0.3, {0.2, 0.24, 0.13}, {0.08, 0.12, 0.06}, 0.018,
      {0.16, 0.2, 0.06}};
  return crop == Crop::kApple ? apple : olive;
}

/// Evenly in the ellipsoid. @param share  of its half axes that is used
Vector3d point_in(const CrownSpace& crown, double share, RandomStream& random) {
  const Vector3d direction = random_direction(random);
  const double radius = share * std::cbrt(random.uniform());
  return crown.centre + radius * direction.cwiseProduct(crown.half_axes_m);
}

}  // namespace

const ParameterTable<TreeLeaves>& tree_leaves_table() {
  using P = TreeLeaves;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("crop", &P::crop, {{"apple", Crop::kApple}, {"olive", Crop::kOlive}},
                  "shape, size and colour of leaves and fruit")
          .number("leaf_area_per_m3", "m2/m3", &P::leaf_area_per_m3, above(0.0, 20.0),
                  "leaf area per volume of the crown")
          .integer("fruits", &P::fruits, between(0, 5000), "fruits of a tree");
  return table;
}

TriangleMesh make_tree_leaves(const TreeLeaves& leaves, const CrownSpace& crown, int level,
                              RandomStream random) {
  constexpr double kFewer[] = {1.0, 4.0, 30.0};
  // The hull is lumpy: leaves stay within the least of it.
  constexpr double kShare = 0.92;
  const CropFigures& crop = figures_of(leaves.crop);
  const double volume_m3 = 4.0 / 3.0 * kPi * crown.half_axes_m.prod();
  const double area_m2 = leaves.leaf_area_per_m3 * volume_m3;
  const double blade_m2 = kFewer[level] * crop.leaf_area_m2;
  const auto count = static_cast<int>(std::lround(area_m2 / blade_m2));
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    if (level == 0) mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    LeafOrgan leaf;
    leaf.junction = leaf.node = point_in(crown, kShare, random);
    const Vector3d out = (leaf.junction - crown.centre).normalized();
    leaf.normal =
        (crop.upward * Vector3d::UnitZ() + 0.3 * out + random_direction(random)).normalized();
    Vector3d along = out + 0.8 * random_direction(random) - 0.3 * Vector3d::UnitZ();
    along -= along.dot(leaf.normal) * leaf.normal;
    leaf.along = along.norm() > 0.1 ? along.normalized().eval() : any_orthogonal(leaf.normal);
    const double age = random.uniform();
    leaf.colour =
        (random.uniform(0.8, 1.2) * ((1.0 - age) * crop.young + age * crop.old)).cast<float>();
    append_blade(mesh, crop.kind, leaf, blade_m2 * random.uniform(0.7, 1.3), level);
  }
  return mesh;
}

TriangleMesh make_fruit(const TreeLeaves& leaves, const CrownSpace& crown, RandomStream random) {
  const CropFigures& crop = figures_of(leaves.crop);
  TriangleMesh mesh;
  for (int i = 0; i < leaves.fruits; ++i) {
    mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    const Vector3d p = point_in(crown, 0.95, random);
    const double radius_m = 0.5 * crop.fruit_diameter_m * random.uniform(0.85, 1.1);
    append_sphere(mesh, p, radius_m, (random.uniform(0.7, 1.2) * crop.fruit).cast<float>());
  }
  return mesh;
}

}  // namespace vinerow::worlds
