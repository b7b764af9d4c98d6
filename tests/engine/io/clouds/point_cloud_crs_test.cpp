#include "engine/io/clouds/point_cloud_crs.h"

#include "engine/core/random.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "tests/engine/io/clouds/point_cloud_files.h"
#include "tests/engine/io/geo/utm32.h"

namespace vinerow::io::point_cloud_crs_test {
namespace {

const GeoOrigin kOrigin{rad_from_deg(45.0), rad_from_deg(9.5), 100.0};

TEST(CloudFrame, UtmComesToTheLocalFrame) {
  const CloudFrame utm("EPSG:25832", kOrigin);
  const CloudFrame degrees("EPSG:4326", kOrigin);
  const LocalFrame local(kOrigin);
  RandomStream random(1, "", "utm");
  for (int k = 0; k < 100; ++k) {
    const Geodetic place{kOrigin.latitude_rad + random.uniform(-1e-4, 1e-4),
                         kOrigin.longitude_rad + random.uniform(-1e-4, 1e-4),
                         random.uniform(80, 160)};
    const Eigen::Vector2d en = utm32(place.latitude_rad, place.longitude_rad);
    const Eigen::Vector3d expected = local.to_local(place);
    const Eigen::Vector3d p_W = utm.to_local({en.x(), en.y(), place.altitude_m});
    EXPECT_LT((p_W - expected).norm(), 1e-3);  // of the series; the two ellipsoids differ by 0.1 mm
    const Eigen::Vector3d q_W = degrees.to_local(
        {deg_from_rad(place.longitude_rad), deg_from_rad(place.latitude_rad), place.altitude_m});
    EXPECT_LT((q_W - expected).norm(), 1e-6);
  }
}

TEST(CloudFrame, BlocksOfPointsMoveInPlace) {
  const CloudFrame utm("EPSG:25832", kOrigin);
  const Eigen::Vector2d en = utm32(kOrigin.latitude_rad, kOrigin.longitude_rad);
  std::vector<CloudPoint> points(3);
  for (CloudPoint& point : points) point.position = {en.x(), en.y(), 101.0};
  points[1].classification = 2;
  utm.to_local(points);
  for (const CloudPoint& point : points) {
    EXPECT_LT((point.position - Eigen::Vector3d(0, 0, 1)).norm(), 1e-3);
  }
  EXPECT_EQ(points[1].classification, 2);
}

TEST(CloudFrame, HeightsHaveTheUnitOfTheirSystem) {
  const double kUsFoot_m = 1200.0 / 3937.0;  // of the U.S. survey foot, by definition
  const GeoOrigin new_york{rad_from_deg(40.75), rad_from_deg(-74.0), 0.0};
  const auto rise_m = [&](const std::string& crs, double x, double y) {
    const CloudFrame frame(crs, new_york);
    return (frame.to_local({x, y, 100.0}) - frame.to_local({x, y, 0.0})).norm();
  };
  EXPECT_NEAR(rise_m("EPSG:2263", 984000, 212000), 100 * kUsFoot_m, 1e-6);         // feet all over
  EXPECT_NEAR(rise_m("EPSG:26918", 584000, 4511000), 100.0, 1e-6);                 // metres
  EXPECT_NEAR(rise_m("EPSG:26918+6360", 584000, 4511000), 100 * kUsFoot_m, 1e-6);  // z in feet
  EXPECT_NEAR(rise_m("EPSG:4326", -74.0, 40.75), 100.0, 1e-6);
}

class CloudCrs : public PointCloudFiles {};

TEST_F(CloudCrs, FaultsAreNamed) {
  EXPECT_EQ(error_in([] { CloudFrame("EPSG:nonsense", kOrigin); }),
            "crs = 'EPSG:nonsense' is not a coordinate reference system, must be like EPSG:32632");
  EXPECT_EQ(error_in([] { CloudFrame("", kOrigin); }),
            "crs = '' is not a coordinate reference system, must be like EPSG:32632");
  // GDAL would read a definition from a file or from the network.
  const std::string file =
      write("degrees.prj",
            "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563]],"
            "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]]");
  for (const std::string& name :
       {file, "/vsisubfile/0_999," + file, std::string("HTTPS://localhost/opengis.net/def/crs/"),
        std::string("http://www.opengis.net.localhost/def/crs/EPSG/0/25832")}) {
    EXPECT_NE(error_in([&] { CloudFrame(name, kOrigin); }).find("is not a coordinate reference"),
              std::string::npos)
        << name;
  }
  // Names of OGC in the form of an address are looked up nowhere.
  const CloudFrame utm("http://www.opengis.net/def/crs/EPSG/0/25832", kOrigin);
  const std::string error = error_in([&] { utm.to_local({1e12, 1e12, 0}); });
  EXPECT_NE(error.find("is outside the area of the crs 'ETRS89 / UTM zone 32N'"), std::string::npos)
      << error;
  // Metres, said to be degrees.
  const CloudFrame degrees("EPSG:4326", kOrigin);
  EXPECT_EQ(error_in([&] {
              degrees.to_local({500000, 4649000, 100});
            }),
            "point (500000, 4649000, 100) is outside the area of the crs 'WGS 84'");
}

TEST_F(CloudCrs, DegreesWithoutACrsAreRefused) {
  // 200 m x 150 m of a vineyard whose canopy is 2 m above the ground.
  const Eigen::AlignedBox3d degrees(Eigen::Vector3d(9.5, 45.0, 120.1),
                                    Eigen::Vector3d(9.5025, 45.0013, 122.3));
  EXPECT_TRUE(looks_like_degrees(degrees));
  EXPECT_EQ(error_in([&] { check_cloud_unit(folder_ / "a.xyz", "", degrees); }),
            "point cloud 'a.xyz' seems to be in degrees (x 9.5 to 9.5025, y 45 to "
            "45.0013, z 120.1 to 122.3), but has no coordinate reference system; give it by --crs "
            "EPSG:<code> (EPSG:4326 for WGS84)");
  EXPECT_EQ(error_in([&] { check_cloud_unit("a.xyz", "EPSG:25832", degrees); }),
            "point cloud 'a.xyz' seems to be in degrees (x 9.5 to 9.5025, y 45 to "
            "45.0013, z 120.1 to 122.3), but its coordinate reference system 'ETRS89 / UTM zone "
            "32N' is projected");
  check_cloud_unit("a.xyz", "EPSG:4326", degrees);

  // A scan around its own origin, a single trunk, a national grid: metres.
  const auto box = [](const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
    return Eigen::AlignedBox3d(lower, upper);
  };
  EXPECT_FALSE(looks_like_degrees(box({-60, -40, -1}, {60, 40, 5})));
  EXPECT_FALSE(looks_like_degrees(box({3.0, 4.0, 0}, {3.15, 4.12, 2})));
  EXPECT_FALSE(looks_like_degrees(box({500000, 4649000, 100}, {500200, 4649150, 105})));
  EXPECT_FALSE(looks_like_degrees(box({1, 2, 3}, {1, 2, 3})));
}

}  // namespace
}  // namespace vinerow::io::point_cloud_crs_test
