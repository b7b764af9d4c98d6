/// Geometry, description and parameters.

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "tests/vehicles/quadrotor/rig.h"
#include "vehicles/quadrotor/quadrotor_mesh.h"

namespace vinerow::vehicles::layout_test {
namespace {

using namespace test;

/// Signs of the angular acceleration about x, y, z when a rotor turns faster than the others. From
/// the figure of paper C: rotors 1 and 3 turn counter-clockwise, so the body turns clockwise.
struct Turn {
  int roll, pitch, yaw;
};

Turn measured_turn(const QuadrotorParams& params, std::size_t rotor) {
  QuadrotorRig rig(params);
  std::array<double, kRotors> speeds;
  speeds.fill(280.0);
  speeds[rotor] = 300.0;
  physics::BodyState state;
  state.X_WB.p.z() = 50.0;
  state.v_WB_W.setZero();
  state.w_WB_W.setZero();
  rig.fly(state, speeds);
  rig.run(0.02);
  const Eigen::Vector3d w = rig.rates_B();
  const auto sign = [&](double x) { return std::abs(x) < 1e-2 * w.norm() ? 0 : (x > 0 ? 1 : -1); };
  return {sign(w.x()), sign(w.y()), sign(w.z())};
}

TEST(QuadrotorLayout, EveryRotorOfAnXTurnsTheBodyItsWay) {
  // Front left, rear left, rear right, front right: lift on the left rolls right (+x), lift behind
  // pitches the nose down (+y).
  const Turn expected[] = {{1, -1, -1}, {1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}};
  for (std::size_t i = 0; i < kRotors; ++i) {
    const Turn turn = measured_turn(without_air(), i);
    EXPECT_EQ(turn.roll, expected[i].roll) << "rotor " << i + 1;
    EXPECT_EQ(turn.pitch, expected[i].pitch) << "rotor " << i + 1;
    EXPECT_EQ(turn.yaw, expected[i].yaw) << "rotor " << i + 1;
  }
}

TEST(QuadrotorLayout, EveryRotorOfAPlusTurnsTheBodyItsWay) {
  const Turn expected[] = {{0, -1, -1}, {1, 0, 1}, {0, 1, -1}, {-1, 0, 1}};
  QuadrotorParams params = without_air();
  params.layout = QuadrotorLayout::kPlus;
  for (std::size_t i = 0; i < kRotors; ++i) {
    const Turn turn = measured_turn(params, i);
    EXPECT_EQ(turn.roll, expected[i].roll) << "rotor " << i + 1;
    EXPECT_EQ(turn.pitch, expected[i].pitch) << "rotor " << i + 1;
    EXPECT_EQ(turn.yaw, expected[i].yaw) << "rotor " << i + 1;
  }
}

TEST(QuadrotorLayout, TellsWhatControllersAskFor) {
  const QuadrotorRig rig;
  const VehicleDescription& about = rig.vehicle.description();
  const Rotorcraft& craft = about.rotorcraft.value();
  ASSERT_EQ(craft.rotors.size(), 4u);
  EXPECT_NEAR(craft.rotors[0].p_B.x(), 0.219203, 1e-6);
  EXPECT_NEAR(craft.rotors[1].p_B.x(), -0.219203, 1e-6);
  EXPECT_NEAR(craft.rotors[1].p_B.y(), 0.219203, 1e-6);
  EXPECT_NEAR(craft.rotors[3].p_B.y(), -0.219203, 1e-6);
  EXPECT_EQ(craft.rotors[0].torque_sign, -1.0);
  EXPECT_EQ(craft.rotors[1].torque_sign, 1.0);
  EXPECT_NEAR(craft.tip_radius_m, 0.50, 1e-12);
  EXPECT_EQ(craft.min_rotor_radps, 0.0);
  EXPECT_EQ(about.actuators.size(), 4u);
  EXPECT_EQ(about.actuators[3].name, "rotor_4_speed_radps");
  EXPECT_EQ(about.actuators[3].max, 640.0);
}

/// The footprint holds every blade's tip and is nowhere more than 2 cm outside the discs' hull.
TEST(QuadrotorLayout, FootprintFitsTheDiscs) {
  for (const QuadrotorLayout layout : {QuadrotorLayout::kX, QuadrotorLayout::kPlus}) {
    QuadrotorParams params;
    params.layout = layout;
    const QuadrotorRig rig(params);
    const VehicleDescription& about = rig.vehicle.description();
    const std::vector<Eigen::Vector2d>& outline = about.footprint_B;
    ASSERT_GE(outline.size(), 8u);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Eigen::Vector2d &a = outline[k], &b = outline[(k + 1) % outline.size()];
      const Eigen::Vector2d along = (b - a).normalized(), out(along.y(), -along.x());
      double nearest = 1e9;  // of the discs' farthest points to this side
      for (std::size_t i = 0; i < kRotors; ++i) {
        const Eigen::Vector2d tip = params.hub_B(i).head<2>() + params.rotor_radius_m * out;
        nearest = std::min(nearest, (a - tip).dot(out));
      }
      EXPECT_GE(nearest, -1e-12);
      EXPECT_LT(nearest, 0.02);
      const Eigen::Vector2d& c = outline[(k + 2) % outline.size()];
      EXPECT_GT(along.x() * (c - b).y() - along.y() * (c - b).x(), 0.0) << "not convex at " << k;
      EXPECT_LE(a.cwiseAbs().maxCoeff(), about.collision_half_extents_m.x() + 1e-2);
    }
  }
}

TEST(QuadrotorLayout, RotorsTurnOppositeWaysInPictures) {
  QuadrotorRig rig;
  rig.fly(20.0, 300.0);
  rig.actuate(300.0);
  rig.run(0.003);  // 0.9 rad
  std::vector<Pose> poses(rig.vehicle.links().size());
  rig.vehicle.read_links(poses);
  ASSERT_EQ(poses.size(), 5u);
  for (int i = 0; i < 4; ++i) {
    const double yaw = yaw_from_quaternion((poses[0].inverse() * poses[1 + i]).q);
    EXPECT_NEAR(yaw, i % 2 == 0 ? 0.9 : -0.9, 1e-9) << "rotor " << i + 1;
    EXPECT_LT((poses[0].inverse() * poses[1 + i]).p.head<2>().norm() - 0.31, 1e-12);
  }
}

TEST(QuadrotorMesh, IsClosedAroundItsSizesAndLooksOutwards) {
  const TriangleMesh rotor = make_quadrotor_rotor(0.19, true);
  EXPECT_NEAR(rotor.bounds().max().x(), 0.19, 2e-3);
  // Turning counter-clockwise the leading edge of the blade along x is at +y, and higher.
  double lead_z = -1.0, trail_z = 1.0;
  for (const Eigen::Vector3f& v : rotor.vertices) {
    if (v.x() < 0.08f || v.x() > 0.12f) continue;
    if (v.y() > 0.004f) lead_z = std::max(lead_z, static_cast<double>(v.z()));
    if (v.y() < -0.004f) trail_z = std::min(trail_z, static_cast<double>(v.z()));
  }
  EXPECT_GT(lead_z, trail_z + 0.002);
  for (const bool ccw : {true, false}) {
    const TriangleMesh mesh = make_quadrotor_rotor(0.19, ccw);
    double volume = 0.0;  // of tetrahedra to the origin: positive for outward faces
    for (const auto& [a, b, c] : mesh.triangles) {
      volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
    }
    EXPECT_GT(volume, 1e-6);
  }
  const QuadrotorParams params;
  const TriangleMesh body = make_quadrotor_body(params);
  EXPECT_GT(body.triangles.size(), 2000u);
  EXPECT_NEAR(body.bounds().min().z(), -params.stand_height_m, 1e-3);
  EXPECT_EQ(body.normals.size(), body.vertices.size());
}

std::string refusal(const std::function<void(QuadrotorParams&)>& change) {
  QuadrotorParams params;
  change(params);
  try {
    Quadrotor(params, QuadrotorRig::context("drone"));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(QuadrotorParams, RefusesWhatCannotHoverWithBothNumbers) {
  EXPECT_EQ(refusal([](QuadrotorParams& p) { p.rotor.max_radps = 274.3; }),
            "drone: makes 18.0 N at most, but weighs 19.6 N: it cannot hover");
  EXPECT_EQ(refusal([](QuadrotorParams& p) { p.rotor.max_radps = 287.0; }), "accepted");
}

TEST(QuadrotorParams, RefusesWhatCannotBe) {
  EXPECT_EQ(
      refusal([](QuadrotorParams& p) { p.arm_m = 0.2; }),
      "drone: rotors of rotor_radius_m = 0.19 would strike each other on arms of arm_m = 0.2");
  EXPECT_EQ(refusal([](QuadrotorParams& p) {
              p.inertia_kgm2 = {0.05, 0.05, 0.2};
            }),
            "drone: inertia_kgm2 = [0.05, 0.05, 0.2] is not possible for a rigid body: one moment "
            "is larger than the sum of the other two");
  EXPECT_EQ(refusal([](QuadrotorParams& p) { p.mass_kg = -1.0; }),
            "drone: mass_kg = -1 kg, must be > 0 kg");
  EXPECT_EQ(refusal([](QuadrotorParams& p) { p.battery.initial_charge = 1.5; }),
            "drone: initial_charge = 1.5, must be >= 0 and <= 1");
  EXPECT_EQ(refusal([](QuadrotorParams& p) { p.gear_radius_m = 0.5; }),
            "drone: gear_radius_m = 0.5 is longer than arm_m = 0.31");
}

TEST(QuadrotorParams, ReadsFaultsAndRefusesARotorFailureWithoutARotor) {
  ParameterSet parameters(quadrotor_spec().parameters, "quadrotor");
  ParameterSet fault = parameters.make_group("faults");
  fault.set("kind", std::string("rotor_failure")).set("at_s", 5.0);
  parameters.set("faults", std::vector<ParameterSet>{fault});
  try {
    read_quadrotor_params(parameters, "drone", kGravity);
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "drone: faults[0]: a rotor_failure must name its 'rotor' (1 to 4)");
  }
  fault.set("rotor", std::int64_t{3}).set("remaining", 0.25);
  parameters.set("faults", std::vector<ParameterSet>{fault});
  const QuadrotorParams params = read_quadrotor_params(parameters, "drone", kGravity);
  ASSERT_EQ(params.faults.size(), 1u);
  EXPECT_EQ(params.faults[0].rotor, 2u);
  EXPECT_EQ(params.faults[0].at_s, 5.0);
  EXPECT_EQ(params.faults[0].remaining, 0.25);
  // An empty battery stops all rotors.
  for (const bool names_rotor : {true, false}) {
    ParameterSet battery = parameters.make_group("faults");
    battery.set("kind", std::string("battery_empty")).set("at_s", 5.0);
    names_rotor ? battery.set("rotor", std::int64_t{3}) : battery.set("remaining", 0.0);
    parameters.set("faults", std::vector<ParameterSet>{battery});
    try {
      read_quadrotor_params(parameters, "drone", kGravity);
      FAIL() << "accepted";
    } catch (const ConfigError& error) {
      EXPECT_STREQ(error.what(),
                   "drone: faults[0]: 'rotor' and 'remaining' are keys of a rotor_failure");
    }
  }
}

/// Defaults of the spec are those of the struct.
TEST(QuadrotorParams, SpecAndStructAgree) {
  const QuadrotorParams read = read_quadrotor_params(
      ParameterSet(quadrotor_spec().parameters, "quadrotor"), "drone", kGravity);
  const QuadrotorParams own;
  EXPECT_EQ(read.mass_kg, own.mass_kg);
  EXPECT_EQ(read.inertia_kgm2, own.inertia_kgm2);
  EXPECT_EQ(read.rotor.thrust_coefficient_Ns2, own.rotor.thrust_coefficient_Ns2);
  EXPECT_EQ(read.foot.stiffness_N_per_m, own.foot.stiffness_N_per_m);
  EXPECT_NEAR(read.landing_tilt_limit_rad, own.landing_tilt_limit_rad, 1e-15);
  EXPECT_EQ(read.battery.capacity_Wh, own.battery.capacity_Wh);
  EXPECT_EQ(read.ground_effect, own.ground_effect);
}

}  // namespace
}  // namespace vinerow::vehicles::layout_test
