/// Deposits in closed form, mass balance, wind, the tank, bad parameters.

#include "vehicles/payloads/sprayer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/vehicles/payloads/payload_rig.h"
#include "tests/worlds/world_fixture.h"

namespace vinerow::vehicles::sprayer_test {
namespace {

using namespace test;
using Eigen::Vector3d;

/// Nothing falls, nothing evaporates, leaves let nothing through, valves are prompt; nozzles in
/// B's plane x = 0.
PayloadValues ideal(const PayloadValues& more = {}) {
  PayloadValues values = {{"settling_mps", 0.0},
                          {"loss_length_m", 1e7},
                          {"boom_x_m", 0.0},
                          {"leaf_area_density_m2pm3", 200.0},
                          {"valve_lag_s", 0.0}};
  values.insert(values.end(), more.begin(), more.end());
  return values;
}

/// On both sides a wall 0.7 m from the nozzles that nothing misses.
std::vector<BoxRow> high_walls() {
  return {{.y_m = 2.0, .half_width_m = 1.0, .base_m = -0.5, .top_m = 6.0, .to_x_m = 30.0},
          {.y_m = -2.0, .half_width_m = 1.0, .base_m = -0.5, .top_m = 6.0, .to_x_m = 30.0}};
}

double litres_on(const PayloadRig& rig) {
  double ml = 0.0;
  for (const CanopyPatch& patch : rig.patches()) ml += patch.amount * patch.area_m2;
  return 1e-3 * ml;
}

/// Four nozzles of 0.2 l/min at 4 instead of 3 bar.
double side_flow_lps() {
  return 4.0 * 0.2 / 60.0 * std::sqrt(4.0 / 3.0);
}

void expect_balance(const PayloadRig& rig) {
  const auto r = rig.payload->results();
  const double sprayed = r.at("litres_sprayed");
  EXPECT_NEAR(r.at("litres_canopy") + r.at("litres_ground") + r.at("litres_lost"), sprayed,
              1e-10 * sprayed);
  EXPECT_NEAR(litres_on(rig), r.at("litres_canopy"), 1e-10 * sprayed);
}

TEST(Sprayer, DepositsFlowOverSpeedAndHeight) {
  for (const double speed : {0.5, 1.0, 2.0}) {
    PayloadRig rig("sprayer", make_box_rows(high_walls()),
                   ideal({{"row_reach_m", 3.0},
                          {"nozzle_heights_m", std::vector<double>{0.7, 1.05, 1.4, 1.75}}}));
    rig.pass(-1.0, 31.0, 0.0, speed);
    // ml on the wall per metre of row, and on a m2 of a band's height, away from the ends.
    double ml = 0.0, within_ml = 0.0, area_m2 = 0.0;
    for (const CanopyPatch& patch : rig.patches()) {
      if (patch.row != 10 || patch.along < 20 || patch.along >= 100) continue;
      ml += patch.amount * patch.area_m2;
      if (patch.band < 4 || patch.band >= 6) continue;
      if (patch.side == -1) within_ml += patch.amount * patch.area_m2, area_m2 += patch.area_m2;
    }
    const double line_ml_per_m = 1e3 * side_flow_lps() / speed;
    EXPECT_NEAR(ml, 20.0 * line_ml_per_m, 0.01 * 20.0 * line_ml_per_m) << speed << " m/s";
    // Nozzles 0.35 m apart whose cones overlap: between 1.0 and 1.5 m the wall gets a nozzle's flow
    // per 0.35 m of height, to what the hollow cones leave uneven.
    EXPECT_NEAR(within_ml / area_m2, line_ml_per_m / 4.0 / 0.35, 0.1 * line_ml_per_m / 4.0 / 0.35);
  }
}

// What a nozzle gives off in a tick comes out along the way since the last one: the middle of a
// tick's deposit lies half that way behind the nozzle, and on by how far drops fly with it, which
// is the same in a tick a hundredth as long.
TEST(Sprayer, ATicksPortionsLieBehindTheNozzle) {
  const auto middle_x_m = [](double rate_Hz) {
    PayloadRig rig("sprayer", make_box_rows(high_walls()),
                   ideal({{"row_reach_m", 3.0},
                          {"rays_per_nozzle", std::int64_t{100}},
                          {"spray_half_angle_deg", 1.0}}),
                   1, nullptr, rate_Hz);
    rig.tick(15.0, 0.0, 0.0, 1.0);  // valves open
    const auto moment = [&] {
      double ml = 0.0, x_ml = 0.0;
      for (const CanopyPatch& patch : rig.patches()) {
        ml += patch.amount * patch.area_m2;
        x_ml += patch.amount * patch.area_m2 * patch.p_W.x();
      }
      return Eigen::Vector2d(ml, x_ml);
    };
    const Eigen::Vector2d before = moment();
    rig.tick(15.0, 0.0, 0.0, 1.0);
    const Eigen::Vector2d tick = moment() - before;
    return tick.y() / tick.x();
  };
  // 1 m/s: half of 1 s is 0.5 m, half of 0.01 s 5 mm. Patches are 0.25 m long and share a drop
  // linearly, which keeps its place.
  EXPECT_NEAR(middle_x_m(1.0) - middle_x_m(100.0), -0.495, 0.01);
}

TEST(Sprayer, TwoPassesAddUp) {
  PayloadRig rig("sprayer", make_box_rows(high_walls()), ideal({{"row_reach_m", 3.0}}));
  rig.pass(-1.0, 31.0, 0.0, 1.0);
  const double once = rig.result("litres_canopy"), mean = rig.result("deposit_mean_ml_per_m2");
  rig.pass(31.0, -1.0, 0.0, 1.0);
  EXPECT_NEAR(rig.result("litres_canopy"), 2.0 * once, 0.005 * once);  // a tick more or less
  EXPECT_NEAR(rig.result("deposit_mean_ml_per_m2"), 2.0 * mean, 0.005 * mean);
  const double time_s = rig.result("spray_time_s");
  EXPECT_NEAR(time_s, 60.0, 0.2);
  // Whole milliseconds, without the errors of a sum.
  EXPECT_EQ(time_s, std::round(1000.0 * time_s) / 1000.0);
}

TEST(Sprayer, TellsLitresPerHectareOfTheAlley) {
  // Rows 2.5 m apart: an alley's worth of ground is 2.5 m2 per metre.
  PayloadRig rig("sprayer",
                 make_box_rows({{.y_m = 1.25, .to_x_m = 40.0}, {.y_m = -1.25, .to_x_m = 40.0}}),
                 ideal());
  rig.pass(-2.0, 42.0, 0.3, 0.8);  // off the middle: the same in sum
  EXPECT_NEAR(rig.result("litres_per_ha"), 1e4 * 2.0 * side_flow_lps() / (0.8 * 2.5), 1e-6);
  EXPECT_EQ(rig.result("litres_off_row"), 0.0);
}

TEST(Sprayer, TellsWhatItSpraysBeyondTheEndsOfTheRows) {
  PayloadRig rig("sprayer",
                 make_box_rows({{.y_m = 1.25, .to_x_m = 40.0}, {.y_m = -1.25, .to_x_m = 40.0}}),
                 ideal({{"beyond_end_m", 1.5}}));
  rig.pass(-3.0, 43.0, 0.0, 0.8);
  // 1.5 m at either end at 0.8 m/s; valves act and rows begin within a tick of 0.05 s.
  const double flow_lps = 2.0 * side_flow_lps();
  EXPECT_NEAR(rig.result("litres_off_row"), flow_lps * 3.0 / 0.8, flow_lps * 4.0 * 0.05);
}

// A full cone that fills its solid angle evenly: the cosine c of the angle to the axis is uniform
// between cos a and 1, so tan^2 has the mean 1 / cos a - 1, half of it upwards.
TEST(Sprayer, AConeIsFilledEvenly) {
  const double a_deg = 40.0, wall_m = 0.7, band_m = 0.25;
  PayloadRig rig("sprayer", make_box_rows(high_walls()),
                 ideal({{"row_reach_m", 3.0},
                        {"rays_per_nozzle", std::int64_t{100}},
                        {"hollow_share", 0.0},
                        {"spray_half_angle_deg", a_deg},
                        {"nozzle_elevation_deg", std::vector<double>{0.0}},
                        {"nozzle_heights_m", std::vector<double>{2.0}}}));
  rig.pass(10.0, 20.0, 0.0, 1.0);
  double ml = 0.0, z_ml = 0.0, z2_ml = 0.0;
  for (const CanopyPatch& patch : rig.patches()) {
    const double here_ml = patch.amount * patch.area_m2, z_m = patch.p_W.z();
    ml += here_ml, z_ml += here_ml * z_m, z2_ml += here_ml * z_m * z_m;
  }
  const double mean_m = z_ml / ml, variance_m2 = z2_ml / ml - mean_m * mean_m;
  EXPECT_NEAR(mean_m, 2.0, 0.01);
  // A drop is shared by the two bands next to it, which adds a sixth of a band's height squared.
  const double expected_m2 =
      0.5 * wall_m * wall_m * (1.0 / std::cos(rad_from_deg(a_deg)) - 1.0) + band_m * band_m / 6.0;
  EXPECT_NEAR(variance_m2, expected_m2, 0.04 * expected_m2);
}

TEST(Sprayer, AThinnerCanopyCatchesByBeersLaw) {
  // One straight jet into a wall of 0.5 m and k = 0.5 * 4 / m; what comes through is lost.
  PayloadRig rig("sprayer", make_box_rows({{.y_m = 1.25, .base_m = -0.5, .top_m = 6.0}}),
                 ideal({{"leaf_area_density_m2pm3", 4.0},
                        {"spray_half_angle_deg", 0.0},
                        {"nozzle_heights_m", std::vector<double>{1.2}}}));
  rig.pass(2.0, 18.0, 0.0, 1.0);
  // The jet leans forward by 1 / 25: the chord is 0.08 % longer.
  EXPECT_NEAR(rig.result("on_target_share"), 1.0 - std::exp(-1.0), 5e-4);
  expect_balance(rig);
}

TEST(Sprayer, KeepsTheMassInARealVineyard) {
  auto parameters = vinerow::test::world_parameters("vineyard");
  parameters.set("row_count", std::int64_t{5});
  parameters.set("row_length_m", 20.0);
  parameters.set("row_bearing_deg", 90.0);
  parameters.set("relief_m", 0.0);
  auto world = vinerow::test::make_world("vineyard", parameters);
  world->wind.mean_speed_mps = 4.0;
  world->wind.turbulence = 1.0;
  world->wind.shelter_attenuation = 1.2;
  const Vector3d from = world->rows->alleys[2].line_W.front(),
                 to = world->rows->alleys[2].line_W.back();
  PayloadRig rig("sprayer", *world);
  rig.z_m = from.z() + 0.4;
  rig.pass(std::min(from.x(), to.x()) - 2.0, std::max(from.x(), to.x()) + 2.0, from.y(), 1.0);
  expect_balance(rig);
  EXPECT_GT(rig.result("litres_sprayed"), 0.5);
  EXPECT_GT(rig.result("litres_lost"), 0.0);
  EXPECT_GT(rig.result("litres_ground"), 0.0);
  // Full canopies: more than 64 % on leaves and grapes (Pergher, Gubiani, Tonetto, 1997, leaf area
  // index 1.9).
  EXPECT_GT(rig.result("on_target_share"), 0.64);
  EXPECT_LT(rig.result("on_target_share"), 0.95);
  // A face each of two of five rows.
  EXPECT_NEAR(rig.result("worked_share"), 2.0 / 10.0, 0.03);
  EXPECT_GT(rig.result("worked_covered_share"), 0.5);
  EXPECT_LT(rig.result("covered_share"), rig.result("worked_covered_share"));
}

double deposit_centre_x(const PayloadRig& rig) {
  double ml = 0.0, moment = 0.0;
  for (const CanopyPatch& patch : rig.patches()) {
    ml += patch.amount * patch.area_m2;
    moment += patch.amount * patch.area_m2 * 0.25 * (patch.along + 0.5);
  }
  return moment / ml;
}

TEST(Sprayer, WindAlongTheRowShiftsTheDeposit) {
  const auto centre = [](double wind_mps) {
    WorldModel world = make_box_rows(high_walls());
    world.wind.height_law = WindHeightLaw::kUniform;
    world.wind.mean_speed_mps = std::abs(wind_mps);
    world.wind.from_azimuth_rad =
        wind_mps > 0.0 ? 1.5 * kPi : 0.5 * kPi;  // from the west: along +x
    PayloadRig rig(
        "sprayer", std::move(world),
        ideal({{"row_reach_m", 3.0}, {"spray_half_angle_deg", 0.0}, {"beyond_end_m", -5.0}}));
    rig.pass(0.0, 30.0, 0.0, 1.0);
    return deposit_centre_x(rig);
  };
  // 0.7 m to the wall. The jet leans by (v - w) / U and is carried by w t(x), where the walked way
  // takes t straight between 0.5 and 1 m.
  const auto expected = [](double w) {
    const double speed = std::hypot(25.0, 1.0 - w), x = 0.7 * speed / 25.0;
    const auto t = [&](double at) { return (at + at * at / 1.2) / speed; };
    return x * (1.0 - w) / speed + w * (t(0.5) + (x - 0.5) / 0.5 * (t(1.0) - t(0.5)));
  };
  EXPECT_NEAR(centre(5.0) - centre(0.0), expected(5.0) - expected(0.0), 2e-3);
  EXPECT_NEAR(centre(-5.0) - centre(0.0), expected(-5.0) - expected(0.0), 2e-3);
}

TEST(Sprayer, WindAcrossTheRowsSendsMoreOverThem) {
  const auto lost = [](double wind_mps) {
    WorldModel world = make_box_rows({{.y_m = 1.25}, {.y_m = -1.25}});
    world.wind.height_law = WindHeightLaw::kUniform;
    world.wind.mean_speed_mps = wind_mps;
    world.wind.from_azimuth_rad = kPi;  // from the south: along +y
    PayloadRig rig("sprayer", std::move(world));
    rig.pass(-1.0, 21.0, 0.0, 1.0);
    expect_balance(rig);
    return rig.result("on_target_share");
  };
  EXPECT_LT(lost(8.0), lost(0.0));
}

TEST(Sprayer, AnEmptyTankClosesTheNozzlesAndSaysSo) {
  PayloadRig rig("sprayer", make_box_rows({{.y_m = 1.25}, {.y_m = -1.25}}),
                 ideal({{"tank_l", 0.2}}));
  rig.pass(-1.0, 19.0, 0.0, 1.0);
  EXPECT_NEAR(rig.result("litres_sprayed"), 0.2, 1e-12);
  EXPECT_EQ(rig.result("litres_left"), 0.0);
  EXPECT_NEAR(rig.result("spray_time_s"), 0.2 / (2.0 * side_flow_lps()), 1e-9);
  EXPECT_EQ(rig.signal_value("left_on"), 0.0);
  EXPECT_EQ(rig.signal_value("flow_lps"), 0.0);
  ASSERT_EQ(rig.event.sequence(), 1u);
  EXPECT_EQ(rig.event.value().level, Event::Level::kWarning);
  EXPECT_EQ(rig.event.value().text.find("the tank is empty after 0.2 l at ("), 0u)
      << rig.event.value().text;
  expect_balance(rig);
}

/// Rows 10 m apart: 5 m from the middle of the alley, and its default reach is 2 m.
TEST(Sprayer, ReportsOnceThatNoRowIsInReachFromTheMiddleOfAnAlley) {
  const auto reports = [](double reach_m) {
    WorldModel world = make_box_rows({{.y_m = 5.0}, {.y_m = -5.0}});
    RowMap map = *world.rows;
    map.alleys.push_back({0, {{0.0, 0.0, 0.0}, {20.0, 0.0, 0.0}}, 10.0});
    PayloadRig rig("sprayer", world, ideal({{"row_reach_m", reach_m}}), 1, &map);
    rig.tick(10.0, 0.0, 0.0, 1.0);
    rig.tick(11.0, 0.0, 0.0, 1.0);
    EXPECT_EQ(rig.signal_value("left_on"), reach_m >= 5.0 ? 1.0 : 0.0);
    return std::pair(rig.event.sequence(), rig.event.has_value() ? rig.event.value().text : "");
  };
  EXPECT_EQ(reports(5.0), std::pair(std::uint64_t{0}, std::string()));
  EXPECT_EQ(reports(2.0),
            std::pair(std::uint64_t{1},
                      std::string("row_reach_m = 2 m reaches no row from the middle of an alley, "
                                  "where the nearest one is 5 m away: the sections open only where "
                                  "the vehicle is nearer to a row")));
}

TEST(Sprayer, TellsWhatItDoesWhileItDoesIt) {
  PayloadRig rig("sprayer", make_box_rows({{.y_m = 1.25}}), ideal());
  rig.tick(10.0, 0.0, 0.0, 1.0);
  EXPECT_EQ(rig.signal_value("left_on"), 1.0);
  EXPECT_EQ(rig.signal_value("right_on"), 0.0);
  EXPECT_NEAR(rig.signal_value("flow_lps"), side_flow_lps(), 1e-12);
  EXPECT_NEAR(rig.signal_value("tank_l"), 60.0 - 0.05 * side_flow_lps(), 1e-12);
  EXPECT_NEAR(rig.signal_value("sprayed_l"), 0.05 * side_flow_lps(), 1e-15);
}

TEST(Sprayer, BadParametersAreToldInASentence) {
  const auto error = [](const PayloadValues& values) {
    return config_error_of([&] { PayloadRig("sprayer", make_box_rows({{.y_m = 1.0}}), values); });
  };
  EXPECT_EQ(error({{"nozzle_heights_m", std::vector<double>{}}}),
            "rover.p: nozzle_heights_m = [], must name at least one nozzle");
  EXPECT_EQ(error({{"nozzle_elevation_deg", std::vector<double>{1.0, 2.0}}}),
            "rover.p: nozzle_elevation_deg has 2 entries, must have 1 or as many as "
            "nozzle_heights_m (4)");
  EXPECT_EQ(error({{"nozzle_offset_m", 0.6}, {"row_reach_m", 0.5}}),
            "rover.p: row_reach_m = 0.5 m, must be > nozzle_offset_m = 0.6 m: no row would be in "
            "reach");
  EXPECT_NE(error({{"tank_l", 0.0}}).find("tank_l = 0 l, must be > 0"), std::string::npos);
  EXPECT_NE(error({{"hollow_share", 1.5}}).find("hollow_share = 1.5"), std::string::npos);
  const RowMap nothing;
  EXPECT_EQ(
      config_error_of(
          [&] { PayloadRig("sprayer", make_box_rows({{.y_m = 1.0}}), {}, 1, &nothing); }),
      "rover.p: the vehicle's map has no rows, must have at least one: sections open beside rows");
}

}  // namespace
}  // namespace vinerow::vehicles::sprayer_test
