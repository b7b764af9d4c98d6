#include "engine/imaging/atmosphere.h"

#include <gtest/gtest.h>

#include "engine/math/angles.h"

namespace vinerow::imaging::atmosphere_test {
namespace {

TEST(Atmosphere, SunlightFollowsTheAirMass) {
  // Closed form for the sun in the zenith: exp(-(beta_air * H_air + 1.1 beta_haze * H_haze)) from
  // 200 m; the sum over 8 steps is good to a few percent.
  const Atmosphere noon = calc_atmosphere(0.5 * kPi);
  const double haze = 12e-6 * 1.1 * 1200.0 * std::exp(-200.0 / 1200.0);
  const double air[] = {5.8e-6, 13.5e-6, 33.1e-6};
  for (int c = 0; c < 3; ++c) {
    const double depth = air[c] * 8000.0 * std::exp(-200.0 / 8000.0) + haze;
    EXPECT_NEAR(noon.sun_irradiance[c], std::exp(-depth), 0.04) << c;
  }
}

TEST(Atmosphere, TheLowSunIsRedAndTheZenithBlue) {
  const Atmosphere evening = calc_atmosphere(rad_from_deg(6.0));
  EXPECT_GT(evening.sun_irradiance[0], 1.5f * evening.sun_irradiance[2]);
  const Atmosphere day = calc_atmosphere(rad_from_deg(45.0));
  const Eigen::Vector3f zenith = day.sky[(Atmosphere::kElevations - 1) * Atmosphere::kAzimuths];
  EXPECT_GT(zenith[2], 1.5f * zenith[0]);
}

TEST(Atmosphere, LightIsFiniteAndSkyIsDimmerThanSun) {
  for (const double elevation_deg : {-20.0, 2.0, 10.0, 30.0, 60.0, 90.0}) {
    const Atmosphere atmosphere = calc_atmosphere(rad_from_deg(elevation_deg));
    for (const Eigen::Vector3f& radiance : atmosphere.sky) {
      ASSERT_TRUE(radiance.allFinite());
      ASSERT_GE(radiance.minCoeff(), 0.0f);
    }
    EXPECT_GT(atmosphere.sky_irradiance.minCoeff(), 0.0f);
    EXPECT_LT(atmosphere.sky_irradiance.maxCoeff(), 1.0f);
  }
}

}  // namespace
}  // namespace vinerow::imaging::atmosphere_test
