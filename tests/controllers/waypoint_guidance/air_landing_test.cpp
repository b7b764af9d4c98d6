/// Where the guidance lands: on ground that it knows at its start only, and on hillsides of its
/// map.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"
#include "tests/controllers/waypoint_guidance/air_bench.h"

namespace vinerow::test::air_landing_test {
namespace {

/// Flies a leg and lands at a place. @returns the sentence about it
Event land(const Values& values) {
  PlaneOptions options;
  options.start_W = {0.0, 0.0, 60.1};
  VehicleDescription vehicle = make_plane_description();
  vehicle.fixed_wing->start_height_m = 60.1;
  AirBench bench(values, options, "waypoint_guidance", vehicle);
  bench.give_plan(make_waypoints({{0, 0, 60}, {200, 0, 60}}));
  bench.fly(40.0);
  const auto found =
      std::find_if(bench.events().begin(), bench.events().end(),
                   [](const Event& event) { return event.text.find("lands at") == 0; });
  EXPECT_NE(found, bench.events().end());
  return found == bench.events().end() ? Event{} : Event(*found);
}

TEST(AirLanding, WarnsOfGroundThatNobodyTold) {
  const std::vector<double> far = {300.0, 400.0};
  const Event guess = land({{"land_at_m", far}});
  EXPECT_EQ(guess.level, Event::Level::kWarning);
  EXPECT_THAT(guess.text,
              ::testing::HasSubstr("; assumes the ground there to be at z = 0.0 m as at the start, "
                                   "500 m away: land_height_m sets it"));
}

TEST(AirLanding, IsSilentWhereTheGroundIsKnown) {
  const std::vector<double> far = {300.0, 400.0}, near = {9.0, 12.0};
  for (const Values& values : {Values{{"land_at_m", far}, {"land_height_m", -3.0}},
                               Values{{"land_at_m", near}}, Values{}}) {
    const Event known = land(values);
    EXPECT_EQ(known.level, Event::Level::kInfo);
    EXPECT_THAT(known.text, ::testing::Not(::testing::HasSubstr("takes the ground")));
  }
}

/// A landing on a hillside that rises towards the north, begun 30 m above its middle.
struct HillLanding {
  double touch_mps, rise, yaw_rad;
};

HillLanding land_on(double slope, const Values& values, const Eigen::Vector2d& wind,
                    double start_yaw_rad = 0.0, double wave_m = 0.0) {
  PlaneOptions options;
  options.terrain = [=](const Eigen::Vector2d& p) {
    return slope * p.y() + wave_m * std::sin(2.0 * kPi * p.y() / 50.0);
  };
  options.start_W = {0.0, 0.0, 60.0};
  options.yaw_rad = start_yaw_rad;
  options.wind = wind;
  VehicleDescription vehicle = make_plane_description();
  vehicle.fixed_wing->start_height_m = 60.0;
  AirBench bench(values, options, "waypoint_guidance", vehicle);
  const Eigen::Vector3d along(std::cos(start_yaw_rad), std::sin(start_yaw_rad), 0.0);
  const Eigen::Vector3d up(0.0, 0.0, 60.0);
  bench.give_plan(make_waypoints({up, 200.0 * along + up}));
  bench.fly(400.0);
  EXPECT_TRUE(bench.has_event("landed at")) << slope;
  return {bench.plane.touch_mps(), bench.plane.touch_rise(),
          yaw_from_quaternion(bench.plane.odometry().X_WB.q)};
}

/// What a fall from 5 cm comes to, sqrt(2 g h); foam of such a wing bears one from 0.3 m.
constexpr double kSoft_mps = 1.0;

TEST(AirLanding, TouchesSoftlyUphillDownhillAndAlong) {
  for (const double slope : {0.15, -0.15, 0.05, 0.0}) {
    for (const double bearing_deg : {0.0, 180.0, 90.0}) {
      for (const double against_mps : {0.0, 2.0}) {
        const double from_rad = rad_from_deg(bearing_deg);
        const Eigen::Vector2d wind =
            -against_mps * Eigen::Vector2d(std::sin(from_rad), std::cos(from_rad));
        const HillLanding landing = land_on(slope, {{"land_bearing_deg", bearing_deg}}, wind);
        EXPECT_LT(landing.touch_mps, kSoft_mps)
            << slope << ' ' << bearing_deg << ' ' << against_mps;
      }
    }
  }
}

TEST(AirLanding, TouchesSoftlyWhereTheGroundRisesAndFallsBelowIt) {
  // Waves of 50 m length and 13 % of slope, as on the meadow of cooperative_parcel_f.
  for (const double bearing_deg : {0.0, 180.0}) {
    const HillLanding landing =
        land_on(0.0, {{"land_bearing_deg", bearing_deg}}, {0.0, 0.0}, 0.0, 1.0);
    EXPECT_LT(landing.touch_mps, 1.5) << bearing_deg;
  }
}

TEST(AirLanding, ChoosesACourseThatTheGroundAllows) {
  // Headed down a hillside at the start, without wind: not down it.
  const HillLanding calm = land_on(0.08, {}, {0.0, 0.0}, -0.5 * kPi);
  EXPECT_GE(calm.rise, -0.03);
  EXPECT_LT(calm.touch_mps, kSoft_mps);
  // Wind from downhill: across it rather than down the hill, never with it.
  const HillLanding windy = land_on(0.08, {}, {0.0, 3.0}, 0.0);
  EXPECT_GE(windy.rise, -0.03);
  EXPECT_LT(std::sin(windy.yaw_rad), 0.1);
  // On a level place against the wind.
  const HillLanding level = land_on(0.0, {}, {0.0, 3.0}, 0.0);
  EXPECT_NEAR(wrap_angle(level.yaw_rad + 0.5 * kPi), 0.0, 0.1);
}

TEST(AirLanding, KeepsItsCirclesAboveAHillAndWarnsWhereItCannot) {
  // It comes from the hill in the east. Above the gentler one higher circles help; on the steeper
  // one they would be higher than the glide can lose.
  for (const double rise : {0.3, 0.6}) {
    PlaneOptions options;
    options.terrain = [=](const Eigen::Vector2d& p) { return rise * std::max(0.0, p.x() - 50.0); };
    options.start_W = {0.0, 0.0, 60.0};
    VehicleDescription vehicle = make_plane_description();
    vehicle.fixed_wing->start_height_m = 60.0;
    AirBench bench({{"land_bearing_deg", -90.0}, {"land_at_m", std::vector<double>{0.0, 0.0}}},
                   options, "waypoint_guidance", vehicle);
    bench.give_plan(make_waypoints({{0, 0, 60}, {100, 0, 60}}));
    bench.fly(40.0);
    EXPECT_TRUE(bench.has_event("lands at (0.0, 0.0)"));
    EXPECT_EQ(bench.has_event("m of the ground: change approach_height_m"), rise > 0.5) << rise;
  }
}

}  // namespace
}  // namespace vinerow::test::air_landing_test
