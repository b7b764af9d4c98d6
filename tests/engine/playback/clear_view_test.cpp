#include "engine/playback/clear_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/api/mesh.h"
#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "engine/physics/world_scene.h"

namespace vinerow::playback::clear_view_test {
namespace {

using Eigen::Vector3d;

constexpr double kAspect = 16.0 / 9.0;

/// An upright wall across x from z = 0 to `height_m`, 20 m wide.
WorldModel walled(double x, double height_m) {
  WorldModel world;
  auto mesh = std::make_shared<TriangleMesh>();
  const auto h = static_cast<float>(height_m);
  mesh->vertices = {{0, -10, 0}, {0, 10, 0}, {0, 10, h}, {0, -10, h}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  MeshInstance wall;
  wall.name = "wall";
  wall.mesh = mesh;
  wall.surface = SurfaceClass::kCanopy;
  wall.X_WM.p = {x, 0, 0};
  world.meshes.push_back(wall);
  return world;
}

/// A column of points above the origin, from the ground to 2 m.
Subject column() {
  Subject subject;
  for (int k = 0; k <= 20; ++k) subject.points_W.emplace_back(0, 0, 0.1 * k);
  return subject;
}

// Eye 6 m behind at 2 m, wall 3 m behind: it hides what lies below the line from the eye over its
// top. A wall of 1.5 m ends that line at 1 m above the origin (similar triangles), half of 2 m.
TEST(ClearView, TheShareThatIsSeenIsThatAboveTheLineOverTheWall) {
  const WorldModel world = walled(-3.0, 1.5);
  const physics::WorldScene scene(world);
  const render::Camera camera = render::look_at({-6, 0, 2}, {0, 0, 1});
  EXPECT_NEAR(judge_view(camera, kAspect, column(), scene).seen, 0.5, 0.05);
  EXPECT_EQ(judge_view(camera, kAspect, column(), scene).near, 0.0);
  const WorldModel low = walled(-3.0, 0.9);
  EXPECT_EQ(judge_view(camera, kAspect, column(), physics::WorldScene(low)).seen, 1.0);
}

TEST(ClearView, WhatLiesOutsideThePictureIsNotSeen) {
  const WorldModel world = walled(50.0, 1.0);
  const physics::WorldScene scene(world);
  EXPECT_EQ(judge_view(render::look_at({-6, 0, 2}, {-12, 0, 1}), kAspect, column(), scene).seen,
            0.0);
}

TEST(ClearView, WhatIsAnArmsLengthFromTheEyeFillsThePicture) {
  const WorldModel world = walled(-5.0, 8.0);  // 1 m before the eye, higher than the view
  const physics::WorldScene scene(world);
  const ViewQuality quality =
      judge_view(render::look_at({-6, 0, 2}, {0, 0, 2}, 0.5), kAspect, column(), scene);
  EXPECT_GT(quality.near, 0.95);
  EXPECT_EQ(quality.seen, 0.0);
}

TEST(ClearView, AVehicleInFrontOfAnotherCannotBeToldFromIt) {
  const WorldModel world = walled(50.0, 1.0);
  const physics::WorldScene scene(world);
  Subject subject;
  for (const double y : {-0.5, 0.5}) {
    for (const double z : {0.0, 1.0}) subject.points_W.emplace_back(0, y, z);
  }
  // The same shape, as seen from an eye far away at the same height: first beside it, then with
  // half of it behind it.
  const render::Camera camera = render::look_at({-500, 0, 0.5}, {0, 0, 0.5}, 0.02);
  const auto shifted = [&](double dy) {
    std::vector<Vector3d> points = subject.points_W;
    for (Vector3d& p : points) p += Vector3d(1, dy, 0);
    return points;
  };
  subject.others_W = {shifted(1.5)};
  EXPECT_EQ(judge_view(camera, kAspect, subject, scene).seen, 1.0);
  subject.others_W = {shifted(0.5)};
  EXPECT_NEAR(judge_view(camera, kAspect, subject, scene).seen, 0.5, 0.01);
}

TEST(ClearView, TheCameraStaysWhereItWasAskedForIfThatSees) {
  render::ChaseOptions requested;
  requested.side_rad = rad_from_deg(25.0);
  const std::vector<render::ChaseOptions> candidates = chase_candidates(requested);
  EXPECT_EQ(candidates.front().side_rad, requested.side_rad);
  EXPECT_EQ(candidates.front().height_m, requested.height_m);
  EXPECT_EQ(candidates.size(), 25u);
  const WorldModel world = walled(50.0, 1.0);
  const physics::WorldScene scene(world);
  std::vector<render::Camera> cameras;
  for (const auto& options : candidates) cameras.push_back(render::chase_camera(Pose{}, options));
  EXPECT_EQ(find_clear_view(cameras, kAspect, column(), scene).X_WC.p, cameras[0].X_WC.p);
}

TEST(ClearView, TheCameraRisesOverAWallThatHidesTheVehicle) {
  render::ChaseOptions requested;
  requested.distance_m = 5.0;
  requested.height_m = 1.0;
  const WorldModel world = walled(-2.5, 1.5);
  const physics::WorldScene scene(world);
  std::vector<render::Camera> cameras;
  for (const auto& options : chase_candidates(requested)) {
    cameras.push_back(render::chase_camera(Pose{}, options));
  }
  EXPECT_LT(judge_view(cameras[0], kAspect, column(), scene).seen, 0.1);
  const render::Camera chosen = find_clear_view(cameras, kAspect, column(), scene);
  EXPECT_GT(chosen.X_WC.p.z(), 2.0);
  EXPECT_GE(judge_view(chosen, kAspect, column(), scene).seen, 0.75);
}

TEST(ClearView, WhereNoPlaceSeesTheVehicleTheBestIsTaken) {
  const WorldModel world = walled(-2.5, 30.0);
  const physics::WorldScene scene(world);
  const std::vector<render::Camera> cameras = {render::look_at({-5, 0, 1}, {0, 0, 1}),
                                               render::look_at({-3, 0, 1}, {0, 0, 1})};
  // From neither is anything seen; the second has the wall before its lens.
  EXPECT_EQ(find_clear_view(cameras, kAspect, column(), scene).X_WC.p, cameras[0].X_WC.p);
}

TEST(ClearView, PointsLieInsideEachLinksBox) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{-1, -2, 0}, {1, 2, 0}, {0, 0, 1}};
  mesh->triangles = {{0, 1, 2}};
  VehicleLink link;
  link.mesh = mesh;
  const std::vector<Vector3d> points =
      points_of({link, VehicleLink{}}, {Pose{Eigen::Quaterniond::Identity(), {10, 0, 0}}, Pose{}});
  ASSERT_EQ(points.size(), 9u) << "a link without a mesh has none";
  const Eigen::AlignedBox3d box(Vector3d(9, -2, 0), Vector3d(11, 2, 1));
  for (const Vector3d& p : points) EXPECT_TRUE(box.contains(p)) << p.transpose();
}

}  // namespace
}  // namespace vinerow::playback::clear_view_test
