#include "worlds/plants/tree_leaves.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
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
  Vector3d unripe, ripe;  ///< linear RGB of fruit
};

/// Apple leaves 7 to 10 by 4 to 6 cm, 25 to 40 cm2; olive leaves of some 5 cm2 (Cermak et al., Ann.
/// For. Sci. 64, 2007). Colours are chosen.
const CropFigures& figures_of(Crop crop) {
  static const CropFigures apple = {LeafKind::kApple,
                                    0.0030,
                                    0.9,
                                    {0.13, 0.23, 0.05},
                                    {0.045, 0.12, 0.03},
                                    0.07,
                                    {0.2, 0.3, 0.06},
                                    {0.42, 0.05, 0.03}};
  static const CropFigures olive = {LeafKind::kOlive,
                                    0.0005,
                                    0.3,
                                    {0.2, 0.24, 0.13},
                                    {0.08, 0.12, 0.06},
                                    0.018,
                                    {0.16, 0.2, 0.06},
                                    {0.035, 0.025, 0.04}};
  return crop == Crop::kApple ? apple : olive;
}

double volume_m3(const CrownSpace& crown) {
  return 4.0 / 3.0 * kPi * crown.half_axes_m.prod();
}

/// Evenly in the ellipsoid. @param share  of its half axes that is used
Vector3d point_in(const CrownSpace& crown, double share, RandomStream& random) {
  const Vector3d direction = random_direction(random);
  const double radius = share * std::cbrt(random.uniform());
  return crown.centre + radius * direction.cwiseProduct(crown.half_axes_m);
}

/// Share in [0, 1) of organ i, evenly spread over all of them (additive recurrence).
/// @param step  irrational; another one gives another order
double rank_of(int i, double step) {
  const double turns = step * (i + 1);
  return turns - std::floor(turns);
}
constexpr double kUnfolding = 0.6180339887498949, kFalling = 0.7548776662466927,
                 kTurning = 0.5698402909980532;

/// Leaves unfold one after the other and grow: of an area share a of the whole crown the square
/// root is in their number, the rest in their size.
double leaf_number(const TreeStage& stage) {
  return std::sqrt(stage.leaf_area);
}

/// Five petals about an axis. Flowers of apples are 3 to 4 cm wide, white with some pink (chosen).
void append_flower(TriangleMesh& mesh, const Vector3d& p, const Vector3d& axis,
                   RandomStream& random) {
  constexpr int kPetals = 5;
  constexpr double kPetal_m2 = 1.7e-4;
  const Vector3d u = any_orthogonal(axis), v = axis.cross(u);
  const double pink = random.uniform();
  for (int k = 0; k < kPetals; ++k) {
    const double angle = 2.0 * kPi * k / kPetals;
    LeafOrgan petal;
    petal.junction = petal.node = p;
    petal.along = (std::cos(angle) * u + std::sin(angle) * v + 0.35 * axis).normalized();
    petal.normal = (axis - axis.dot(petal.along) * petal.along).normalized();
    petal.colour = Vector3d(0.8, 0.78 - 0.25 * pink, 0.76 - 0.18 * pink).cast<float>();
    append_blade(mesh, LeafKind::kApple, petal, kPetal_m2, 2);
  }
}

}  // namespace

const ParameterTable<TreeLeaves>& tree_leaves_table() {
  using P = TreeLeaves;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("crop", &P::crop, {{"apple", Crop::kApple}, {"olive", Crop::kOlive}},
                  "shape, size and colour of leaves and fruit")
          .number(
              "bbch", "", &P::bbch, between(0.0, 99.0),
              "stage on the BBCH scale: 0 dormant, 65 full bloom, 75 half-grown fruit, 89 ripe, "
              "97 leaves fallen")
          .number("leaf_area_per_m3", "m2/m3", &P::leaf_area_per_m3, above(0.0, 20.0),
                  "leaf area per volume of the crown in full leaf")
          .integer("fruits", &P::fruits, between(0, 5000), "fruits of a tree")
          .rule([](const P& p) -> std::string {
            const char* fault = find_fault_in_tree_bbch(p.bbch);
            return *fault == 0 ? "" : fmt::format("bbch = {}, {}", p.bbch, fault);
          });
  return table;
}

double leaf_area_m2(const TreeLeaves& leaves, const CrownSpace& crown) {
  const TreeStage stage = tree_stage(leaves.crop, leaves.bbch);
  return leaves.leaf_area_per_m3 * volume_m3(crown) * stage.leaf_area * (1.0 - stage.fallen_share);
}

double leaf_width_m(const TreeLeaves& leaves) {
  return std::sqrt(figures_of(leaves.crop).leaf_area_m2);
}

