/// Height laws, gusts, calm, and what a probe promises: same bits, no heap, its own turbulence.

#include "vehicles/parts/wind_probe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/support/no_alloc.h"
#include "tests/vehicles/wind/wind_rig.h"

namespace vinerow::vehicles::wind_probe_test {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr Duration kStep{1'000'000};

Wind everything() {
  Wind wind = west_wind(4.0);
  wind.height_law = WindHeightLaw::kLogarithmic;
  wind.turbulence = 1.0;
  wind.gusts.push_back({.start_s = 0.5, .duration_s = 1.0, .amplitude_mps = 3.0});
  wind.random_gusts = GustStatistics{.interval_s = 5.0};
  wind.shelter_attenuation = 1.2;
  return wind;
}

TEST(MeanWind, FollowsTheHeightLaws) {
  Wind wind = west_wind(6.0);
  EXPECT_EQ(mean_wind_mps(wind, 0.5), 6.0);
  EXPECT_EQ(mean_wind_mps(wind, 100.0), 6.0);
  wind.height_law = WindHeightLaw::kLogarithmic;  // z0 = 0.1 m, reference 10 m: ln 100
  EXPECT_NEAR(mean_wind_mps(wind, 10.0), 6.0, 1e-12);
  EXPECT_NEAR(mean_wind_mps(wind, 1.0), 3.0, 1e-12);
  EXPECT_NEAR(mean_wind_mps(wind, 100.0), 9.0, 1e-12);
  EXPECT_EQ(mean_wind_mps(wind, 0.1), 0.0);
  EXPECT_EQ(mean_wind_mps(wind, -3.0), 0.0);
  wind.height_law = WindHeightLaw::kPower;
  wind.power_exponent = 0.5;
  EXPECT_NEAR(mean_wind_mps(wind, 2.5), 3.0, 1e-12);
  EXPECT_NEAR(mean_wind_mps(wind, 40.0), 12.0, 1e-12);
  EXPECT_EQ(mean_wind_mps(wind, 0.0), 0.0);
}

TEST(MeanWind, ShearsEvenlyFromTheGround) {
  Wind wind = west_wind(6.0);
  wind.height_law = WindHeightLaw::kLinear;
  EXPECT_NEAR(mean_wind_mps(wind, 2.5), 1.5, 1e-12);
  wind.ground_speed_mps = -2.0;  // turns round at a quarter of the reference height
  EXPECT_NEAR(mean_wind_mps(wind, 0.0), -2.0, 1e-12);
  EXPECT_NEAR(mean_wind_mps(wind, -5.0), -2.0, 1e-12);
  EXPECT_NEAR(mean_wind_mps(wind, 2.5), 0.0, 1e-12);
  EXPECT_NEAR(mean_wind_mps(wind, 30.0), 22.0, 1e-12);
  EXPECT_NEAR(turbulence_wind_mps(wind), -2.0 + 8.0 * 0.6096, 1e-12);
  WindRig rig(wind);
  EXPECT_LT((rig.sample(kStep, {0, 0, 0}) - Vector3d(-2.0, 0, 0)).norm(), 1e-12);
  wind.mean_speed_mps = 0.0;
  EXPECT_FALSE(wind.calm());
  wind.ground_speed_mps = 0.0;
  EXPECT_TRUE(wind.calm());
}

TEST(MeanWind, SetsTheTurbulenceAt20FeetUnlessTold) {
  Wind wind = west_wind(6.0);
  wind.height_law = WindHeightLaw::kLogarithmic;
  EXPECT_NEAR(turbulence_wind_mps(wind), 6.0 * std::log(60.96) / std::log(100.0), 1e-12);
  wind.turbulence_wind_mps = 2.0;
  EXPECT_EQ(turbulence_wind_mps(wind), 2.0);
}

/// A bounded disturbance: its direction stays, its length is cut; what is shorter stays as it is.
TEST(WindProbe, LimitsTheTurbulencesLength) {
  Wind wind = west_wind(0.0);
  wind.turbulence = 1.0;
  wind.turbulence_wind_mps = 6.0;
  WindRig free(wind), limited(wind);
  limited.world.wind.turbulence_limit_mps = 1.0;
  const Vector3d v_W(12.0, 0.0, 0.0);
  int cut = 0, kept = 0;
  for (Time now; now.s() < 600.0; now = now + kStep) {
    const Vector3d at = Vector3d(0, 0, 40.0) + now.s() * v_W;
    const Vector3d all = free.probe->sample(now, at, v_W, kStep);
    const Vector3d some = limited.probe->sample(now, at, v_W, kStep);
    if (all.norm() > 1.0) {
      ++cut;
      ASSERT_LT((some - all / all.norm()).norm(), 1e-12);
    } else {
      ++kept;
      ASSERT_EQ(some, all);
    }
  }
  RecordProperty("cut_percent", 100 * cut / (cut + kept));
  EXPECT_GT(cut, 100'000);
  EXPECT_GT(kept, 30'000);
}

/// US Standard Atmosphere 1976, table I: density at geometric altitudes.
TEST(WindProbe, TellsTheDensityOfTheStandardAtmosphere) {
  Wind wind = west_wind(0.0);
  EXPECT_TRUE(WindRig(wind).probe->calm());
  wind.atmosphere = Atmosphere::kStandard76;
  wind.air_density_kgm3 = 9.0;  // counts for nothing
  WindRig rig(wind);
  EXPECT_FALSE(rig.probe->calm());
  EXPECT_TRUE(wind.calm());  // there is no wind all the same
  const double table[][2] = {{0.0, 1.2250},       {1'000.0, 1.1117},    {5'000.0, 0.73643},
                             {11'000.0, 0.36480}, {20'000.0, 0.088910}, {32'000.0, 0.013555}};
  for (const auto& [altitude_m, density] : table) {
    EXPECT_EQ(rig.sample(kStep, {0, 0, altitude_m}), Vector3d::Zero());
    EXPECT_NEAR(rig.probe->air_density_kgm3(), density, 0.6e-4 * density) << altitude_m;
  }
  // W's origin is up there itself.
  rig.world.origin.altitude_m = 1'000.0;
  WindProbe high(rig.world, rig.scene, RandomStream(1, "drone", "wind"));
  EXPECT_NEAR(high.air_density_kgm3(), 1.1117, 0.6e-4);
  high.sample({}, {0, 0, 4'000.0}, Vector3d::Zero(), kStep);
  EXPECT_NEAR(high.air_density_kgm3(), 0.73643, 0.6e-4);
}

TEST(WindProbe, AConstantAtmosphereIsTheStandardsWhereTheWorldIs) {
  WindRig rig(west_wind(0.0));
  EXPECT_EQ(rig.probe->air_density_kgm3(), 1.225);
  EXPECT_TRUE(rig.probe->calm());
  // Table I at 1000 m and 5000 m; the same at every height above.
  for (const auto& [altitude_m, density] : {std::pair{1'000.0, 1.1117}, {5'000.0, 0.73643}}) {
    rig.world.origin.altitude_m = altitude_m;
    WindProbe probe(rig.world, rig.scene, RandomStream(1, "drone", "wind"));
    EXPECT_NEAR(probe.air_density_kgm3(), density, 0.6e-4 * density);
    probe.sample({}, {0, 0, 300.0}, Vector3d::Zero(), kStep);
    EXPECT_NEAR(probe.air_density_kgm3(), density, 0.6e-4 * density);
  }
  rig.world.wind.air_density_kgm3 = 1.1;
  EXPECT_EQ(WindProbe(rig.world, rig.scene, RandomStream(1, "drone", "wind")).air_density_kgm3(),
            1.1);
}

TEST(WindProbe, BlowsFromWhereItIsSaid) {
  // From north-east (45 deg clockwise from north): to the south-west.
  Wind wind = west_wind(2.0);
  wind.from_azimuth_rad = rad_from_deg(45.0);
  WindRig rig(wind);
  EXPECT_NEAR((rig.sample(kStep, {1, 2, 3}) - Vector3d(-std::sqrt(2), -std::sqrt(2), 0)).norm(),
              0.0, 1e-12);
}

TEST(WindProbe, MeasuresHeightAboveTheGroundBelow) {
  Wind wind = west_wind(6.0);
  wind.height_law = WindHeightLaw::kLogarithmic;
  WorldModel world;
  world.wind = wind;
  world.terrain = HeightField{.columns = 2,
                              .rows = 2,
                              .cell_m = 100.0,
                              .corner_W = {0, 0},
                              .heights_m = {0.0f, 50.0f, 0.0f, 50.0f}};
  vinerow::test::PlainScene scene;
  WindProbe probe(world, scene, RandomStream(1, "drone", "wind"));
  // At x = 40 m the ground is at 20 m; outside its edge continues.
  EXPECT_NEAR(probe.sample({}, {40, 30, 21}, Vector3d::Zero(), kStep).x(), 3.0, 1e-6);
  EXPECT_NEAR(probe.sample({}, {-40, 30, 10}, Vector3d::Zero(), kStep).x(), 6.0, 1e-6);
  // Without terrain the scene's height counts; if the scene has no height, the last one counts.
  WindRig rig(wind);
  rig.scene.height = [](double, double) { return -9.0; };
  EXPECT_NEAR(rig.sample(kStep, {0, 0, 1}).x(), 6.0, 1e-12);
  rig.scene.height = [](double, double) { return std::nullopt; };
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(rig.sample(kStep, {0, 0, 1}).x(), 6.0, 1e-12);
}

TEST(WindProbe, CalmIsExactlyZero) {
  Wind dead;
  dead.turbulence = 1.0;  // nothing to scale with
  dead.shelter_attenuation = 1.0;
  for (const Wind& wind : {Wind{}, dead}) {
    WindRig rig(wind, 1, five_rows());
    EXPECT_TRUE(rig.probe->calm());
    for (int i = 0; i < 100; ++i) EXPECT_EQ(rig.sample(kStep, {0, 1, 1}), Vector3d::Zero());
  }
  EXPECT_FALSE(WindRig(west_wind(1.0)).probe->calm());
}

TEST(Gusts, PulseIsOneMinusCosine) {
  Wind wind;
  wind.gusts.push_back({.start_s = 2.0,
                        .duration_s = 4.0,
                        .amplitude_mps = 3.0,
                        .from_azimuth_rad = rad_from_deg(180.0),
                        .vertical_mps = -1.0});
  WindRig rig(wind);
  for (int i = 0; i < 8000; ++i) {
    const double t_s = i * 1e-3;
    const Vector3d& felt = rig.sample(kStep, {7, 8, 9});
    const double pulse =
        t_s > 2.0 && t_s < 6.0 ? std::pow(std::sin(kPi * (t_s - 2.0) / 4.0), 2) : 0.0;
    ASSERT_NEAR((felt - pulse * Vector3d(0, 3, -1)).norm(), 0.0, 1e-12) << t_s;
  }
}

TEST(Gusts, WithoutADirectionBlowsAsTheMeanWind) {
  Wind wind;
  wind.from_azimuth_rad = rad_from_deg(90.0);  // from the east: to -x
  wind.gusts.push_back({.start_s = 0.0, .duration_s = 2.0, .amplitude_mps = 3.0});
  wind.gusts.push_back({.start_s = 0.0,
                        .duration_s = 2.0,
                        .amplitude_mps = 1.0,
                        .from_azimuth_rad = 0.0});  // from the north, whatever the wind does
  EXPECT_LT((calc_gust_W(wind, wind.gusts[0], 1.0, {0, 0}) - Vector3d(-3, 0, 0)).norm(), 1e-12);
  EXPECT_LT((calc_gust_W(wind, wind.gusts[1], 1.0, {0, 0}) - Vector3d(0, -1, 0)).norm(), 1e-12);
  // Its front comes from the east as well: 10 m to the west a second late, in its middle at 2 s.
  wind.gusts[0].front_speed_mps = 10.0;
  EXPECT_NEAR(gust_pulse(wind, wind.gusts[0], 2.0, {-10, 5}), 1.0, 1e-12);
  EXPECT_EQ(gust_pulse(wind, wind.gusts[0], 2.0, {10, 5}), 0.0);
}

TEST(Gusts, AFrontArrivesLaterDownwind) {
  WindGust gust{.start_s = 10.0,
                .duration_s = 2.0,
                .amplitude_mps = 3.0,
                .from_azimuth_rad = rad_from_deg(270.0)};
  gust.front_speed_mps = 5.0;
  // 20 m downwind it is 4 s later, 10 m upwind 2 s earlier; across the wind it does not matter.
  for (const auto& [x, late_s] : {std::pair{0.0, 0.0}, {20.0, 4.0}, {-10.0, -2.0}}) {
    EXPECT_NEAR(gust_pulse(Wind{}, gust, 11.0 + late_s, {x, 33.0}), 1.0, 1e-12);
    EXPECT_NEAR(gust_pulse(Wind{}, gust, 10.5 + late_s, {x, -4.0}), 0.5, 1e-12);
    EXPECT_EQ(gust_pulse(Wind{}, gust, 9.999 + late_s, {x, 0.0}), 0.0);
    EXPECT_EQ(gust_pulse(Wind{}, gust, 12.001 + late_s, {x, 0.0}), 0.0);
  }
}

TEST(Gusts, ByChanceComeOncePerIntervalAndNeverOverlap) {
  Wind wind;
  wind.random_gusts =
      GustStatistics{.interval_s = 20.0, .amplitude_mps = 2.0, .duration_s = 3.0, .seed = 5};
  RandomGusts gusts(wind);
  WindGust last;
  int count = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double end_s = 0.0;
  for (double t_s = 0.0; t_s < 200'000.0; t_s += 0.5) {
    const WindGust& gust = gusts.at(t_s);
    if (count > 0 && gust.start_s == last.start_s) continue;
    EXPECT_GE(gust.start_s, end_s);
    EXPECT_EQ(gust.amplitude_mps, 2.0);
    end_s = gust.start_s + gust.duration_s;
    mean += downwind_direction(gust.from_azimuth_rad.value());
    last = gust;
    ++count;
  }
  // Rests are exponential with mean 17 s: 10,000 gusts, deviation 17 / 20 sqrt(10000) = 85.
  EXPECT_NEAR(count, 10'000, 4 * 85);
  EXPECT_LT(mean.norm() / count, 4.0 / std::sqrt(count));  // from any side alike
}

TEST(Gusts, ByChanceAreTheSameForEveryVehicleAndOthersWithAnotherSeed) {
  Wind wind;
  wind.random_gusts = GustStatistics{.interval_s = 3.0, .seed = 5};
  WindRig first(wind, 1, {}, "first"), second(wind, 2, {}, "second");
  wind.random_gusts->seed = 6;
  WindRig other(wind, 1, {}, "first");
  double apart_mps = 0.0;
  bool blew = false;
  for (int i = 0; i < 60'000; ++i) {
    const Vector3d felt = first.sample(kStep, {0, 0, 2});
    ASSERT_EQ(felt, second.sample(kStep, {40, 3, 20}));
    apart_mps = std::max(apart_mps, (felt - other.sample(kStep, {0, 0, 2})).norm());
    blew = blew || felt.norm() > 0.9;
  }
  EXPECT_TRUE(blew);
  EXPECT_GT(apart_mps, 0.5);
}

TEST(WindProbe, SameBitsTwice) {
  WindRig first(everything(), 3, five_rows()), second(everything(), 3, five_rows());
  for (int i = 0; i < 5000; ++i) {
    const Vector3d p(0.001 * i, 3.0, 0.5 + 1e-3 * i);
    ASSERT_EQ(first.sample(kStep, p), second.sample(kStep, p)) << i;
  }
}

TEST(WindProbe, AnotherVehiclesTurbulenceIsItsOwn) {
  WindRig alone(everything(), 3), beside(everything(), 3), other(everything(), 3, {}, "rover");
  double apart_mps = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d p(0, 0, 3);
    const Vector3d felt = alone.sample(kStep, p);
    apart_mps = std::max(apart_mps, (felt - other.sample(kStep, p)).norm());
    ASSERT_EQ(felt, beside.sample(kStep, p)) << i;
  }
  EXPECT_GT(apart_mps, 0.1);
}

TEST(WindProbe, AllocatesNothing) {
  Wind wind = everything();
  WindRig rig(wind, 3, five_rows());
  rig.sample(kStep, {0, 0, 1});
  vinerow::test::AllocationCounter counter;
  for (int i = 0; i < 20'000; ++i) rig.sample(kStep, {0.001 * i, 0.001 * i, 1.0});
  EXPECT_EQ(counter.count(), 0u);
}

std::string error_of(const Wind& wind) {
  try {
    WindRig rig(wind);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(WindProbe, RefusesAWindThatCannotBe) {
  Wind wind = west_wind(3.0);
  EXPECT_EQ(error_of(wind), "no error");
  wind.roughness_length_m = 12.0;  // of no account under the uniform law
  EXPECT_EQ(error_of(wind), "no error");
  wind.height_law = WindHeightLaw::kLogarithmic;
  EXPECT_EQ(error_of(wind), "wind: roughness_length_m = 12 m, must be < reference_height_m = 10 m");
  wind = west_wind(-3.0);
  EXPECT_EQ(error_of(wind), "wind: mean_speed_mps = -3 m/s, must be >= 0 m/s and <= 100 m/s");
  wind = west_wind(std::nan(""));
  EXPECT_EQ(error_of(wind), "wind: mean_speed_mps = nan, must be a finite number");
  wind = west_wind(3.0);
  wind.gusts = {{}, {.duration_s = 0.0}};
  EXPECT_EQ(error_of(wind), "wind: gusts[1]: duration_s = 0 s, must be > 0 s");
  wind = west_wind(3.0);
  wind.random_gusts = GustStatistics{.interval_s = 2.0, .duration_s = 2.0};
  EXPECT_EQ(
      error_of(wind),
      "wind: random_gusts: interval_s = 2 s, must be > duration_s = 2 s, because random gusts do "
      "not overlap");
}

}  // namespace
}  // namespace vinerow::vehicles::wind_probe_test
