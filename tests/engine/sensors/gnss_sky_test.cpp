/// Orbits against closed forms and their documents, and dilutions against other arithmetic.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/sensors/gnss_geometry.h"
#include "engine/sensors/gnss_sky.h"

namespace vinerow::sensors::gnss_sky_test {
namespace {

using Eigen::Vector3d;

constexpr double kDay_s = 86'400.0;

std::vector<CircularOrbit> all_orbits() {
  std::vector<CircularOrbit> orbits = gps_orbits();
  const std::vector<CircularOrbit> galileo = galileo_orbits();
  orbits.insert(orbits.end(), galileo.begin(), galileo.end());
  return orbits;
}

double elevation_deg(const Vector3d& direction_W) {
  return deg_from_rad(std::asin(direction_W.z()));
}

TEST(GnssSky, RadiiAndPeriodsAreThoseOfTheDocumentsAndOfKepler) {
  ASSERT_EQ(gps_orbits().size(), 24u);
  ASSERT_EQ(galileo_orbits().size(), 24u);
  constexpr double kMu = 3.986004418e14;
  for (const CircularOrbit& orbit : all_orbits()) {
    for (double t = 0.0; t < kDay_s; t += 5'000.0) {
      EXPECT_NEAR(orbit.position_E(t).norm(), orbit.radius_m, 1e-6);
    }
    const double period_s = 2.0 * kPi / orbit.phase_rate_radps;
    // The Earth's flattening, left out of Kepler's law, takes 2 s.
    EXPECT_NEAR(period_s, 2.0 * kPi * std::sqrt(std::pow(orbit.radius_m, 3) / kMu), 3.0);
  }
  // Half a sidereal day; 14 h 04 min 42 s.
  EXPECT_NEAR(2.0 * kPi / gps_orbits()[0].phase_rate_radps, 86'164.1 / 2.0, 6.0);
  EXPECT_NEAR(2.0 * kPi / galileo_orbits()[0].phase_rate_radps, 50'682.0, 2.0);
}

TEST(GnssSky, SlotsStandWhereTheirTablesSay) {
  // The standard gives Greenwich's hour angle at its epoch: 18 h 36 min 14.4 s.
  const double gps_epoch_s = -205'243'200.0;  // Julian date 2449169.5
  EXPECT_NEAR(deg_from_rad(sidereal_angle_rad(gps_epoch_s)) + 360.0, 279.06, 0.01);
  // Rotations about x by the inclination and about z by node less hour angle, done apart, km; the
  // hour angle of the document is rounded by 0.005 deg, which is 2 km.
  EXPECT_NEAR((gps_orbits()[0].position_E(gps_epoch_s) / 1e3 -
               Vector3d(-2511.2628, -15042.4418, -21744.7963))
                  .norm(),
              0.0, 2.5);
  EXPECT_NEAR((gps_orbits()[14].position_E(gps_epoch_s) / 1e3 -
               Vector3d(-22536.6596, -6370.2057, 12527.4545))
                  .norm(),
              0.0, 2.5);
  // 2010-03-21: Julian date 2455276.5, hour angle 178.4037657 deg; plane 2, slot 3.
  EXPECT_NEAR((galileo_orbits()[10].position_E((2455276.5 - 2451545.0) * kDay_s) / 1e3 -
               Vector3d(11919.8803, 11832.6535, 24373.8300))
                  .norm(),
              0.0, 1e-3);
}

TEST(GnssSky, GpsComesBackToItsGroundTrack) {
  // One turn of the Earth under a node that goes back by 4.4874e-7 deg/s.
  const double return_s = 360.0 / (360.98564736629 / kDay_s + 4.4874e-7);
  for (const CircularOrbit& orbit : gps_orbits()) {
    EXPECT_NEAR((orbit.position_E(7e8 + return_s) - orbit.position_E(7e8)).norm(), 0.0, 5.0);
  }
}

TEST(GnssSky, FromThePoleNoneStandsHigherThanItsInclinationAllows) {
  // Closed form: 90 deg - inclination apart at the Earth's centre, polar radius 6356.752 km.
  const GeoOrigin pole{kPi / 2.0, 0.0, 0.0};
  const struct {
    std::vector<CircularOrbit> orbits;
    double highest_deg;
  } cases[] = {{gps_orbits(), 45.30984}, {galileo_orbits(), 47.68792}};
  for (const auto& [orbits, highest_deg] : cases) {
    const GnssSky sky(pole, orbits, 7e8);
    double highest = -90.0;
    for (double t = 0.0; t < kDay_s; t += 60.0) {
      for (std::size_t i = 0; i < sky.size(); ++i) {
        highest = std::max(highest, elevation_deg(sky.direction_W(i, t)));
      }
    }
    EXPECT_LE(highest, highest_deg + 1e-4);
    EXPECT_GT(highest, highest_deg - 0.01);
  }
}

TEST(GnssSky, OverTheEquatorASatelliteAtItsNodeIsAtTheZenithAndGoesNorth) {
  CircularOrbit orbit = galileo_orbits()[0];
  orbit.epoch_s = 5e8;
  orbit.phase_rad = 0.0;
  const double longitude_rad = 0.7;
  orbit.node_rad = sidereal_angle_rad(5e8) + longitude_rad;
  const GnssSky sky({0.0, longitude_rad, 100.0}, {orbit}, 5e8);
  EXPECT_NEAR((sky.direction_W(0, 0.0) - Vector3d::UnitZ()).norm(), 0.0, 1e-9);
  const Vector3d later = sky.direction_W(0, 600.0);
  // Over ground: north w sin i, east w cos i less the Earth's turn, at 56 deg and 1.7 turns a day.
  EXPECT_NEAR(later.x() / later.y(),
              (std::cos(rad_from_deg(56.0)) - 50'681.0 / 86'164.1) / std::sin(rad_from_deg(56.0)),
              2e-3);
  EXPECT_GT(later.y(), 0.05);
}

TEST(GnssSky, AMiddleLatitudeSeesEnoughAllDay) {
  const GnssSky sky({rad_from_deg(44.6), rad_from_deg(7.9), 300.0}, gps_orbits(), 7e8);
  for (double t = 0.0; t < kDay_s; t += 300.0) {
    int seen = 0;
    for (std::size_t i = 0; i < sky.size(); ++i) seen += elevation_deg(sky.direction_W(i, t)) > 5.0;
    // GPS SPS Performance Standard: the constellation is laid out for four or more above 5 deg.
    EXPECT_GE(seen, 4) << t;
    EXPECT_LE(seen, 12) << t;
  }
}

TEST(GnssSky, ReadsInstantsAndRefusesWhatIsNone) {
  EXPECT_EQ(read_utc("2000-01-01T12:00:00", "epoch_utc"), 0.0);
  EXPECT_EQ(read_utc("1993-07-01T00:00:00", "epoch_utc"), -205'243'200.0);
  EXPECT_EQ(read_utc("2024-02-29T23:59:59", "epoch_utc"),
            (2460370.5 - 2451545.0) * kDay_s - 1.0);  // Julian date of 2024-03-01
  for (const char* text : {"2023-02-29T00:00:00", "2024-06-15", "2024-06-15T24:00:00", "today",
                           "2024-06-15 10:00:00", ""}) {
    try {
      read_utc(text, "epoch_utc");
      FAIL() << text;
    } catch (const ConfigError& error) {
      EXPECT_EQ(std::string(error.what()),
                "epoch_utc = '" + std::string(text) +
                    "', must be a date and time in UTC like 2024-06-15T10:00:00");
    }
  }
}

Vector3d towards(double azimuth_deg, double elevation_deg) {
  const double a = rad_from_deg(azimuth_deg), e = rad_from_deg(elevation_deg);
  return {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
}

TEST(GnssGeometry, OneAtTheZenithAndThreeOnTheHorizonHaveTheTextbooksDilutions) {
  GnssGeometry geometry;
  Dilution dilution;
  geometry.add(towards(0, 90), 1.0);
  geometry.add(towards(0, 0), 1.0);
  geometry.add(towards(120, 0), 1.0);
  EXPECT_FALSE(geometry.read(dilution)) << "three";
  geometry.add(towards(240, 0), 1.0);
  ASSERT_TRUE(geometry.read(dilution));
  EXPECT_EQ(geometry.count(), 4);
  // By hand: Q = diag(2/3, 2/3) beside ((4/3, 1/3), (1/3, 1/3)); the sum of all is 3.
  EXPECT_NEAR(dilution.horizontal(), std::sqrt(4.0 / 3.0), 1e-12);
  EXPECT_NEAR(dilution.vertical(), std::sqrt(4.0 / 3.0), 1e-12);
  EXPECT_NEAR(dilution.position(), std::sqrt(8.0 / 3.0), 1e-12);
  EXPECT_NEAR(dilution.clock, std::sqrt(1.0 / 3.0), 1e-12);
}

TEST(GnssGeometry, SixSatellitesAsInvertedElsewhere) {
  const double azimuths[] = {10, 75, 140, 215, 300, 340}, elevations[] = {60, 25, 40, 15, 35, 12};
  const double weights[] = {1.0, 0.5, 1.0, 0.2, 0.7, 0.1};
  GnssGeometry plain, weighted;
  for (int i = 0; i < 6; ++i) {
    plain.add(towards(azimuths[i], elevations[i]), 1.0);
    weighted.add(towards(azimuths[i], elevations[i]), weights[i]);
  }
  // Gauss-Jordan in another language.
  Dilution dilution;
  ASSERT_TRUE(plain.read(dilution));
  EXPECT_NEAR((dilution.axes - Vector3d(0.751869681, 0.677889604, 1.875264733)).norm(), 0.0, 1e-8);
  EXPECT_NEAR(dilution.clock, 1.017260174, 1e-8);
  ASSERT_TRUE(weighted.read(dilution));
  EXPECT_NEAR((dilution.axes - Vector3d(1.061592912, 1.152033319, 2.967628595)).norm(), 0.0, 1e-8);
  EXPECT_NEAR(dilution.clock, 1.902106629, 1e-8);
}

TEST(GnssGeometry, SatellitesOnOneConeTellNoPosition) {
  GnssGeometry geometry;
  for (const double azimuth : {0.0, 60.0, 150.0, 200.0, 310.0})
    geometry.add(towards(azimuth, 30), 1.0);
  Dilution dilution;
  EXPECT_FALSE(geometry.read(dilution)) << "height and clock cannot be told apart";
}

}  // namespace
}  // namespace vinerow::sensors::gnss_sky_test
