/// Clouds: irradiance by Kasten and Czeplak's formulae, sky by that of CIE.

#include "engine/imaging/daylight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::imaging::daylight_test {
namespace {

SceneLight light_under(double cloud_cover, double elevation_deg = 40.0) {
  Daylight daylight;
  daylight.sun_elevation_rad = rad_from_deg(elevation_deg);
  daylight.cloud_cover = cloud_cover;
  return make_light(daylight);
}

/// On level ground.
Eigen::Vector3d global(const SceneLight& light) {
  return light.sun_direction_W.z() * light.sun_irradiance + light.sky_irradiance;
}

TEST(Clouds, DimAsMeasured) {
  // G(N) / G(0) = 1 - 0.75 N^3.4: 0.99, 0.93, 0.72, 0.25 for 2, 4, 6, 8 eighths (Kasten and
  // Czeplak 1980, Hamburg, ten years).
  const SceneLight clear = light_under(0.0);
  const double published[] = {0.99, 0.93, 0.72, 0.25};
  for (int i = 0; i < 4; ++i) {
    const SceneLight light = light_under(0.25 * (i + 1));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(global(light)[c] / global(clear)[c], published[i], 0.005) << i;
    }
  }
}

TEST(Clouds, TurnSunlightIntoLightOfTheSky) {
  const SceneLight clear = light_under(0.0), overcast = light_under(1.0);
  EXPECT_EQ(overcast.sun_irradiance, Eigen::Vector3d::Zero());
  for (const double cover : {0.3, 0.6, 0.9}) {
    // The sky's share of the light grows with the square of the cover.
    const SceneLight light = light_under(cover);
    const double before = clear.sky_irradiance[1] / global(clear)[1];
    const double share = light.sky_irradiance[1] / global(light)[1];
    EXPECT_NEAR((share - before) / (1.0 - before), cover * cover, 1e-12);
  }
}

TEST(Clouds, GiveTheGroundTheirIrradiance) {
  // Over the hemisphere, radiance times sin(elevation) is what level ground receives.
  const SceneLight light = light_under(0.7);
  constexpr int kSteps = 2000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < kSteps; ++i) {
    const double sin_e = (i + 0.5) / kSteps;
    sum += 2.0 * kPi * sin_e / kSteps * cloud_radiance(light, sin_e);
  }
  EXPECT_LT((sum - light.cloud_irradiance).norm(), 1e-6);
  EXPECT_NEAR(cloud_radiance(light, 1.0)[0] / cloud_radiance(light, 0.0)[0], 3.0, 1e-12);
}

TEST(Clouds, WhitenTheSky) {
  const auto zenith = [](const SceneLight& light) {
    return light.atmosphere.sky[(Atmosphere::kElevations - 1) * Atmosphere::kAzimuths];
  };
  const Eigen::Vector3f clear = zenith(light_under(0.0)), overcast = zenith(light_under(1.0));
  EXPECT_GT(clear[2], 1.5f * clear[0]);
  EXPECT_LT(std::abs(overcast[2] / overcast[0] - 1.0f), 0.3f);
}

TEST(Clouds, OfNoneChangeNothing) {
  const SceneLight clear = light_under(0.0);
  const Atmosphere plain = calc_atmosphere(rad_from_deg(40.0));
  EXPECT_EQ(clear.atmosphere.sky, plain.sky);
  EXPECT_EQ(clear.sun_irradiance, plain.sun_irradiance.cast<double>());
}

}  // namespace
}  // namespace vinerow::imaging::daylight_test
