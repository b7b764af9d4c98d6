// Description and links against the parameters.

#include <gtest/gtest.h>

#include "engine/api/flight_model.h"
#include "engine/api/mesh.h"
#include "tests/vehicles/fixed_wing/rig.h"

namespace vinerow::vehicles::fixed_wing_description_test {
namespace {

using namespace test;

FixedWingParams odd_params() {
  FixedWingParams p = plain_params();
  p.mass_kg = 1.3;
  p.elevon_limit_rad = 0.31;
  p.elevon_lag_s = 0.05;
  p.battery.capacity_Wh = 10.0;
  p.cruise_speed_mps = 14.0;
  p.max_speed_mps = 21.0;
  p.max_bank_rad = rad_from_deg(30.0);
  p.launch.throttle = 0.4;
  p.launch.height_m = 1.6;
  p.landing_sink_limit_mps = 2.2;
  p.shape.belly_m = 0.07;
  return p;
}

TEST(FixedWingDescription, HasTheVehiclesFigures) {
  const FixedWingParams p = odd_params();
  const WingRig rig(p);
  const VehicleDescription& about = rig.vehicle.description();
  EXPECT_EQ(about.type, "fixed_wing");
  EXPECT_EQ(about.mass_kg, 1.3);
  EXPECT_EQ(about.height_above_ground_m, 0.07);
  EXPECT_EQ(about.max_speed_mps, 21.0);
  EXPECT_EQ(about.battery_capacity_J, 36e3);
  // Level turn: tan(bank) = v^2 / (g r).
  EXPECT_NEAR(about.min_turning_radius_m.value(), 14.0 * 14.0 * std::sqrt(3.0) / kGravity, 1e-9);

  ASSERT_EQ(about.actuators.size(), 3u);
  EXPECT_EQ(about.actuators[0].name, "throttle");
  EXPECT_EQ(about.actuators[0].min, 0.0);
  EXPECT_EQ(about.actuators[0].max, 1.0);
  EXPECT_EQ(about.actuators[1].name, "elevon_left_rad");
  EXPECT_EQ(about.actuators[2].name, "elevon_right_rad");
  for (const int k : {1, 2}) {
    EXPECT_EQ(about.actuators[k].min, -0.31);
    EXPECT_EQ(about.actuators[k].max, 0.31);
  }

  const FixedWingAircraft& aircraft = about.fixed_wing.value();
  EXPECT_NE(aircraft.flight_model, nullptr);
  EXPECT_EQ(aircraft.span_m, p.wing.span_m);
  EXPECT_EQ(aircraft.wing_area_m2, p.wing.area_m2);
  EXPECT_EQ(aircraft.cruise_speed_mps, 14.0);
  EXPECT_NEAR(aircraft.max_bank_rad, kPi / 6.0, 1e-15);
  EXPECT_EQ(aircraft.throttle_lag_s, p.propeller.lag_s);
  EXPECT_EQ(aircraft.elevon_lag_s, 0.05);
  EXPECT_EQ(aircraft.launch_throttle, 0.4);
  EXPECT_EQ(aircraft.landing_sink_limit_mps, 2.2);
  EXPECT_EQ(aircraft.belly_height_m, 0.07);
  EXPECT_EQ(aircraft.start_height_m, 1.6);
}

TEST(FixedWingDescription, AStartInTheAirHasItsOwnHeight) {
  FixedWingParams p = plain_params();
  p.launch.mode = LaunchMode::kAir;
  p.launch.start_height_m = 45.0;
  EXPECT_EQ(WingRig(p).vehicle.description().fixed_wing->start_height_m, 45.0);
}

TEST(FixedWingDescription, StallAndTurnGoWithGravity) {
  // In level flight lift, hence the speed squared, equals weight; a turn's radius is v^2 / (g tan).
  const auto of = [](double gravity_mps2) {
    VehicleContext context;
    context.vehicle = context.part = "plane";
    context.gravity_mps2 = gravity_mps2;
    return FixedWing(plain_params(), context).description();
  };
  const VehicleDescription light = of(0.81 * kGravity), normal = of(kGravity);
  EXPECT_NEAR(light.fixed_wing->stall_speed_mps, 0.9 * normal.fixed_wing->stall_speed_mps, 1e-9);
  EXPECT_NEAR(0.81 * light.min_turning_radius_m.value(), normal.min_turning_radius_m.value(), 1e-9);
}

TEST(FixedWingDescription, TheStallSpeedGoesWithTheDensity) {
  WorldModel world = make_flat_world();
  world.wind.air_density_kgm3 = 0.81 * 1.225;
  const WingRig thin(plain_params(), std::move(world));
  EXPECT_NEAR(0.9 * thin.vehicle.description().fixed_wing->stall_speed_mps,
              plain_params().stall_speed_mps(kGravity), 1e-9);
}

TEST(FixedWingDescription, LinksAreBodyElevonsAndPropeller) {
  const WingRig rig;
  const std::vector<VehicleLink>& links = rig.vehicle.links();
  const char* names[] = {"body", "elevon_left", "elevon_right", "propeller"};
  ASSERT_EQ(links.size(), 4u);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(links[k].name, names[k]);
  // In their own frames the elevons are each other's mirror image.
  const Eigen::AlignedBox3d left = links[1].mesh->bounds(), right = links[2].mesh->bounds();
  EXPECT_NEAR(left.min().y(), -right.max().y(), 1e-6);
  EXPECT_NEAR(left.max().y(), -right.min().y(), 1e-6);
}

}  // namespace
}  // namespace vinerow::vehicles::fixed_wing_description_test
