#include "worlds/plants/vine_meshes.h"

#include <algorithm>
#include <cmath>

#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "worlds/parts/primitives.h"
#include "worlds/plants/leaf_mesh.h"

namespace vinerow::worlds {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3f kGreenShoot(0.13f, 0.2f, 0.05f), kCane(0.16f, 0.085f, 0.04f);
const Vector3d kGreenBerry(0.2, 0.3, 0.08), kWhiteBerry(0.42, 0.4, 0.1);
const Vector3d kBlackBerry(0.035, 0.02, 0.06);

/// Berries on a cone with shoulders, by the golden angle.
void append_bunch(TriangleMesh& mesh, const BunchOrgan& bunch, int level) {
  RandomStream random(bunch.seed, "", "berries");
  const Vector3d u = any_orthogonal(bunch.axis), v = bunch.axis.cross(u);
  // Far bunches have fewer and larger berries, which cover the same area.
  constexpr int kFewer[] = {1, 4, 16};
  const int berries = std::max(3, bunch.berries / kFewer[level]);
  const double larger = std::sqrt(static_cast<double>(bunch.berries) / berries);
  // Wide enough for the berries of its surface.
  const double half_m = 0.27 * bunch.length_m;
  for (int i = 0; i < berries; ++i) {
    const double t = (i + 0.5) / berries;
    const double rim = half_m * std::pow(1.0 - 0.85 * t, 0.8) * std::min(1.0, 0.45 + 4.0 * t);
    const double angle = kGoldenAngle_rad * i + 0.5 * random.uniform();
    const double out_m = rim * (0.55 + 0.45 * random.uniform());
    const Vector3d centre = bunch.stalk + (0.1 + 0.9 * t) * bunch.length_m * bunch.axis +
                            out_m * (std::cos(angle) * u + std::sin(angle) * v);
    const bool is_ripe = random.uniform() < bunch.ripe_share;
    const double shade = random.uniform(0.8, 1.2);
    const Vector3d colour = shade * (!is_ripe         ? kGreenBerry
                                     : bunch.is_black ? kBlackBerry
                                                      : kWhiteBerry);
    const double radius_m = larger * bunch.berry_radius_m * random.uniform(0.88, 1.06);
    append_sphere(mesh, centre, radius_m, colour.cast<float>());
  }
}

}  // namespace

TriangleMesh make_leaf_mesh(const std::vector<LeafOrgan>& leaves, int level) {
  constexpr std::size_t kFewer[] = {1, 2, 12};
  TriangleMesh mesh;
  for (std::size_t i = 0; i < leaves.size(); i += kFewer[level]) {
    if (level == 0) mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    // One leaf has the area of those that it stands for.
    double area_m2 = 0.0;
    for (std::size_t k = i; k < std::min(leaves.size(), i + kFewer[level]); ++k) {
      area_m2 += leaves[k].area_m2;
    }
    append_blade(mesh, LeafKind::kGrapevine, leaves[i], area_m2, level);
    if (level == 0) {
      const TubePoint stalk[] = {{leaves[i].node, 0.0013}, {leaves[i].junction, 0.001}};
      if ((leaves[i].junction - leaves[i].node).norm() > 1e-3) {
        append_tube(mesh, stalk, 3, kGreenShoot);
      }
    }
  }
  return mesh;
}

TriangleMesh make_shoot_mesh(const std::vector<ShootOrgan>& shoots, int level) {
  TriangleMesh mesh;
  for (const ShootOrgan& shoot : shoots) {
    if (level == 0) mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    std::vector<TubePoint> points;
    const std::size_t count = shoot.points.size();
    const std::size_t step = level == 0 ? 1 : 4;
    for (std::size_t i = 0; i < count; i += step) {
      const double share = static_cast<double>(i) / static_cast<double>(count - 1);
      points.push_back({shoot.points[i], shoot.radius_m * (1.0 - 0.65 * share)});
    }
    if (points.size() < 2) points.push_back({shoot.points.back(), 0.35 * shoot.radius_m});
    append_tube(mesh, points, level == 0 ? 5 : 3, shoot.is_brown ? kCane : kGreenShoot);
  }
  return mesh;
}

TriangleMesh make_bunch_mesh(const std::vector<BunchOrgan>& bunches, int level) {
  TriangleMesh mesh;
  for (const BunchOrgan& bunch : bunches) {
    if (level == 0) mesh.things.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    append_bunch(mesh, bunch, level);
  }
  return mesh;
}

}  // namespace vinerow::worlds
