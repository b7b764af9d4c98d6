/// Landings on hillsides under full physics and in wind: the quadrotor on the 21 deg of Parcel F's
/// headland whatever its heading, the flying wing up, down and across slopes of 15 %.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "engine/math/angles.h"
#include "engine/sim/simulation.h"
#include "tests/support/paths.h"
#include "vinerow/testing.h"

namespace vinerow::hillside_landing_test {
namespace {

using testing::TestRun;

/// A plane hillside that rises towards the east by `rise`, with wind from the given direction.
std::string hillside(int seed, double rise, double surroundings_m, double wind_mps,
                     double from_deg) {
  return fmt::format(
      "vinerow: 1\nname: hillside\nseed: {}\n"
      "world:\n  type: vineyard\n  row_count: 2\n  row_length_m: 10\n  relief_m: {}\n"
      "  row_bearing_deg: 90\n  uphill_bearing_deg: 90\n  waves_m: 0\n  slope_fade_m: 4000\n"
      "  surroundings_m: {}\n  terrain_cell_m: 2.0\n  posts: false\n  occupancy_cell_m: 0\n"
      "  wind: {{mean_speed_mps: {}, from_deg: {}, reference_height_m: 2.0, height_law: uniform, "
      "turbulence: 0.5, turbulence_wind_mps: {}}}\n",
      seed, 10.0 * rise, surroundings_m, wind_mps, from_deg, wind_mps);
}

double tilt_deg(const Odometry& truth) {
  return deg_from_rad(std::acos((truth.X_WB.q * Eigen::Vector3d::UnitZ()).z()));
}

class QuadrotorOnAHillside : public ::testing::TestWithParam<const char*> {};

TEST_P(QuadrotorOnAHillside, LiesAgainstTheSlopeWhateverItsHeading) {
  constexpr double kSlope_deg = 21.0;
  double furthest_m = 0.0, fastest_radps = 0.0;
  int seed = 1;
  for (const double yaw_deg : {0.0, 15.0, 30.0, 45.0, 60.0, 75.0}) {
    SCOPED_TRACE(yaw_deg);
    TestRun run = TestRun::from_yaml(
        hillside(seed, std::tan(rad_from_deg(kSlope_deg)), 120.0, 3.0, 60.0 * seed) +
            fmt::format("duration_s: 30\nstop_when_finished: false\nphysics: {{step_s: 0.001}}\n"
                        "vehicles:\n  drone:\n    include: assets/vehicles/quadrotor_q4t.yaml\n"
                        "    spawn: {{x_m: -15, y_m: 25, yaw_deg: {}}}\n"
                        "    guidance: {{type: trajectory, rate_Hz: 20, hover_m: [-15, 25, 2], "
                        "hover_yaw_deg: 0, hover_s: 3}}\n    controller: {{type: {}}}\n",
                        yaw_deg, GetParam()),
        VINEROW_SOURCE_DIR);
    ++seed;
    run.run_for_s(3.0);
    while (!run.signal<FollowerState>("drone/follower").finished && run.time_s() < 20.0) {
      run.run_for_s(0.05);
    }
    const Eigen::Vector3d landed_W = run.truth("drone").X_WB.p;
    while (run.time_s() < 29.9) {
      run.run_for_s(0.05);
      fastest_radps = std::max(fastest_radps, run.truth("drone").w_WB_B.head<2>().norm());
    }
    const Odometry truth = run.truth("drone");
    EXPECT_EQ(run.metric("drone", "finished"), 1.0);
    EXPECT_EQ(run.metric("drone", "crashed"), 0.0);
    EXPECT_NEAR(tilt_deg(truth), kSlope_deg, 2.0);
    EXPECT_LT(truth.v_WB_B.norm(), 0.01);
    furthest_m = std::max(furthest_m, (truth.X_WB.p - landed_W).norm());
  }
  std::printf("moved %.3f m at most after the landing, turned by %.2f rad/s at most\n", furthest_m,
              fastest_radps);
  // Its middle, 0.28 m from a foot, moves by 2 sin(10.5 deg) of that as it turns about it, 0.10 m;
  // the rest it slides.
  EXPECT_LT(furthest_m, 0.25);
}
INSTANTIATE_TEST_SUITE_P(Controllers, QuadrotorOnAHillside,
                         ::testing::Values("quadrotor_mpc", "quadrotor_lqr", "quadrotor_pid"),
                         [](const auto& parameter) { return std::string(parameter.param); });

struct WingLanding {
  const char* name;
  double land_bearing_deg;  // uphill is 90
  double rise;
};

void PrintTo(const WingLanding& landing, std::ostream* out) {
  *out << landing.name;
}

class WingOnAHillside : public ::testing::TestWithParam<WingLanding> {};

TEST_P(WingOnAHillside, LandsWhole) {
  const WingLanding& landing = GetParam();
  for (const int seed : {1, 2, 3}) {
    SCOPED_TRACE(seed);
    TestRun run = TestRun::from_yaml(
        hillside(seed, landing.rise, 700.0, 1.0, landing.land_bearing_deg) +
            fmt::format(
                "duration_s: 240\nphysics: {{step_s: 0.0025}}\nvehicles:\n  plane:\n"
                "    include: assets/vehicles/mh900_autopilot.yaml\n"
                "    spawn: {{x_m: -150, y_m: -150, yaw_deg: 0}}\n"
                "    planner: {{type: waypoints, x_m: [-150, -150], y_m: [-150, 100], "
                "z_m: [30, 30]}}\n"
                "    guidance: {{type: waypoint_guidance, rate_Hz: 20, air_data: pitot, end: land, "
                "land_bearing_deg: {}}}\n    controller: {{type: trmpc, rate_Hz: 20}}\n",
                landing.land_bearing_deg),
        VINEROW_SOURCE_DIR);
    run.run_to_end();
    EXPECT_EQ(run.metric("plane", "finished"), 1.0);
    EXPECT_EQ(run.metric("plane", "crashed"), 0.0);
    EXPECT_LT(run.truth("plane").v_WB_B.norm(), 0.5);
  }
}
INSTANTIATE_TEST_SUITE_P(FifteenPercent, WingOnAHillside,
                         ::testing::Values(WingLanding{"Uphill", 90.0, 0.15},
                                           WingLanding{"Downhill", 270.0, 0.15},
                                           WingLanding{"Across", 0.0, 0.15}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace vinerow::hillside_landing_test
