#include "controllers/parts/aircraft/aircraft.h"

#include <gtest/gtest.h>

#include "tests/controllers/parts/solvers/random_sets.h"
#include "tests/controllers/support/aircraft_sim.h"
#include "tests/controllers/support/plant.h"

namespace vinerow::test::aircraft_test {
namespace {

TEST(Aircraft, MixesElevatorAndAileronOntoElevons) {
  // Reference of paper A, section 1: right = d_e - d_a, left = d_e + d_a.
  const controllers::Aircraft aircraft =
      controllers::read_aircraft(describe(make_mh900_like()), 9.81, "plane.controller");
  std::vector<double> values(3, -1.0);
  aircraft.mix({0.6, 0.1, 0.03}, values);
  EXPECT_EQ(values, (std::vector<double>{0.6, 0.13, 0.07}));
}

TEST(Aircraft, FindsItsActuatorsInAnyOrder) {
  VehicleDescription description = describe(make_mh900_like());
  std::swap(description.actuators[0], description.actuators[2]);
  const controllers::Aircraft aircraft =
      controllers::read_aircraft(description, 9.81, "plane.controller");
  std::vector<double> values(3, -1.0);
  aircraft.mix({0.6, 0.1, 0.03}, values);
  EXPECT_EQ(values, (std::vector<double>{0.07, 0.13, 0.6}));
  EXPECT_EQ(aircraft.throttle_max(), 1.0);
  EXPECT_NEAR(aircraft.elevon_max_rad(), 0.43633, 1e-5);
}

TEST(Aircraft, AnElevonAtItsStopTakesFromElevatorAndAileron) {
  const controllers::Aircraft aircraft =
      controllers::read_aircraft(describe(make_mh900_like()), 9.81, "plane.controller");
  const double max_rad = aircraft.elevon_max_rad();
  const controllers::AircraftControls left = aircraft.limit({1.2, 0.4, 0.1});
  EXPECT_EQ(left.throttle, 1.0);
  EXPECT_NEAR(left.elevator_rad, 0.5 * (max_rad + 0.3), 1e-15);
  EXPECT_NEAR(left.aileron_rad, 0.5 * (max_rad - 0.3), 1e-15);
  const controllers::AircraftControls free = aircraft.limit({0.5, -0.1, 0.2});
  EXPECT_NEAR(free.elevator_rad, -0.1, 1e-15);
  EXPECT_NEAR(free.aileron_rad, 0.2, 1e-15);
}

TEST(Aircraft, RefusesWhatHasNoWingsOrTellsTooLittle) {
  const auto read = [](const VehicleDescription& description) {
    return complaint(
        [&] { controllers::read_aircraft(description, 9.81, "plane.controller (trmpc)"); });
  };
  EXPECT_EQ(read(make_rover_description()),
            "plane.controller (trmpc) needs a vehicle with wings; vehicle type 'test_rover' has "
            "wheels");
  VehicleDescription description = describe(make_mh900_like());
  description.fixed_wing->cruise_speed_mps = 0.0;
  EXPECT_EQ(read(description),
            "plane.controller (trmpc) needs 'cruise_speed_mps' > 0, but vehicle type 'fixed_wing' "
            "has 0");
  description.fixed_wing->flight_model = nullptr;
  EXPECT_EQ(read(description),
            "plane.controller (trmpc) needs 'flight_model', which vehicle type 'fixed_wing' does "
            "not have");
  description = describe(make_mh900_like());
  description.actuators[1].name = "flap_rad";
  EXPECT_NE(read(description).find("elevon_left_rad"), std::string::npos) << read(description);
}

}  // namespace
}  // namespace vinerow::test::aircraft_test
