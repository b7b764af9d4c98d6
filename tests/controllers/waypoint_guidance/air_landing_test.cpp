/// Where the guidance lands that knows the ground at its start only.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

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
  return found == bench.events().end() ? Event{} : *found;
}

TEST(AirLanding, WarnsOfGroundThatNobodyTold) {
  const std::vector<double> far = {300.0, 400.0};
  const Event guess = land({{"land_at_m", far}});
  EXPECT_EQ(guess.level, Event::Level::kWarning);
  EXPECT_THAT(guess.text,
              ::testing::HasSubstr("; takes the ground there to be at z = 0.0 m as at the start, "
                                 "500 m away: land_height_m tells it"));
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

}  // namespace
}  // namespace vinerow::test::air_landing_test
