#include "controllers/parts/aircraft/trim_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/math/angles.h"
#include "tests/controllers/parts/solvers/random_sets.h"
#include "tests/controllers/support/aircraft_sim.h"
#include "tests/support/no_alloc.h"

namespace vinerow::test::trim_table_test {
namespace {

controllers::Aircraft make_aircraft(const AircraftNumbers& numbers = make_mh900_like()) {
  return controllers::read_aircraft(describe(numbers), numbers.gravity_mps2, "plane.controller");
}

TEST(TrimTable, IsASteadyFlightEverywhere) {
  // Between the table's points too, judged by the second implementation.
  const AircraftNumbers numbers = make_mh900_like();
  const controllers::TrimTable table(make_aircraft(), 12.0, rad_from_deg(45.0), "plane.controller");
  RandomStream random(1, "test", "trims");
  double worst = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double climb = random.uniform(rad_from_deg(-8.0), rad_from_deg(8.0));
    const double bank = random.uniform(rad_from_deg(-45.0), rad_from_deg(45.0));
    const controllers::TrimPoint at = table.at(climb, bank);
    EXPECT_NEAR(at.roll_rad, bank, rad_from_deg(2.0));
    AircraftSim sim(numbers);
    sim.start({0, 0, 0}, at.roll_rad, at.pitch_rad, 0.0, {at.u_mps, at.v_mps, at.w_mps},
              {at.p_radps, at.q_radps, at.r_radps},
              {at.controls.throttle, at.controls.elevator_rad, at.controls.aileron_rad});
    worst = std::max(worst, sim.accelerations().cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 0.005);
  RecordProperty("worst_acceleration", std::to_string(worst));
}

TEST(TrimTable, LevelFlightIsExactAndLimitsHold) {
  const controllers::TrimTable table(make_aircraft(), 12.0, rad_from_deg(45.0), "plane.controller");
  const controllers::TrimPoint level = table.at(0.0, 0.0);
  EXPECT_NEAR(level.controls.throttle, table.level().controls.throttle, 1e-3);
  // Full throttle and none are the ends of the climb.
  EXPECT_NEAR(table.at(2.0, 0.0).controls.throttle, 1.0, 1e-12);
  EXPECT_NEAR(table.at(-2.0, 0.0).controls.throttle, 0.0, 1e-12);
  EXPECT_EQ(table.at(0.0, 2.0).roll_rad, table.at(0.0, table.bank_max_rad()).roll_rad);
  EXPECT_EQ(table.at(0.0, -2.0).roll_rad, table.at(0.0, -table.bank_max_rad()).roll_rad);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(table.at(nan, nan).pitch_rad, level.pitch_rad);
  // A climb that a bank leaves no thrust for keeps to the throttle's end.
  EXPECT_NEAR(table.at(2.0, rad_from_deg(45.0)).controls.throttle, 1.0, 1e-12);
}

TEST(TrimTable, MirrorsLeftAndRight) {
  const controllers::TrimTable table(make_aircraft(), 12.0, rad_from_deg(45.0), "plane.controller");
  for (const double bank : {0.03, 0.21, 0.5, 0.77}) {
    const controllers::TrimPoint right = table.at(0.04, bank), left = table.at(0.04, -bank);
    EXPECT_NEAR(right.controls.aileron_rad, -left.controls.aileron_rad, 1e-12);
    EXPECT_NEAR(right.r_radps, -left.r_radps, 1e-12);
    EXPECT_NEAR(right.v_mps, -left.v_mps, 1e-12);
    EXPECT_NEAR(right.controls.elevator_rad, left.controls.elevator_rad, 1e-12);
  }
}

TEST(TrimTable, LeavesOutBanksThatStall) {
  const controllers::TrimTable table(make_aircraft(), 9.5, rad_from_deg(80.0), "plane.controller");
  EXPECT_LT(table.bank_max_rad(), rad_from_deg(60.0));
  EXPECT_GT(table.bank_max_rad(), rad_from_deg(15.0));
  // A little more bank has no trim with the throttle at an end.
  EXPECT_EQ(table.at(0.0, rad_from_deg(70.0)).roll_rad,
            table.at(0.0, table.bank_max_rad()).roll_rad);
}

TEST(TrimTable, LooksUpWithoutHeapAndRefusesTheUnflyable) {
  const controllers::TrimTable table(make_aircraft(), 12.0, rad_from_deg(45.0), "plane.controller");
  AllocationCounter counter;
  const controllers::TrimPoint at = table.at(0.01, 0.3);
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_GT(at.controls.throttle, 0.0);
  EXPECT_EQ(
      complaint([] {
        controllers::TrimTable(make_aircraft(make_scaled_zagi()), 12.0, 0.7,
                               "plane.controller (trmpc)");
      })
          .find("plane.controller (trmpc): no steady flight at 12.00 m/s, climb 0.0 deg, bank "
                "0.0 deg: "),
      0u);
}

}  // namespace
}  // namespace vinerow::test::trim_table_test
