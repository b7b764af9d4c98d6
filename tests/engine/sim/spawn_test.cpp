#include "engine/sim/spawn.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/api/map.h"
#include "engine/api/mesh.h"
#include "engine/api/vehicle.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/physics/world_scene.h"
#include "engine/sim/camera_check.h"

namespace vinerow::spawn_test {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

MeshInstance instance_of(const std::string& name, TriangleMesh mesh, SurfaceClass surface) {
  MeshInstance instance;
  instance.name = name;
  instance.mesh = std::make_shared<TriangleMesh>(std::move(mesh));
  instance.surface = surface;
  return instance;
}

/// A sheet z = at + slope x over 40 m x 40 m around the origin.
TriangleMesh sheet(float at, float slope, float half = 20.0f) {
  TriangleMesh mesh;
  for (const float y : {-half, half}) {
    for (const float x : {-half, half}) mesh.vertices.emplace_back(x, y, at + slope * x);
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
  return mesh;
}

/// A box from low to high.
TriangleMesh block(const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.emplace_back(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(),
                               k & 4 ? high.z() : low.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A rover's box of 1.5 m x 1 m x 0.6 m, 0.3 m above its wheels' feet.
VehicleDescription rover() {
  VehicleDescription description;
  description.collision_half_extents_m = {0.75, 0.5, 0.3};
  description.collision_centre_B = {0.0, 0.0, 0.2};
  description.height_above_ground_m = 0.4;
  description.wheeled.emplace();
  return description;
}

struct Start {
  scenario::SpawnConfig spawn;
  WorldModel world;

  Start() {
    spawn.p_W = Eigen::Vector2d(0.0, 0.0);
    spawn.where = {"s.yaml", 7};
  }
  Pose pose() const {
    return find_spawn_pose(spawn, world, physics::WorldScene(world), "rover", 0.4);
  }
  std::string fault(const std::vector<StartBox>& others = {}) const {
    try {
      const physics::WorldScene scene(world);
      const Pose X_WB = find_spawn_pose(spawn, world, scene, "rover", 0.4);
      refuse_start_in_contact(spawn, find_start_box("rover", X_WB, rover()), others, world, scene);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "none";
  }
};

double tilt_deg(const Pose& pose) {
  return deg_from_rad(std::acos((pose.q * Vector3d::UnitZ()).z()));
}

TEST(Spawn, StandsOnMeshesBelowZero) {
  for (const float at : {0.0f, -3.0f, -800.0f}) {
    Start start;
    start.world.meshes.push_back(instance_of("hill", sheet(at, 0.1f), SurfaceClass::kTerrain));
    const Pose pose = start.pose();
    const Vector3d normal = Vector3d(-0.1, 0.0, 1.0).normalized();
    EXPECT_LT((pose.p - Vector3d(0, 0, at) - 0.4 * normal).norm(), 1e-4) << at;
    EXPECT_NEAR(tilt_deg(pose), deg_from_rad(std::atan(0.1)), 1e-4);
    EXPECT_EQ(start.fault(), "none");
  }
}

TEST(Spawn, InAnAlleyIsMovedAndTurnedToTheLeftAsItHeads) {
  Start start;
  start.spawn.p_W.reset();
  start.spawn.alley = 0;
  start.world.meshes.push_back(instance_of("ground", sheet(0.0f, 0.0f), SurfaceClass::kTerrain));
  RowMap rows;
  rows.alleys.push_back({.id = 0, .line_W = {{1.0, 2.0, 0.0}, {1.0, 8.0, 0.0}}});  // northwards
  start.world.rows = std::move(rows);
  start.spawn.offset_m = -1.0;
  start.spawn.lateral_m = 0.25;
  start.spawn.turn_rad = 0.1;
  const Pose into = start.pose();
  EXPECT_LT((into.p.head<2>() - Eigen::Vector2d(0.75, 3.0)).norm(), 1e-12);
  EXPECT_NEAR(yaw_from_quaternion(into.q), 0.5 * kPi + 0.1, 1e-12);
  start.spawn.reverse = true;
  const Pose back = start.pose();
  EXPECT_LT((back.p.head<2>() - Eigen::Vector2d(1.25, 7.0)).norm(), 1e-12);
  EXPECT_NEAR(yaw_from_quaternion(back.q), -0.5 * kPi + 0.1, 1e-12);
}

TEST(Spawn, IsTiltedByTheGroundAndNotByWhatStandsOnIt) {
  const auto tilt_next_to = [](const MeshInstance& thing) {
    Start start;
    start.world.meshes.push_back(instance_of("ground", sheet(-2.0f, 0.0f), SurfaceClass::kTerrain));
    start.world.meshes.push_back(thing);
    return tilt_deg(start.pose());
  };
  // Half a metre ahead: what the slope was measured on.
  const TriangleMesh crate = block({0.45f, -1.0f, -2.0f}, {1.5f, 1.0f, -1.4f});
  EXPECT_LT(tilt_next_to(instance_of("crate", crate, SurfaceClass::kObstacle)), 1e-6);
  EXPECT_LT(tilt_next_to(instance_of("canopy", crate, SurfaceClass::kCanopy)), 1e-6);
  // A wall that is part of the terrain rises by more than 45 deg; a step of 0.3 m does not.
  EXPECT_LT(tilt_next_to(instance_of("wall", crate, SurfaceClass::kTerrain)), 1e-6);
  const TriangleMesh step = block({0.45f, -9.0f, -2.0f}, {9.0f, 9.0f, -1.7f});
  EXPECT_NEAR(tilt_next_to(instance_of("step", step, SurfaceClass::kTerrain)),
              deg_from_rad(std::atan(0.3 / 1.0)), 1e-4);
}

TEST(Spawn, StandsBelowARoofThatIsNoTerrain) {
  Start start;
  start.world.meshes.push_back(instance_of("ground", sheet(-2.0f, 0.0f), SurfaceClass::kTerrain));
  start.world.meshes.push_back(instance_of("roof", sheet(3.0f, 0.2f), SurfaceClass::kObstacle));
  EXPECT_NEAR(start.pose().p.z(), -1.6, 1e-6);
  // A world whose files do not say what is ground has obstacles to stand on.
  Start unnamed;
  unnamed.world.meshes.push_back(
      instance_of("ground", sheet(-2.0f, 0.0f), SurfaceClass::kObstacle));
  EXPECT_NEAR(unnamed.pose().p.z(), -1.6, 1e-6);
  EXPECT_EQ(unnamed.fault(), "none");
}

TEST(Spawn, RefusesAStartWithinASolidThatItDoesNotTouch) {
  Start start;
  start.world.meshes.push_back(instance_of("ground", sheet(0.0f, 0.0f), SurfaceClass::kTerrain));
  const TriangleMesh house = block({-5.0f, -4.0f, -1.0f}, {5.0f, 4.0f, 3.0f});
  start.world.meshes.push_back(instance_of("house", house, SurfaceClass::kObstacle));
  // Above it is a roof, which does not contain it.
  start.world.meshes.push_back(instance_of("roof", sheet(2.0f, 0.0f), SurfaceClass::kCanopy));
  EXPECT_EQ(start.fault(),
            "s.yaml:7: vehicles.rover.spawn: at x = 0.000 m, y = 0.000 m the vehicle would stand "
            "in the obstacle 'house'; move it");
  TriangleMesh open = house;
  open.triangles.erase(open.triangles.begin() + 4);
  start.world.meshes[1].mesh = std::make_shared<TriangleMesh>(open);
  EXPECT_EQ(start.fault(), "none");
}

TEST(Spawn, RefusesAStartInContactByName) {
  const auto fault_with = [](const MeshInstance& thing) {
    Start start;
    start.world.meshes.push_back(instance_of("ground", sheet(0.0f, 0.0f), SurfaceClass::kTerrain));
    start.world.meshes.push_back(thing);
    return start.fault();
  };
  const TriangleMesh inside = block({0.6f, -0.2f, 0.0f}, {1.0f, 0.2f, 1.0f});
  EXPECT_EQ(fault_with(instance_of("row_2", inside, SurfaceClass::kCanopy)),
            "s.yaml:7: vehicles.rover.spawn: at x = 0.000 m, y = 0.000 m the vehicle would stand "
            "in the canopy 'row_2'; move it");
  for (const SurfaceClass surface :
       {SurfaceClass::kPost, SurfaceClass::kTrunk, SurfaceClass::kObstacle}) {
    EXPECT_THAT(fault_with(instance_of("thing", inside, surface)),
                HasSubstr(std::string("in the ") + to_string(surface) + " 'thing'"));
  }
  EXPECT_THAT(fault_with(instance_of("fence", inside, SurfaceClass::kTerrain)),
              HasSubstr("in the terrain 'fence'"));
  // A low crate reaches the wheels alone; beside the box there is room.
  const TriangleMesh low = block({0.6f, -0.2f, 0.0f}, {1.0f, 0.2f, 0.1f});
  EXPECT_THAT(fault_with(instance_of("low", low, SurfaceClass::kObstacle)), HasSubstr("'low'"));
  const TriangleMesh adjacent = block({0.76f, -0.2f, 0.0f}, {1.0f, 0.2f, 1.0f});
  EXPECT_EQ(fault_with(instance_of("beside", adjacent, SurfaceClass::kObstacle)), "none");
}

TEST(Spawn, RefusesTwoVehiclesOnOneSpot) {
  Start start;
  start.world.meshes.push_back(instance_of("ground", sheet(0.0f, 0.0f), SurfaceClass::kTerrain));
  const auto other_at = [](double x) {
    Pose X_WB;
    X_WB.p = {x, 0.0, 0.4};
    return find_start_box("drone", X_WB, rover());
  };
  EXPECT_EQ(start.fault({other_at(0.5)}),
            "s.yaml:7: vehicles.rover.spawn: at x = 0.000 m, y = 0.000 m the vehicle would stand "
            "in vehicle 'drone', which starts at x = 0.500 m, y = 0.000 m; move one of them");
  EXPECT_EQ(start.fault({other_at(1.51)}), "none");
}

TEST(Camera, IsRefusedBelowTheGroundAndInsideAnObstacle) {
  WorldModel world;
  world.meshes.push_back(instance_of("hill", sheet(-5.0f, 0.0f), SurfaceClass::kTerrain));
  world.meshes.push_back(instance_of("shed", block({1.0f, -2.0f, -6.0f}, {5.0f, 2.0f, -1.0f}),
                                     SurfaceClass::kObstacle));
  const physics::WorldScene scene(world);
  const auto fault_at = [&](const Vector3d& p) {
    scenario::PicturesConfig pictures;
    scenario::CameraConfig camera;
    camera.name = "gate";
    camera.kind = scenario::CameraKind::kFixed;
    camera.where = {"s.yaml", 30};
    camera.p_W = p;
    pictures.cameras.push_back(camera);
    try {
      refuse_hidden_cameras(pictures, world, scene);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(fault_at({0.0, 0.0, 2.0}), "none");
  EXPECT_EQ(fault_at({3.0, 0.0, 2.0}),
            "s.yaml:30: camera 'gate' would be inside the obstacle 'shed'; the height in "
            "position_m = [3, 0, 2] is measured from the ground");
  EXPECT_EQ(fault_at({3.0, 0.0, 6.0}), "none") << "above the shed";
}

}  // namespace
}  // namespace vinerow::spawn_test
