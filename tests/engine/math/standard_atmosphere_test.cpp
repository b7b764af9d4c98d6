#include "engine/math/standard_atmosphere.h"

#include <gtest/gtest.h>

namespace vinerow::standard_atmosphere_test {
namespace {

TEST(StandardAtmosphere, IsTheTableOfTheStandard) {
  struct Row {
    double altitude_m, temperature_K, pressure_Pa, density_kgm3;
  };
  // US Standard Atmosphere 1976 (NASA TM-X-74335), table I, by geometric altitude; five digits.
  const Row rows[] = {{-1'000, 294.651, 1.1393e5, 1.3470},   {0, 288.150, 1.01325e5, 1.2250},
                      {1'000, 281.651, 8.9876e4, 1.1117},    {5'000, 255.676, 5.4048e4, 0.73643},
                      {10'000, 223.252, 2.6500e4, 0.41351},  {20'000, 216.650, 5.5293e3, 0.088910},
                      {30'000, 226.509, 1.1970e3, 0.018410}, {50'000, 270.650, 79.779, 1.0269e-3},
                      {70'000, 219.585, 5.2209, 8.2829e-5}};
  for (const Row& row : rows) {
    const AirState air = calc_standard_air(row.altitude_m);
    EXPECT_NEAR(air.temperature_K, row.temperature_K, 2e-3) << row.altitude_m;
    EXPECT_NEAR(air.pressure_Pa / row.pressure_Pa, 1.0, 6e-5) << row.altitude_m;
    EXPECT_NEAR(air.density_kgm3 / row.density_kgm3, 1.0, 6e-5) << row.altitude_m;
    EXPECT_EQ(calc_standard_density_kgm3(row.altitude_m), air.density_kgm3);
  }
}

TEST(StandardAtmosphere, EndsAtItsLimits) {
  EXPECT_EQ(calc_standard_air(-9'000).pressure_Pa, calc_standard_air(-5'000).pressure_Pa);
  EXPECT_EQ(calc_standard_air(200'000).density_kgm3, calc_standard_air(86'000).density_kgm3);
}

}  // namespace
}  // namespace vinerow::standard_atmosphere_test
