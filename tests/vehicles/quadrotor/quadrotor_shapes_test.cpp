// Collision shapes, outline and contacts with the canopy, against points on discs, legs and feet.

#include "vehicles/quadrotor/quadrotor_shapes.h"

#include <gtest/gtest.h>

#include "engine/physics/world_scene.h"
#include "tests/worlds/mapping/photogrammetry/cloud_scene.h"

namespace vinerow::vehicles::quadrotor_shapes_test {
namespace {

using Eigen::Vector3d;

constexpr double kFar_m = 1e3;

QuadrotorParams with(QuadrotorLayout layout) {
  QuadrotorParams params;
  params.layout = layout;
  return params;
}

/// Rims of the discs, every degree, at both faces.
std::vector<Vector3d> rim_points(const QuadrotorParams& p) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < kRotors; ++i) {
    for (int k = 0; k < 360; ++k) {
      const double turn = rad_from_deg(k);
      const Vector3d out(p.rotor_radius_m * std::cos(turn), p.rotor_radius_m * std::sin(turn), 0);
      for (const double z : {-kDiscHalfHeight_m, kDiscHalfHeight_m}) {
        points.push_back(p.hub_B(i) + out + Vector3d(0, 0, z));
      }
    }
  }
  return points;
}

TEST(QuadrotorShapes, TheBoxIsTheSmallestAroundDiscsAndFeet) {
  for (const QuadrotorLayout layout : {QuadrotorLayout::kX, QuadrotorLayout::kPlus}) {
    const QuadrotorParams p = with(layout);
    VehicleDescription about;
    describe_outline(p, about);
    Vector3d low = Vector3d::Constant(kFar_m), high = -low;
    std::vector<Vector3d> points = rim_points(p);
    for (std::size_t i = 0; i < kRotors; ++i) points.push_back(p.foot_B(i));
    for (const Vector3d& point : points) {
      low = low.cwiseMin(point);
      high = high.cwiseMax(point);
    }
    // The rim's points are up to half a degree off its farthest one.
    EXPECT_LT((about.collision_centre_B - 0.5 * (low + high)).norm(), 1e-5);
    EXPECT_LT((about.collision_half_extents_m - 0.5 * (high - low)).norm(), 1e-5);
  }
}

TEST(QuadrotorShapes, PhysicsHasADiscAtEachHubAndLegsThatGiveWay) {
  const QuadrotorParams p;
  const std::vector<physics::PlacedShape> shapes = make_quadrotor_shapes(p);
  ASSERT_EQ(shapes.size(), 6u);
  double lowest = kFar_m;
  std::size_t discs = 0;
  for (const physics::PlacedShape& placed : shapes) {
    if (const auto* box = std::get_if<physics::BoxShape>(&placed.shape)) {
      lowest = std::min(lowest, placed.X_BS.p.z() - box->half_extents_m.z());
      continue;
    }
    const auto& disc = std::get<physics::CylinderShape>(placed.shape);
    EXPECT_LT((placed.X_BS.p - p.hub_B(discs)).norm(), 1e-15);
    EXPECT_NEAR(std::abs((placed.X_BS.q * Vector3d::UnitY()).z()), 1.0, 1e-12) << "not level";
    EXPECT_EQ(disc.radius_m, p.rotor_radius_m);
    EXPECT_EQ(disc.half_width_m, kDiscHalfHeight_m);
    ++discs;
  }
  EXPECT_EQ(discs, kRotors);
  EXPECT_NEAR(lowest, -0.6 * p.stand_height_m, 1e-12);  // the feet are not of the physics
}

TEST(QuadrotorShapes, RotorsBeginTwoHalfHeightsBelowTheirPlane) {
  const QuadrotorParams p;
  EXPECT_TRUE(is_at_rotors(p, p.rotor_height_m - 0.023));
  EXPECT_FALSE(is_at_rotors(p, p.rotor_height_m - 0.025));
  EXPECT_FALSE(is_at_rotors(p, -p.stand_height_m));
}

/// True if a leaf of 1 cm at a place of B touches.
bool touches_leaf(const QuadrotorParams& p, const Vector3d& p_B) {
  const Vector3d half = Vector3d::Constant(0.005);
  const WorldModel world =
      vinerow::test::level_world(5.0, {vinerow::test::box(p_B - half, p_B + half)});
  const physics::WorldScene scene(world);
  FoliageWatch watch = make_foliage_watch(p);
  watch.start(world);
  const physics::BodyState body{Pose{}, Vector3d::Zero(), Vector3d::Zero()};
  return watch.touches(scene, body, 1e-3);
}

TEST(QuadrotorShapes, LeavesAreMetByDiscsBodyAndFeetAndNotBetween) {
  for (const QuadrotorLayout layout : {QuadrotorLayout::kX, QuadrotorLayout::kPlus}) {
    const QuadrotorParams p = with(layout);
    for (std::size_t i = 0; i < kRotors; ++i) {
      const Vector3d hub = p.hub_B(i);
      for (int k = 0; k < 36; ++k) {
        const double turn = rad_from_deg(10.0 * k);
        const Vector3d out(std::cos(turn), std::sin(turn), 0);
        EXPECT_TRUE(touches_leaf(p, hub + 0.98 * p.rotor_radius_m * out)) << i << ", " << k;
      }
      // Outwards: 3.5 % is what the boxes add, 8 mm the leaf's half diagonal.
      const Vector3d away = Vector3d(hub.x(), hub.y(), 0).normalized();
      EXPECT_FALSE(touches_leaf(p, hub + (1.036 * p.rotor_radius_m + 0.008) * away)) << i;
      EXPECT_FALSE(touches_leaf(p, hub + Vector3d(0, 0, kDiscHalfHeight_m + 0.006))) << i;
      EXPECT_TRUE(touches_leaf(p, p.foot_B(i))) << i;
      EXPECT_FALSE(touches_leaf(p, p.foot_B(i) - Vector3d(0, 0, 0.006))) << i;
      // Below a disc, beside the legs.
      EXPECT_FALSE(touches_leaf(p, hub + 0.1 * away - Vector3d(0, 0, 0.1))) << i;
    }
    EXPECT_TRUE(touches_leaf(p, Vector3d::Zero()));
  }
}

}  // namespace
}  // namespace vinerow::vehicles::quadrotor_shapes_test
