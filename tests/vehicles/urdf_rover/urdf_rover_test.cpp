#include "vehicles/urdf_rover/urdf_rover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "engine/core/error.h"
#include "engine/io/mesh_file.h"
#include "engine/math/angles.h"
#include "tests/support/data.h"
#include "tests/support/paths.h"
#include "tests/vehicles/small_worlds.h"

namespace vinerow::vehicles::urdf_rover_test {
namespace {

using namespace test;

const std::filesystem::path kPlain =
    std::filesystem::path(VINEROW_SOURCE_DIR) / "tests/vehicles/data/plain_rover.urdf";

UrdfRoverParams params_of(const std::filesystem::path& urdf) {
  ParameterSet set(urdf_rover_spec().parameters, "urdf_rover");
  set.set("urdf", urdf.string());
  return read_urdf_rover_params(set, "rover");
}

/// A robot on level ground, stepped at 1 kHz.
struct Rig {
  explicit Rig(const std::filesystem::path& urdf)
      : model(make_flat_world()), world(physics::PhysicsSettings{}, model), rover(params_of(urdf)) {
    rover.spawn(world, pose_on_ground(model, 0, 0, 0, rover.description().height_above_ground_m));
  }
  void drive(double left_radps, double right_radps) {
    std::vector<double> values;
    for (const UrdfWheel& wheel : rover.model().wheels) {
      values.push_back(wheel.left ? left_radps : right_radps);
    }
    rover.actuate(values);
  }
  void run(double time_s) {
    for (auto i = std::llround(time_s * 1000); i > 0; --i) {
      rover.before_physics({}, dt);
      world.step(dt);
      rover.after_physics({}, dt);
    }
  }
  Odometry truth() const {
    Odometry truth;
    rover.read_truth(truth);
    return truth;
  }
  /// Turns on the spot until the heading has changed by `angle_rad` (positive left).
  void turn(double angle_rad) {
    const double start = yaw_from_quaternion(truth().X_WB.q);
    const double sign = angle_rad > 0.0 ? 1.0 : -1.0;
    drive(-2.0 * sign, 2.0 * sign);
    double turned = 0.0;
    for (int i = 0; i < 60000 && std::abs(turned) < std::abs(angle_rad); ++i) {
      run(0.001);
      turned = wrap_angle(yaw_from_quaternion(truth().X_WB.q) - start);
    }
    drive(0, 0);
    run(0.5);
  }

