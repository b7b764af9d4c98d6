#include "vehicles/urdf_rover/urdf_rover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "engine/core/error.h"
#include "engine/io/meshes/mesh_file.h"
#include "engine/math/angles.h"
#include "tests/support/data.h"
#include "tests/support/paths.h"
#include "tests/vehicles/small_worlds.h"

namespace vinerow::vehicles::urdf_rover_test {
namespace {

using namespace test;

const std::filesystem::path kPlain =
    std::filesystem::path(VINEROW_SOURCE_DIR) / "tests/vehicles/data/plain_rover.urdf";

UrdfRoverParams params_of(const std::filesystem::path& urdf,
                          const std::function<void(ParameterSet&)>& more = {}) {
  ParameterSet set(urdf_rover_spec().parameters, "urdf_rover");
  set.set("urdf", urdf.string());
  if (more) more(set);
  return read_urdf_rover_params(set, "rover");
}

/// A robot on level ground, stepped at 1 kHz.
struct Rig {
  explicit Rig(const std::filesystem::path& urdf,
               const std::function<void(ParameterSet&)>& more = {})
      : model(make_flat_world()),
        world(physics::PhysicsSettings{}, model),
        rover(params_of(urdf, more)) {
    rover.spawn(world, pose_on_ground(model, 0, 0, 0, rover.description().height_above_ground_m));
  }
  void drive(double left_radps, double right_radps) {
    std::vector<double> values;
    for (const UrdfWheel& wheel : rover.model().wheels) {
      values.push_back(wheel.left ? left_radps : right_radps);
    }
    rover.actuate(values);
  }
  /// Axle angles, and every wheel as fast as it rolls when B has this forward speed: with the
  /// curvature k and the slope q of B's velocity, (1 - k y, q + k x) at a wheel.
  void steer(double front_rad, double rear_rad, double speed_mps) {
    const UrdfRoverModel& robot = rover.model();
    const double a = robot.steering->front_m, b = robot.steering->rear_m;
    const double front = std::tan(front_rad), rear = std::tan(rear_rad);
    const double k = (front - rear) / (a + b), q = (b * front + a * rear) / (a + b);
    std::vector<double> values;
    for (const ActuatorSpec& actuator : rover.description().actuators) {
      if (actuator.unit == "rad") values.push_back(values.empty() ? front_rad : rear_rad);
      for (const UrdfWheel& wheel : robot.wheels) {
        if (actuator.name != "wheel_" + wheel.name + "_speed_radps") continue;
        const double per_speed = std::hypot(1.0 - k * wheel.hub_B.y(), q + k * wheel.hub_B.x());
        values.push_back(speed_mps * per_speed / wheel.radius_m);
      }
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

  // Each moment is possible, but the product of inertia gives 1 - 0.6, 1 and 1 + 0.6.
  io::UrdfModel skewed = io::load_urdf(kPlain);
  skewed.links[1].inertia_L.setIdentity();
  skewed.links[1].inertia_L(0, 1) = skewed.links[1].inertia_L(1, 0) = 0.6;
  EXPECT_EQ(error_of([&] { read_urdf_rover(skewed, {}); }),
            kPlain.string() +
                ": link 'base_link': the principal inertia in kg m2 = [0.4, 1, 1.6] is not "
                "possible for a rigid body: one moment is larger than the sum of the other two");

  ParameterSet half(urdf_rover_spec().parameters, "urdf_rover");
  half.set("urdf", kPlain.string());
  half.set("left_wheel_joints", std::vector<std::string>{"a"});
  EXPECT_NE(error_of([&] { read_urdf_rover_params(half, "rover"); }).find("must be given together"),
            std::string::npos);
}

/// The plain rover with a mesh in millimetres as visual, or from `after` on, and what the vehicle
/// reports.
std::string note_of_rover(const std::string& scale, const char* after = "<visual>") {
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_urdf_rover_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "hull.obj") << "v 0 0 0\nv 1000 0 0\nv 0 400 0\nv 0 0 300\nf 1 3 2\nf 1 2 "
                                        "4\nf 2 3 4\nf 1 4 3\n";
  std::ifstream plain(kPlain);
  std::string text{std::istreambuf_iterator<char>(plain), {}};
  const std::string box = "<box size=\"0.9 0.5 0.2\"/>";
  text.replace(text.find(box, text.find(after)), box.size(),
               "<mesh filename=\"hull.obj\"" + scale + "/>");
  std::ofstream(folder / "robot.urdf") << text;
  Rig rig(folder / "robot.urdf");
  SignalBus bus;
  Ports ports(bus, "rover", "rover");
  rig.rover.connect(ports);
  const auto event = bus.subscribe<Event>("rover/vehicle_event", "test");
  rig.rover.publish(Time{});
  rig.rover.publish(Time{1'000'000});
  EXPECT_EQ(event.sequence(), 1u);
  std::string note = event.value().text;
  for (std::size_t path; (path = note.find(folder.string())) != std::string::npos;) {
    note.erase(path, folder.string().size() + 1);
  }
  return note;
}

TEST(UrdfRover, ReportsOnceWhatItReplacedAndDoubtsInItsFiles) {
  const std::string replaced = "robot.urdf: $(optenv PAYLOAD_XYZ) was replaced by '0.2 0 0.22'";
  EXPECT_EQ(note_of_rover(" scale=\"0.001 0.001 0.001\""), replaced);
  EXPECT_EQ(note_of_rover(""),
            "hull.obj is read as 1000 x 400 x 300 m; if it is in millimetres, give its <mesh> in "
            "the URDF scale=\"0.001 0.001 0.001\"; " +
                replaced);
  // Too large to start anywhere: the cause in place of a row that its hull meets.
  const std::string refusal = error_of([] { note_of_rover("", "<collision>"); });
  EXPECT_NE(refusal.find("hull.obj is read as 1000 x 400 x 300 m; if it is in"), std::string::npos)
      << refusal;
}

const std::filesystem::path kCar = kPlain.parent_path() / "plain_car.urdf";
const std::filesystem::path kFourSteered = kPlain.parent_path() / "plain_four_steered.urdf";

/// Radius of the circle that B drives, from its velocity and yaw rate.
double turning_radius_m(const Rig& rig) {
  return rig.truth().v_WB_B.head<2>().norm() / rig.truth().w_WB_B.z();
}

TEST(SteeredUrdf, ReadsACarFromItsJoints) {
  const UrdfRover rover(params_of(kCar));
  const UrdfRoverModel& model = rover.model();
  // 160 kg at x = 0.5; front wheels and knuckles 16 kg at 1.2; rear wheels 24 kg at 0.
  const double com_m = (160.0 * 0.5 + 16.0 * 1.2) / 200.0;
  EXPECT_NEAR(model.com_root.x(), com_m, 1e-12);
  ASSERT_TRUE(model.steering);
  EXPECT_NEAR(model.steering->front_m, 1.2 - com_m, 1e-12);
  EXPECT_NEAR(model.steering->rear_m, com_m, 1e-12);
  EXPECT_EQ(model.steering->max_wheel_steer_rad, 0.6);
  const VehicleDescription& about = rover.description();
  std::vector<std::string> names;
  for (const ActuatorSpec& actuator : about.actuators) names.push_back(actuator.name);
  EXPECT_EQ(names, (std::vector<std::string>{"axle_front_steer_rad", "wheel_rl_speed_radps",
                                             "wheel_rr_speed_radps"}));
  EXPECT_EQ(about.wheeled->wheel_radius_m, 0.3);
  // The inner wheel, half a track nearer to the centre of the turn, is at its limit of 0.6 rad.
  const double radius_m = 1.2 / std::tan(0.6) + 0.45;
  EXPECT_NEAR(about.ackermann->max_axle_steer_rad, std::atan(1.2 / radius_m), 1e-12);
  EXPECT_NEAR(*about.min_turning_radius_m, std::hypot(radius_m, com_m), 1e-12);
  std::vector<std::string> links;
  for (const VehicleLink& link : rover.links()) links.push_back(link.name);
  EXPECT_EQ(links, (std::vector<std::string>{"body", "wheel_fl", "wheel_rl", "wheel_fr", "wheel_rr",
                                             "knuckle_fl", "knuckle_fr"}));
}

TEST(SteeredUrdf, ACarTurnsAboutItsRearAxle) {
  for (const double axle_rad : {0.1, 0.3, -0.4}) {
    Rig rig(kCar);
    rig.steer(axle_rad, 0.0, 0.45);
    rig.run(4.0);
    // Bicycle: L / tan(delta) from the middle of the rear axle; B is ahead of that.
    const double rear_m = rig.rover.model().steering->rear_m;
    const double expected_m = std::copysign(std::hypot(1.2 / std::tan(axle_rad), rear_m), axle_rad);
    EXPECT_NEAR(turning_radius_m(rig), expected_m, 0.03 * std::abs(expected_m)) << axle_rad;
    EXPECT_NEAR(rig.truth().v_WB_B.y(), rear_m * rig.truth().w_WB_B.z(), 0.01) << axle_rad;
  }
}

TEST(SteeredUrdf, WheelsStandAsAnAckermannMechanismHasThem) {
  Rig rig(kCar);
  rig.steer(rig.rover.description().ackermann->max_axle_steer_rad, 0.0, 0.15);
  rig.run(3.0);
  const auto& wheels = rig.rover.platform().state().wheels;  // fl, rl, fr, rr
  EXPECT_NEAR(wheels[0].steer_rad, 0.6, 1e-9);
  EXPECT_NEAR(wheels[2].steer_rad, std::atan(1.2 / (1.2 / std::tan(0.6) + 0.9)), 1e-9);
  EXPECT_EQ(wheels[1].steer_rad, 0.0);
  EXPECT_EQ(wheels[3].steer_rad, 0.0);
  // A knuckle is drawn as its wheel stands, without the wheel's turning.
  std::vector<Pose> X_WL(rig.rover.links().size());
  rig.rover.read_links(X_WL);
  const Eigen::Vector3d ahead_B = X_WL[0].q.conjugate() * (X_WL[5].q * Eigen::Vector3d::UnitX());
  EXPECT_NEAR(std::atan2(ahead_B.y(), ahead_B.x()), 0.6, 1e-3);
}

TEST(SteeredUrdf, FourSteeredWheelsTurnAndCrab) {
  Rig rig(kFourSteered);
  EXPECT_TRUE(rig.rover.description().steered);
  rig.steer(0.2, -0.2, 0.4);
  rig.run(4.0);
  const UrdfSteering& steering = *rig.rover.model().steering;
  const double middle_m = 0.6 / std::tan(0.2), off_m = 0.5 * (steering.rear_m - steering.front_m);
  EXPECT_NEAR(turning_radius_m(rig), std::hypot(middle_m, off_m), 0.03 * middle_m);
  Rig crab(kFourSteered);
  crab.steer(0.3, 0.3, 0.4);
  crab.run(4.0);
  const Odometry truth = crab.truth();
  EXPECT_NEAR(std::atan2(truth.v_WB_B.y(), truth.v_WB_B.x()), 0.3, 0.01);
  EXPECT_NEAR(truth.w_WB_B.z(), 0.0, 0.01);
}

std::string error_of_options(const io::UrdfModel& urdf, const UrdfRoverOptions& options = {}) {
  return error_of([&] { read_urdf_rover(urdf, options); });
}

TEST(SteeredUrdf, SaysWhatIsWrong) {
  const io::UrdfModel car = io::load_urdf(kCar);
  const std::string file = kCar.string();
  io::UrdfModel castor = car;
  for (io::UrdfJoint& joint : castor.joints) {
    if (joint.name == "front_left_joint") joint.X_PJ.p.x() = -0.1;
  }
  EXPECT_EQ(error_of_options(castor),
            file +
                ": wheel joint 'front_left_joint' trails 0.100 m behind joint "
                "'steer_front_left_joint': castors are not supported; if it is steered by a "
                "motor, name its joint in steering_joints");
  UrdfRoverOptions one;
  one.steering_joints = {"steer_front_left_joint"};
  EXPECT_EQ(error_of_options(car, one),
            file + ": 1 of 4 wheels steer (fl), must be the two front ones of four, or all four");
  UrdfRoverOptions other;
  other.steering_joints = {"body_joint"};
  EXPECT_EQ(error_of_options(car, other), file +
                                              ": steering joint 'body_joint' carries no wheel, or "
                                              "does not turn about the vertical (z)");
  other.steering_joints = {"steer_front_lef_joint"};
  EXPECT_NE(error_of_options(car, other).find("did you mean 'steer_front_left_joint'?"),
            std::string::npos);
  const auto driven = [](const char* which) {
    return [which](ParameterSet& set) { set.set("driven_wheels", std::string(which)); };
  };
  EXPECT_EQ(error_of([&] { UrdfRover(params_of(kCar, driven("all"))); }),
            file +
                ": driven wheels 'front_left_joint' and 'rear_left_joint' have radii of 0.2 and "
                "0.3 m, must be alike; or set driven_wheels = rear");
  EXPECT_EQ(error_of([&] { UrdfRover(params_of(kPlain, driven("rear"))); }),
            kPlain.string() +
                ": driven_wheels = rear is for a robot that steers by its front "
                "wheels, this one has no steered wheels");
}

TEST(Racecar, IsSteeredByItsHinges) {
  VINEROW_OUTSIDE_DATA(urdf, "bullet3/data/racecar/racecar.urdf");
  // One of its two hinges is 'continuous', both have limits of 1 rad.
  Rig rig(urdf, [](ParameterSet& set) { set.set("min_turning_radius_m", 0.1); });
  const VehicleDescription& about = rig.rover.description();
  ASSERT_TRUE(about.ackermann);
  EXPECT_NEAR(about.wheeled->wheel_base_m, 0.325, 1e-12);
  EXPECT_NEAR(about.wheeled->track_m, 0.2, 1e-12);
  EXPECT_NEAR(about.ackermann->max_axle_steer_rad, std::atan(0.325 / (0.325 / std::tan(1.0) + 0.1)),
              1e-9);
  rig.steer(0.25, 0.0, 0.5);
  rig.run(4.0);
  const double expected_m = std::hypot(0.325 / std::tan(0.25), rig.rover.model().steering->rear_m);
  EXPECT_NEAR(turning_radius_m(rig), expected_m, 0.05 * expected_m);
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
