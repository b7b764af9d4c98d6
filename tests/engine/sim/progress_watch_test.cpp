#include "engine/sim/progress_watch.h"

#include <gtest/gtest.h>

#include "engine/api/vehicle.h"

namespace vinerow::progress_watch_test {
namespace {

VehicleDescription rover() {
  VehicleDescription description;
  description.wheeled.emplace();
  description.wheeled->wheel_radius_m = 0.2;
  description.actuators = {{"axle_front_steer_rad", "rad", -1.0, 1.0},
                           {"wheel_l_speed_radps", "rad/s", -20.0, 20.0},
                           {"wheel_r_speed_radps", "rad/s", -20.0, 20.0}};
  return description;
}

/// Time of the report that a vehicle is stuck, s. It moves at `moved_mps`; its commands are l, r.
/// -1: not within 100 s.
double stuck_after_s(double moved_mps, double l, double r) {
  ProgressWatch watch(rover());
  const Duration dt{50'000'000};
  for (int i = 0; i <= 2000; ++i) {
    const Time now{i * dt.ns};
    if (!watch.update(now, {moved_mps * now.s(), 0, 0}, {0.5, l, r}, dt).empty()) return now.s();
  }
  return -1.0;
}

TEST(ProgressWatch, TellsWhoDrivesFiveMetresAndStands) {
  // Rims at 0.1 m/s drive 5 m in 50 s; faster ones have 20 s to come free.
  EXPECT_NEAR(stuck_after_s(0.0, 0.5, 0.5), 50.0, 0.051);
  EXPECT_NEAR(stuck_after_s(0.0, -0.5, -0.5), 50.0, 0.051) << "backwards";
  EXPECT_NEAR(stuck_after_s(0.0, 5.0, 5.0), 20.0, 0.051);
  // Creeping on by 0.5 m in 19 s is progress, in 21 s it is none.
  EXPECT_EQ(stuck_after_s(0.5 / 19.0, 5.0, 5.0), -1.0);
  EXPECT_NEAR(stuck_after_s(0.5 / 21.0, 5.0, 5.0), 20.0, 0.051);
}

TEST(ProgressWatch, LeavesThoseAloneWhoStandOrPivotOrFly) {
  EXPECT_EQ(stuck_after_s(0.0, 0.0, 0.0), -1.0);
  EXPECT_EQ(stuck_after_s(0.0, -5.0, 5.0), -1.0);
  // One that tries back and forth, a metre each.
  ProgressWatch rocking(rover());
  for (int i = 0; i < 4000; ++i) {
    const double speed_radps = i / 100 % 2 == 0 ? 1.0 : -1.0;
    EXPECT_EQ(rocking.update(Time{i * 50'000'000ll}, {0, 0, 0}, {0, speed_radps, speed_radps},
                             Duration{50'000'000}),
              "");
  }
  VehicleDescription drone = rover();
  drone.rotorcraft.emplace();
  ProgressWatch watch(drone);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(watch.update(Time{i * 50'000'000ll}, {0, 0, 0}, {0, 9, 9}, Duration{50'000'000}), "");
  }
}

TEST(ProgressWatch, SaysHowFar) {
  ProgressWatch watch(rover());
  std::string reason;
  for (int i = 0; i <= 300 && reason.empty(); ++i) {
    reason = watch.update(Time{i * 125'000'000ll}, {0.12 * (i > 0), 0, 0}, {0, 5, 5},
                          Duration{125'000'000});
  }
  EXPECT_EQ(reason, "its wheels were commanded to roll 20.0 m in 20.0 s and it moved 0.12 m");
}

}  // namespace
}  // namespace vinerow::progress_watch_test
