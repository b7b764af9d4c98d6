// Wing geometry in closed form; outline, physics and contacts with the canopy against its points.

#include "vehicles/fixed_wing/fixed_wing_shapes.h"

#include <gtest/gtest.h>

#include "engine/core/random.h"
#include "engine/math/polygon.h"
#include "engine/physics/world_scene.h"
#include "tests/vehicles/fixed_wing/rig.h"
#include "tests/worlds/mapping/photogrammetry/cloud_scene.h"

namespace vinerow::vehicles::fixed_wing_shapes_test {
namespace {

using Eigen::Vector3d;

TEST(FixedWingShapes, StationsAreOnAStraightSweptWing) {
  FixedWingParams p;
  p.wing.span_m = 1.0;
  p.shape.root_chord_m = 0.40;
  p.shape.tip_chord_m = 0.20;
  p.shape.leading_edge_m = 0.15;
  p.shape.sweep_rad = std::atan(0.6);
  p.shape.dihedral_rad = std::atan(0.02);
  for (const double side : {1.0, -1.0}) {
    const WingStation root = wing_station(p, 0.0, side), tip = wing_station(p, 1.0, side);
    EXPECT_LT((root.leading_B - Vector3d(0.15, 0, 0)).norm(), 1e-15);
    EXPECT_LT((tip.leading_B - Vector3d(-0.15, side * 0.5, 0.01)).norm(), 1e-15);
    EXPECT_NEAR(root.chord_m, 0.40, 1e-15);
    EXPECT_NEAR(tip.chord_m, 0.20, 1e-15);
    EXPECT_NEAR(wing_station(p, 0.25, side).chord_m, 0.35, 1e-15);
  }
}

/// Corners of the wings' and the fuselage's hulls.
std::vector<Vector3d> hull_points(const FixedWingParams& p) {
  std::vector<Vector3d> points;
  for (const physics::PlacedShape& placed : make_fixed_wing_shapes(p)) {
    if (const auto* hull = std::get_if<physics::HullShape>(&placed.shape)) {
      for (const Vector3d& point : hull->points_B) points.push_back(placed.X_BS * point);
    } else {
      const Vector3d half = std::get<physics::BoxShape>(placed.shape).half_extents_m;
      for (int k = 0; k < 8; ++k) {
        const Vector3d corner((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
        points.push_back(placed.X_BS * half.cwiseProduct(corner));
      }
    }
  }
  return points;
}

TEST(FixedWingShapes, PhysicsReachesFromTipToTipAndDownToTheBelly) {
  const FixedWingParams p;
  double left = 0.0, right = 0.0, low = 0.0, front = -1.0;
  for (const Vector3d& point : hull_points(p)) {
    left = std::max(left, point.y());
    right = std::min(right, point.y());
    low = std::min(low, point.z());
    front = std::max(front, point.x());
  }
  const double half_span_m = 0.5 * p.wing.span_m;
  EXPECT_NEAR(left, half_span_m + 0.008, 1e-12);  // the fins stand on the tips
  EXPECT_NEAR(right, -half_span_m - 0.008, 1e-12);
  EXPECT_NEAR(low, -p.shape.belly_m, 1e-12);
  EXPECT_NEAR(front, p.shape.leading_edge_m + 0.2 * p.shape.root_chord_m, 1e-12);
}

TEST(FixedWingShapes, TheOutlineHoldsThePhysicsAndIsNoLarger) {
  const FixedWingParams p;
  VehicleDescription about;
  describe_outline(p, about);
  const Vector3d low = about.collision_centre_B - about.collision_half_extents_m;
  const Vector3d high = about.collision_centre_B + about.collision_half_extents_m;
  Vector3d least = high, most = low;
  for (const Vector3d& point : hull_points(p)) {
    least = least.cwiseMin(point);
    most = most.cwiseMax(point);
  }
  constexpr double kSpare_m = 0.02;
  EXPECT_TRUE((least.array() > low.array() - 1e-9).all()) << (least - low).transpose();
  EXPECT_TRUE((most.array() < high.array() + 1e-9).all()) << (high - most).transpose();
  EXPECT_TRUE((least.array() < low.array() + kSpare_m).all()) << (least - low).transpose();
  EXPECT_TRUE((most.array() > high.array() - kSpare_m).all()) << (high - most).transpose();

  // Counter-clockwise, convex, as long and wide as the box.
  const std::vector<Eigen::Vector2d>& outline = about.footprint_B;
  Eigen::AlignedBox2d around;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2d &a = outline[k], &b = outline[(k + 1) % outline.size()],
                          &c = outline[(k + 2) % outline.size()];
    EXPECT_GT((b - a).x() * (c - b).y() - (b - a).y() * (c - b).x(), 0.0) << k;
    around.extend(a);
    for (const Vector3d& point : hull_points(p)) {
      const Eigen::Vector2d along = (b - a).normalized();
      const Eigen::Vector2d to = point.head<2>() - a;
      EXPECT_GT(along.x() * to.y() - along.y() * to.x(), -1e-9) << k << ": " << point.transpose();
    }
  }
  EXPECT_LT((around.min() - low.head<2>()).norm(), 1e-12);
  EXPECT_LT((around.max() - high.head<2>()).norm(), 1e-12);
}

/// True if a leaf of 1 cm at a place of B touches.
bool touches_leaf(const FixedWingParams& p, const Vector3d& p_B) {
  const Vector3d half = Vector3d::Constant(0.005);
  const WorldModel world =
      vinerow::test::level_world(5.0, {vinerow::test::box(p_B - half, p_B + half)});
  const physics::WorldScene scene(world);
  FoliageWatch watch = make_foliage_watch(p);
  watch.start(world);
  return watch.touches(scene, {Pose{}, Vector3d::Zero(), Vector3d::Zero()}, 1e-3);
}

TEST(FixedWingShapes, LeavesAreMetByEveryPartOfTheWing) {
  const FixedWingParams p;
  for (const double side : {1.0, -1.0}) {
    for (int k = 0; k <= 20; ++k) {
      const WingStation at = wing_station(p, k / 20.0, side);
      for (const double share : {0.0, 0.5, 1.0}) {
        const Vector3d on = at.leading_B - Vector3d(share * at.chord_m, 0, 0);
        EXPECT_TRUE(touches_leaf(p, on)) << side << ", " << k << ", " << share;
      }
    }
    // Beyond the tip, above the middle of the wing, and ahead of the sweep.
    const WingStation tip = wing_station(p, 1.0, side), middle = wing_station(p, 0.5, side);
    EXPECT_FALSE(touches_leaf(p, tip.leading_B + Vector3d(0, side * 0.006, 0)));
    EXPECT_FALSE(touches_leaf(p, middle.leading_B + Vector3d(-0.1, 0, 0.04)));
    // A box begins at most an eighth of the span times tan(sweep) ahead of the edge, 65 mm.
    EXPECT_FALSE(touches_leaf(p, tip.leading_B + Vector3d(0.075, 0, 0)));
  }
  EXPECT_TRUE(touches_leaf(p, {p.shape.leading_edge_m + 0.19 * p.shape.root_chord_m, 0, 0}));
}

/// Orientation of the first triangle of a mesh on a ray: 1 towards its start, -1 away, 0 none.
int first_side(const TriangleMesh& mesh, const Vector3d& from, const Vector3d& dir) {
  double nearest_m = 1e9;
  int side = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vector3d a = mesh.vertices[i].cast<double>();
    const Vector3d ab = mesh.vertices[j].cast<double>() - a;
    const Vector3d ac = mesh.vertices[k].cast<double>() - a;
    const Vector3d normal = ab.cross(ac);
    const double along = normal.dot(dir);
    if (along == 0.0) continue;
    const double t = normal.dot(a - from) / along;
    if (t < 0.0 || t > nearest_m) continue;
    const Vector3d p = from + t * dir - a;
    const double area2 = normal.squaredNorm();
    const double v = p.cross(ac).dot(normal) / area2, w = ab.cross(p).dot(normal) / area2;
    if (v < 0.0 || w < 0.0 || v + w > 1.0) continue;
    nearest_m = t;
    side = along < 0.0 ? 1 : -1;
  }
  return side;
}

TEST(FixedWingShapes, TrianglesAreTurnedOutwards) {
  test::WingRig rig;
  RandomStream random(5, "test", "rays");
  for (const VehicleLink& link : rig.vehicle.links()) {
    if (!link.mesh || link.name.find("propeller") != std::string::npos) continue;
    const Eigen::AlignedBox3d box = link.mesh->bounds();
    int front = 0, back = 0;
    for (int n = 0; n < 400; ++n) {
      const auto number = [&] { return random.uniform(-1.0, 1.0); };
      const Vector3d from =
          box.center() + 3.0 * Vector3d(number(), number(), number()).normalized();
      const Vector3d half = 0.5 * box.sizes();
      const Vector3d to = box.center() + half.cwiseProduct(Vector3d(number(), number(), number()));
      const int side = first_side(*link.mesh, from, (to - from).normalized());
      front += side > 0;
      back += side < 0;
    }
    EXPECT_EQ(back, 0) << link.name;
    EXPECT_GT(front, 20) << link.name;
  }
}

}  // namespace
}  // namespace vinerow::vehicles::fixed_wing_shapes_test