  WorldModel model;
  physics::PhysicsWorld world;
  UrdfRover rover;
  Duration dt{1'000'000};
};

double total_load_N(const UrdfRover& rover) {
  double sum = 0.0;
  for (const WheelOutput& out : rover.platform().outputs()) sum += out.load_N;
  return sum;
}

TEST(UrdfRover, MergesMassesByHand) {
  const UrdfRoverModel model = read_urdf_rover(io::load_urdf(kPlain), {});
  EXPECT_DOUBLE_EQ(model.mass_kg, 50.0);
  // x: (30 * -0.05 + 10 * 0.2) / 50; z above base: (30 * 0.1 + 10 * (0.22 + 0.1)) / 50.
  EXPECT_NEAR(model.com_root.x(), 0.01, 1e-12);
  EXPECT_NEAR(model.com_root.z(), 0.16 + 0.124, 1e-12);
  // About z: own inertias plus m d^2 in the plane.
  const double izz = 2.0 + 0.1 + 4 * 0.018 + 30 * 0.06 * 0.06 + 10 * 0.19 * 0.19 +
                     2 * 2.5 * (0.24 * 0.24 + 0.09) + 2 * 2.5 * (0.26 * 0.26 + 0.09);
  EXPECT_NEAR(model.inertia_B(2, 2), izz, 1e-9);
  EXPECT_NEAR(model.track_m, 0.6, 1e-12);
  EXPECT_NEAR(model.wheel_base_m, 0.5, 1e-12);
  EXPECT_NEAR(model.height_above_ground_m, 0.284, 1e-12);
  ASSERT_EQ(model.wheels.size(), 4u);
  EXPECT_EQ(model.wheels[0].name, "fl");
  EXPECT_EQ(model.wheels[0].joint, "front_left_joint");
  EXPECT_EQ(model.wheels[1].name, "rl");
  EXPECT_EQ(model.wheels[2].name, "fr");
  EXPECT_NEAR(model.wheels[0].radius_m, 0.16, 1e-12);
  EXPECT_NEAR(model.wheels[0].spin_inertia_kgm2, 0.032, 1e-12);
}

TEST(UrdfRover, NamedJointsAndRadiusOverrideTheGuess) {
  UrdfRoverOptions options;
  options.left_joints = {"front_left_joint", "rear_left_joint"};
  options.right_joints = {"front_right_joint", "rear_right_joint"};
  options.wheel_radius_m = 0.2;
  const UrdfRoverModel model = read_urdf_rover(io::load_urdf(kPlain), options);
  EXPECT_EQ(model.wheels.size(), 4u);
  EXPECT_EQ(model.wheels[0].radius_m, 0.2);
}

TEST(UrdfRover, DrawnWheelRollsForwardWhicheverWayItsJointPoints) {
  Rig rig(kPlain);
  rig.drive(2.0, 2.0);
  rig.run(2.0);
  EXPECT_GT(rig.truth().X_WB.p.x(), 0.4);
  EXPECT_NEAR(rig.truth().X_WB.p.y(), 0.0, 1e-3);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(rig.rover.platform().state().wheels[i].spin_radps, 2.0, 0.05);
  }
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(UrdfRover, SaysWhatIsWrong) {
  EXPECT_NE(error_of([] { io::load_urdf("nowhere.urdf"); }).find("does not exist"),
            std::string::npos);

  UrdfRoverOptions options;
  options.left_joints = {"front_left_join"};
  options.right_joints = {"front_right_joint"};
  const std::string unknown = error_of([&] { read_urdf_rover(io::load_urdf(kPlain), options); });
  EXPECT_NE(unknown.find("no joint 'front_left_join'; did you mean 'front_left_joint'?"),
            std::string::npos)
      << unknown;

  io::UrdfModel fixed = io::load_urdf(kPlain);
  for (io::UrdfJoint& joint : fixed.joints) joint.kind = io::UrdfJointKind::kFixed;
  EXPECT_NE(error_of([&] { read_urdf_rover(fixed, {}); }).find("no wheel joints"),
            std::string::npos);

  io::UrdfModel light = io::load_urdf(kPlain);
  for (io::UrdfLink& link : light.links) link.mass_kg = 0.0;
  EXPECT_NE(error_of([&] { read_urdf_rover(light, {}); }).find("masses sum to 0 kg, must be > 0"),
            std::string::npos);

  ParameterSet half(urdf_rover_spec().parameters, "urdf_rover");
  half.set("urdf", kPlain.string());
  half.set("left_wheel_joints", std::vector<std::string>{"a"});
  EXPECT_NE(error_of([&] { read_urdf_rover_params(half, "rover"); }).find("must be given together"),
            std::string::npos);
}

TEST(Husky, HasItsOwnMassesAndWheelRadius) {
  VINEROW_OUTSIDE_DATA(urdf, "bullet3/data/husky/husky.urdf");
  Rig rig(urdf);
  const UrdfRoverModel& model = rig.rover.model();
  EXPECT_NEAR(model.mass_kg, 33.455 + 4 * 2.637, 1e-9);
  for (const UrdfWheel& wheel : model.wheels) EXPECT_NEAR(wheel.radius_m, 0.17775, 1e-9);
  // The wheel's mesh is as large as its collision cylinder.
  const io::MeshFile mesh = io::load_mesh(urdf.parent_path() / "meshes/wheel.stl");
  EXPECT_NEAR(0.5 * mesh.bounds().sizes().x(), 0.17775, 0.002);
  rig.run(2.0);
  const double weight = model.mass_kg * 9.80665;
  EXPECT_NEAR(total_load_N(rig.rover), weight, 0.01 * weight);
}

TEST(Husky, DrivesASquareAndACircle) {
  VINEROW_OUTSIDE_DATA(urdf, "bullet3/data/husky/husky.urdf");
  Rig rig(urdf);
  for (int side = 0; side < 4; ++side) {
    rig.drive(4.0, 4.0);
    rig.run(3.0);
    rig.drive(0, 0);
    rig.run(0.7);
    rig.turn(0.5 * kPi - 0.02);
  }
  // Turning on the spot shifts a skid-steered robot a little; the sides are 2.1 m long.
  EXPECT_LT(rig.truth().X_WB.p.head<2>().norm(), 0.35);
  EXPECT_NEAR(rig.truth().X_WB.p.z(), rig.rover.description().height_above_ground_m, 2e-3);

  // Circle: constant wheel speeds give a constant radius; compare three points with the fourth.
  rig.drive(2.0, 4.0);
  rig.run(3.0);
  const double v = rig.truth().v_WB_B.head<2>().norm(), w = rig.truth().w_WB_B.z();
  const double radius = v / w;
  Eigen::AlignedBox2d box;
  for (int i = 0; i < static_cast<int>(2.0 * kPi / w / 0.01) + 1; ++i) {
    rig.run(0.01);
    box.extend(Eigen::Vector2d(rig.truth().X_WB.p.head<2>()));
  }
  EXPECT_NEAR(0.5 * box.sizes().x(), radius, 0.02 * radius);
  EXPECT_NEAR(0.5 * box.sizes().y(), radius, 0.02 * radius);
}

}  // namespace
}  // namespace vinerow::vehicles::urdf_rover_test
