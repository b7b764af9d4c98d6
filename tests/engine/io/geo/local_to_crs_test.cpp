#include "engine/io/geo/local_to_crs.h"

#include <gtest/gtest.h>

#include "engine/core/error.h"
#include "engine/io/clouds/point_cloud_crs.h"
#include "engine/math/angles.h"

namespace vinerow::io::local_to_crs_test {
namespace {

using Eigen::Vector3d;

const GeoOrigin kBarolo{rad_from_deg(44.6150), rad_from_deg(7.9244), 300.0};

void expect_inverse(const char* crs, double tolerance_m) {
  const LocalToCrs out(crs, kBarolo);
  const CloudFrame back(crs, kBarolo);
  for (const Vector3d& p : {Vector3d(0, 0, 0), Vector3d(140, -60, 31), Vector3d(-900, 1500, -8)}) {
    EXPECT_LT((back.to_local(out.from_local(p)) - p).norm(), tolerance_m) << crs;
  }
}

TEST(LocalToCrs, IsTheInverseOfCloudFrame) {
  // PROJ inverts its series to a few micrometres.
  for (const char* crs : {"EPSG:4326", "EPSG:32632", "EPSG:3857"}) expect_inverse(crs, 1e-5);
  // To other datums it turns by small angles, and back by their transpose: 3 arc seconds squared
  // of the Earth's radius are 1.3 mm.
  for (const char* crs : {"EPSG:3003", "EPSG:2056"}) expect_inverse(crs, 2e-3);
}

TEST(LocalToCrs, TheOriginIsWherePlanesOfTheEarthHaveIt) {
  const Vector3d degrees = LocalToCrs("EPSG:4326", kBarolo).from_local({0, 0, 0});
  EXPECT_NEAR(degrees.x(), 7.9244, 1e-12);
  EXPECT_NEAR(degrees.y(), 44.6150, 1e-12);
  EXPECT_NEAR(degrees.z(), 300.0, 1e-8);
}

TEST(LocalToCrs, NearbyIsRightToATenthOfAMillimetre) {
  for (const char* crs : {"EPSG:32632", "EPSG:4326"}) {
    const LocalToCrs exact(crs, kBarolo);
    const CloudFrame back(crs, kBarolo);
    const Vector3d centre(200.0, -300.0, 20.0);
    const LocalToCrs::Nearby nearby = exact.near(centre);
    for (const Vector3d& step : {Vector3d(20, 0, 0), Vector3d(0, -20, 0), Vector3d(12, 12, 10)}) {
      EXPECT_LT((back.to_local(nearby(centre + step)) - (centre + step)).norm(), 1e-4) << crs;
    }
  }
}

TEST(LocalToCrs, RefusesAnUnknownSystem) {
  try {
    LocalToCrs("EPSG:99999999", kBarolo);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "crs = 'EPSG:99999999' is not a coordinate reference system, must be like "
                 "EPSG:32632");
  }
}

}  // namespace
}  // namespace vinerow::io::local_to_crs_test
