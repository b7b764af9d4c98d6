/// Shelter between the rows against Cionco's profile.

#include "vehicles/parts/wind_shelter.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/vehicles/wind/wind_rig.h"

namespace vinerow::vehicles::wind_shelter_test {
namespace {

using namespace test;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Duration kStep{1'000'000};
constexpr double kTop_m = 2.0, kAttenuation = 1.2;

Wind sheltered(double from_deg, WindHeightLaw law = WindHeightLaw::kLogarithmic) {
  Wind wind = west_wind(5.0);
  wind.from_azimuth_rad = from_deg / 180.0 * std::numbers::pi;
  wind.height_law = law;
  wind.shelter_attenuation = kAttenuation;
  return wind;
}

Vector3d wind_at(const Wind& wind, const Vector3d& p_W) {
  return WindRig(wind, 1, five_rows()).sample(kStep, p_W);
}

TEST(WindShelter, FallsOffExponentiallyFromTheCanopysTop) {
  // Wind from the south crosses the rows, which lie along x; in the middle of the block.
  const Wind across = sheltered(180.0), along = sheltered(270.0);
  const double top_mps = 5.0 * std::log(kTop_m / 0.1) / std::log(100.0);
  for (const double z : {0.0, 0.2, 0.5, 1.0, 1.5, 1.9, 2.0}) {
    const double depth = 1.0 - z / kTop_m;
    const Vector3d crossing = wind_at(across, {0, 5.9, z}), channelled = wind_at(along, {0, 6, z});
    EXPECT_NEAR(crossing.y(), top_mps * std::exp(-kAttenuation * depth), 1e-6) << z;
    EXPECT_NEAR(crossing.x(), 0.0, 1e-6);
    // Half the attenuation along the rows.
    EXPECT_NEAR(channelled.x(), top_mps * std::exp(-0.5 * kAttenuation * depth), 1e-6) << z;
  }
  // Above the canopy the height law is as it was.
  EXPECT_NEAR(wind_at(across, {0, 6, 4.0}).y(), 5.0 * std::log(40.0) / std::log(100.0), 1e-9);
}

TEST(WindShelter, TurnsSlantingWindIntoTheRows) {
  // From the south-west at 45 deg to the rows: tan of the angle left is exp(-a / 2 depth).
  const Vector3d felt = wind_at(sheltered(225.0, WindHeightLaw::kUniform), {0, 4, 0.5});
  EXPECT_NEAR(felt.y() / felt.x(), std::exp(-0.5 * kAttenuation * 0.75), 1e-6);
}

TEST(WindShelter, IsThereBetweenTheRowsAndNowhereElse) {
  const Wind wind = sheltered(180.0, WindHeightLaw::kUniform);
  const double inside_mps = 5.0 * std::exp(-kAttenuation * 0.75);
  for (const double y : {0.0, 0.3, 1.25, 2.5, 7.0, 9.9}) {
    for (const double x : {-29.0, 0.0, 29.0}) {
      EXPECT_NEAR(wind_at(wind, {x, y, 0.5}).y(), inside_mps, 1e-6) << x << ' ' << y;
    }
  }
  // The block ends half a canopy's width beyond its outer rows; 2 m further it is over.
  for (const Vector2d& p : {Vector2d(0, -2.9), Vector2d(0, 12.9), Vector2d(32.6, 5),
                            Vector2d(-40, 5), Vector2d(400, 5)}) {
    EXPECT_NEAR(wind_at(wind, {p.x(), p.y(), 0.5}).y(), 5.0, 1e-9) << p.transpose();
  }
}

TEST(WindShelter, FadesSmoothlyAtTheEdges) {
  const Wind wind = sheltered(180.0, WindHeightLaw::kUniform);
  WindRig rig(wind, 1, five_rows());
  const double drop_mps = 5.0 - 5.0 * std::exp(-kAttenuation * 0.75);
  // A smooth step over 2 m is 1.5 / 2 m steep at most; the logarithm's slope adds exp(0.9 / 2).
  const double limit_mps = 0.02 * 2.0 * drop_mps;
  double last = 0.0, lowest = 5.0;
  for (int i = 0; i < 1000; ++i) {
    const double y = -5.0 + 0.02 * i;
    const double v = rig.sample(kStep, {0, y, 0.5}).y();
    EXPECT_TRUE(i == 0 || std::abs(v - last) <= limit_mps) << y;
    lowest = std::min(lowest, v);
    last = v;
  }
  EXPECT_NEAR(lowest, 5.0 - drop_mps, 1e-6);
  // Past a row's end, too.
  last = rig.sample(kStep, {25, 5, 0.5}).y();
  for (int i = 0; i < 500; ++i) {
    const double v = rig.sample(kStep, {25 + 0.02 * i, 5, 0.5}).y();
    EXPECT_LE(std::abs(v - last), limit_mps) << i;
    last = v;
  }
}

TEST(WindShelter, DoesNotDependOnHowTheBlockLies) {
  // The block turned by 37 deg, given from the other end, and the wind with it.
  const double turn = 37.0 / 180.0 * std::numbers::pi;
  const Eigen::Rotation2Dd R(turn);
  RowMap turned = five_rows();
  const auto turn_line = [&](std::vector<Vector3d>& line) {
    for (Vector3d& p : line) p.head<2>() = R * Vector2d(p.head<2>());
    std::swap(line.front(), line.back());
  };
  for (PlantRow& row : turned.rows) turn_line(row.line_W);
  for (Alley& alley : turned.alleys) turn_line(alley.line_W);
  Wind wind = sheltered(225.0);
  const Vector3d straight = wind_at(wind, {3, 4, 0.8});
  wind.from_azimuth_rad -= turn;  // azimuths run clockwise
  const Vector2d place = R * Vector2d(3, 4);
  const Vector3d felt = WindRig(wind, 1, turned).sample(kStep, {place.x(), place.y(), 0.8});
  EXPECT_NEAR((R.inverse() * Vector2d(felt.head<2>()) - straight.head<2>()).norm(), 0.0, 1e-6);
}

TEST(WindShelter, ShelteredIsWhatTurbulenceAndGustsAreToo) {
  // The same vehicle in the same wind, with and without vines; from the west, along the rows.
  Wind wind = sheltered(270.0, WindHeightLaw::kUniform);
  wind.turbulence = 1.0;
  wind.gusts.push_back({.start_s = 0.0,
                        .duration_s = 1.0,
                        .amplitude_mps = 2.0,
                        .from_azimuth_rad = wind.from_azimuth_rad,
                        .vertical_mps = 1.0});
  WindRig among(wind, 4, five_rows());
  const double along = std::exp(-0.5 * kAttenuation * 0.5), across = std::exp(-kAttenuation * 0.5);
  // Its eddies pass more slowly between the vines: let the other one drift to meet them alike.
  WindRig open(wind, 4);
  const Vector3d drift(5.0 * (1.0 - along), 0, 0);
  for (int i = 0; i < 900; ++i) {
    const Time now{i * std::int64_t{1'000'000}};
    among.probe->sample(now, {0, 5, 1}, Vector3d::Zero(), kStep);
    open.probe->sample(now, {0, 5, 1}, drift, kStep);
    const Vector3d factors(along, across, across);
    ASSERT_NEAR(
        (among.probe->turbulence_W() - factors.cwiseProduct(open.probe->turbulence_W())).norm(),
        0.0, 1e-6)
        << i;
    ASSERT_NEAR((among.probe->gust_W() - factors.cwiseProduct(open.probe->gust_W())).norm(), 0.0,
                1e-6);
  }
}

TEST(WindShelter, HugeBlocksGetACoarserGridAndTheSameShelter) {
  RowMap map;
  for (int i = 0; i < 400; ++i) {
    map.rows.push_back({i, {{0, 2.5 * i, 0}, {1000, 2.5 * i, 0}}, 0.6, 0.5, 2.0});
    if (i > 0) map.alleys.push_back({i, {{0, 2.5 * i - 1.25, 0}, {1000, 2.5 * i - 1.25, 0}}, 2.5});
  }
  const WindShelter shelter(map, kAttenuation);
  const ShelterSpot spot = shelter.spot({431.0, 512.0});
  EXPECT_NEAR(spot.inside, 1.0, 1e-6);
  EXPECT_NEAR(spot.top_m, 2.0, 1e-6);
  EXPECT_NEAR(shelter.factors(spot, 1.0).across, std::exp(-0.6), 1e-6);
}

TEST(WindShelter, NoneWithoutRowsOrAttenuation) {
  EXPECT_TRUE(WindShelter({}, 1.0).none());
  EXPECT_TRUE(WindShelter(five_rows(), 0.0).none());
  EXPECT_EQ(WindShelter({}, 1.0).spot({0, 0}).inside, 0.0);
}

}  // namespace
}  // namespace vinerow::vehicles::wind_shelter_test
