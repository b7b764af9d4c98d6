// Description and links against the parameters, all of them off their defaults.

#include <gtest/gtest.h>

#include "engine/api/mesh.h"
#include "tests/vehicles/quadrotor/rig.h"

namespace vinerow::vehicles::quadrotor_description_test {
namespace {

using namespace test;

QuadrotorParams odd_params() {
  QuadrotorParams p;
  p.layout = QuadrotorLayout::kPlus;
  p.mass_kg = 1.7;
  p.inertia_kgm2 = {0.041, 0.043, 0.08};
  p.arm_m = 0.27;
  p.rotor_radius_m = 0.13;
  p.stand_height_m = 0.19;
  p.rotor_drag_Ns_per_m = 0.27;
  p.rotor.max_radps = 777.0;
  p.battery.capacity_Wh = 50.0;
  p.landing_speed_limit_mps = 1.3;
  p.max_tilt_rad = 0.33;
  p.max_speed_mps = 9.0;
  p.min_turning_radius_m = 1.1;
  return p;
}

TEST(QuadrotorDescription, HasTheVehiclesFigures) {
  const QuadrotorParams p = odd_params();
  const QuadrotorRig rig(p);
  const VehicleDescription& about = rig.vehicle.description();
  EXPECT_EQ(about.type, "quadrotor");
  EXPECT_EQ(about.mass_kg, 1.7);
  EXPECT_EQ(about.height_above_ground_m, 0.19);
  EXPECT_EQ(about.max_speed_mps, 9.0);
  EXPECT_EQ(about.min_turning_radius_m, 1.1);
  EXPECT_EQ(about.battery_capacity_J, 180e3);  // 50 Wh
  EXPECT_TRUE(about.flies());
  EXPECT_FALSE(about.fixed_wing.has_value());

  const Rotorcraft& craft = about.rotorcraft.value();
  EXPECT_EQ(craft.inertia_kgm2, p.inertia_kgm2);
  EXPECT_EQ(craft.rotor_drag_Ns_per_m, 0.27);
  EXPECT_EQ(craft.max_rotor_radps, 777.0);
  EXPECT_EQ(craft.rotor_lag_s, p.rotor.rise_lag_s);
  EXPECT_EQ(craft.rotor_inertia_kgm2, p.rotor.inertia_kgm2);
  EXPECT_EQ(craft.rotor_radius_m, 0.13);
  EXPECT_NEAR(craft.tip_radius_m, 0.40, 1e-15);
  EXPECT_EQ(craft.max_tilt_rad, 0.33);
  EXPECT_EQ(craft.landing_speed_limit_mps, 1.3);
  // Drag torque over thrust does not depend on the air.
  EXPECT_NEAR(craft.torque_coefficient_Nms2 / craft.thrust_coefficient_Ns2,
              p.rotor.torque_coefficient_Nms2 / p.rotor.thrust_coefficient_Ns2, 1e-15);
}

TEST(QuadrotorDescription, RotorsCountFromTheFrontToTheLeft) {
  const QuadrotorRig rig(odd_params());
  const VehicleDescription& about = rig.vehicle.description();
  const Rotorcraft& craft = about.rotorcraft.value();
  const double x[] = {0.27, 0.0, -0.27, 0.0}, y[] = {0.0, 0.27, 0.0, -0.27};
  const char* names[] = {"rotor_1_speed_radps", "rotor_2_speed_radps", "rotor_3_speed_radps",
                         "rotor_4_speed_radps"};
  ASSERT_EQ(craft.rotors.size(), 4u);
  ASSERT_EQ(about.actuators.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(craft.rotors[i].p_B.x(), x[i], 1e-15) << i;
    EXPECT_NEAR(craft.rotors[i].p_B.y(), y[i], 1e-15) << i;
    EXPECT_EQ(craft.rotors[i].torque_sign, i == 0 || i == 2 ? -1.0 : 1.0) << i;
    EXPECT_EQ(about.actuators[i].name, names[i]);
    EXPECT_EQ(about.actuators[i].unit, "rad/s");
    EXPECT_EQ(about.actuators[i].min, 0.0);
    EXPECT_EQ(about.actuators[i].max, 777.0);
  }
}

TEST(QuadrotorDescription, LinksAreTheBodyAndFourRotorsOfTheirRadius) {
  const QuadrotorRig rig(odd_params());
  const std::vector<VehicleLink>& links = rig.vehicle.links();
  ASSERT_EQ(links.size(), 5u);
  EXPECT_EQ(links[0].name, "body");
  for (int i = 1; i <= 4; ++i) {
    EXPECT_EQ(links[i].name, "rotor_" + std::to_string(i));
    EXPECT_NEAR(links[i].mesh->bounds().max().x(), 0.13, 2e-3);
  }
}

}  // namespace
}  // namespace vinerow::vehicles::quadrotor_description_test
