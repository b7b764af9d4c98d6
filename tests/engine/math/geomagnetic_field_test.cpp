#include "engine/math/geomagnetic_field.h"

#include <gtest/gtest.h>

#include "engine/math/angles.h"

namespace vinerow::geomagnetic_field_test {
namespace {

TEST(GeomagneticField, IsThatOfThePublishedTestValues) {
  struct Row {
    double year, altitude_km, latitude_deg, longitude_deg;
    double north_nT, east_nT, down_nT, declination_deg;
  };
  // WMM2025 technical report, table 6 (WMM2025_TEST_VALUES.txt).
  const Row rows[] = {{2025.0, 0, 80, 0, 6521.6, 145.9, 54791.5, 1.28},
                      {2025.0, 0, 0, 120, 39677.8, -109.6, -10580.2, -0.16},
                      {2025.0, 0, -80, -120, 6117.5, 15751.9, -52022.5, 68.78},
                      {2025.0, 100, 80, 0, 6216.0, 92.4, 52598.8, 0.85},
                      {2025.0, 100, 0, 120, 37688.6, -96.2, -10152.1, -0.15},
                      {2025.0, 100, -80, -120, 5907.6, 14780.3, -49540.7, 68.21},
                      {2027.5, 0, 80, 0, 6500.8, 294.5, 54869.4, 2.59},
                      {2027.5, 0, 0, 120, 39701.6, -167.4, -10381.8, -0.24},
                      {2027.5, 0, -80, -120, 6200.7, 15730.3, -51783.7, 68.49},
                      {2027.5, 100, 80, 0, 6196.7, 233.8, 52670.5, 2.16},
                      {2027.5, 100, 0, 120, 37711.5, -148.7, -9969.8, -0.23},
                      {2027.5, 100, -80, -120, 5984.0, 14760.1, -49317.7, 67.93}};
  for (const Row& row : rows) {
    const Eigen::Vector3d field_nT =
        1e9 * calc_geomagnetic_field_T(rad_from_deg(row.latitude_deg),
                                       rad_from_deg(row.longitude_deg), 1e3 * row.altitude_km,
                                       row.year);
    // Half of the table's last digit.
    EXPECT_NEAR(field_nT.x(), row.east_nT, 0.051);
    EXPECT_NEAR(field_nT.y(), row.north_nT, 0.051);
    EXPECT_NEAR(field_nT.z(), -row.down_nT, 0.051);
    EXPECT_NEAR(deg_from_rad(std::atan2(field_nT.x(), field_nT.y())), row.declination_deg, 0.0051);
  }
}

TEST(GeomagneticField, IsFiniteAndSteadyAtThePoles) {
  for (const double latitude_deg : {90.0, -90.0}) {
    const auto at = [&](double offset_deg) -> Eigen::Vector3d {
      return calc_geomagnetic_field_T(rad_from_deg(latitude_deg + offset_deg), 1.0, 0.0, 2025.0);
    };
    ASSERT_TRUE(at(0.0).allFinite());
    const double inwards_deg = latitude_deg > 0.0 ? -1e-3 : 1e-3;  // 111 m, 1 nT
    EXPECT_LT((at(0.0) - at(inwards_deg)).norm(), 5e-9);
  }
}

}  // namespace
}  // namespace vinerow::geomagnetic_field_test