TriangleMesh make_tree_leaves(const TreeLeaves& leaves, const CrownSpace& crown, int level,
                              RandomStream random) {
  constexpr double kFewer[] = {1.0, 4.0, 30.0};
  // The hull is lumpy: leaves stay within the least of it.
  constexpr double kShare = 0.92;
  const CropFigures& crop = figures_of(leaves.crop);
  const TreeStage stage = tree_stage(leaves.crop, leaves.bbch);
  const Vector3d autumn(0.33, 0.24, 0.04);
  const double area_m2 = leaves.leaf_area_per_m3 * volume_m3(crown);
  const double blade_m2 = kFewer[level] * crop.leaf_area_m2;
  const auto count = static_cast<int>(std::lround(area_m2 / blade_m2));
  const double number = leaf_number(stage);
  const double size = number > 0.0 ? stage.leaf_area / number : 0.0;
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    LeafOrgan leaf;
    leaf.junction = leaf.node = point_in(crown, kShare, random);
    const Vector3d out = (leaf.junction - crown.centre).normalized();
    leaf.normal =
        (crop.upward * Vector3d::UnitZ() + 0.3 * out + random_direction(random)).normalized();
    Vector3d along = out + 0.8 * random_direction(random) - 0.3 * Vector3d::UnitZ();
    along -= along.dot(leaf.normal) * leaf.normal;
    leaf.along = along.norm() > 0.1 ? along.normalized().eval() : any_orthogonal(leaf.normal);
    const double age = random.uniform(), shade = random.uniform(0.8, 1.2);
    const bool is_turned = rank_of(i, kTurning) < stage.discoloured_share;
    const Vector3d green = (1.0 - age) * crop.young + age * crop.old;
    leaf.colour = (shade * (is_turned ? autumn : green)).cast<float>();
    const double full_m2 = blade_m2 * random.uniform(0.7, 1.3);
    if (rank_of(i, kUnfolding) >= number || rank_of(i, kFalling) < stage.fallen_share) continue;
    if (level == 0) mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    append_blade(mesh, crop.kind, leaf, size * full_m2, level);
  }
  return mesh;
}

TriangleMesh make_fruit(const TreeLeaves& leaves, const CrownSpace& crown, RandomStream random) {
  const CropFigures& crop = figures_of(leaves.crop);
  const TreeStage stage = tree_stage(leaves.crop, leaves.bbch);
  TriangleMesh mesh;
  const auto begin_thing = [&] {
    mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
  };
  // Three clusters of five flowers for each fruit that stays (chosen).
  constexpr int kClusters = 3, kFlowers = 5;
  for (int i = 0; i < leaves.fruits; ++i) {
    const Vector3d p = point_in(crown, 0.95, random);
    const double radius_m =
        0.5 * crop.fruit_diameter_m * stage.fruit_diameter * random.uniform(0.85, 1.1);
    const Vector3d colour = stage.ripe_share * crop.ripe + (1.0 - stage.ripe_share) * crop.unripe;
    const double shade = random.uniform(0.7, 1.2);
    if (stage.has_fruit) {
      begin_thing();
      append_sphere(mesh, p, radius_m, (shade * colour).cast<float>());
    }
    if (stage.open_flowers <= 0.0) continue;
    RandomStream petals(random.next_u64(), "", "flowers");
    for (int cluster = 0; cluster < kClusters; ++cluster) {
      const Vector3d spur = cluster == 0 ? p : point_in(crown, 0.95, petals);
      bool has_open = false;
      for (int flower = 0; flower < kFlowers; ++flower) {
        const Vector3d axis = (random_direction(petals) + 0.6 * Vector3d::UnitZ()).normalized();
        const Vector3d at = spur + 0.025 * axis;
        if (petals.uniform() >= stage.open_flowers) continue;
        if (!has_open) begin_thing();
        has_open = true;
        append_flower(mesh, at, axis, petals);
      }
    }
  }
  return mesh;
}

TriangleMesh make_twigs(const CrownSpace& crown, RandomStream random) {
  // Chosen: 25 shoots of 0.25 to 0.5 m in a cubic metre, which leave the boughs outward and turn
  // up.
  constexpr double kTwigs_per_m3 = 25.0, kRadius_m = 0.004;
  // Those of young trees do not reach far beyond their crown.
  const double longest_m = 0.6 * crown.half_axes_m.minCoeff();
  const Eigen::Vector3f bark(0.11f, 0.085f, 0.065f);
  const auto count = static_cast<int>(std::lround(kTwigs_per_m3 * volume_m3(crown)));
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vector3d base = point_in(crown, 0.7, random);
    const Vector3d out = (base - crown.centre).normalized();
    const Vector3d along = (out + 0.5 * random_direction(random)).normalized();
    const double length_m = std::min(random.uniform(0.25, 0.5), longest_m);
    const Vector3d middle = base + 0.5 * length_m * along;
    const Vector3d end = middle + 0.5 * length_m * (along + 0.6 * Vector3d::UnitZ()).normalized();
    const std::array<TubePoint, 3> twig = {TubePoint{base, kRadius_m},
                                           TubePoint{middle, 0.8 * kRadius_m},
                                           TubePoint{end, 0.4 * kRadius_m}};
    mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    append_tube(mesh, twig, 3, bark);
  }
  return mesh;
}

}  // namespace vinerow::worlds
