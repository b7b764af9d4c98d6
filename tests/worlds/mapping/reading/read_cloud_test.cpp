#include "worlds/mapping/reading/read_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/io/clouds/point_cloud_writer.h"
#include "engine/math/geo.h"
#include "tests/engine/io/geo/utm32.h"
#include "tests/support/data.h"
#include "tests/support/folder_test.h"

namespace vinerow::mapping::read_cloud_test {
namespace {

/// 60 m by 40 m of ground around (45, 9.5), 120 to 123 m high, as latitude, longitude and height.
std::vector<Geodetic> geodetic_parcel(std::size_t count) {
  const LocalFrame local({rad_from_deg(45.0), rad_from_deg(9.5), 121.5});
  RandomStream random(7, "", "parcel");
  std::vector<Geodetic> places;
  for (std::size_t k = 0; k < count; ++k) {
    places.push_back(local.to_geodetic(
        {random.uniform(-30, 30), random.uniform(-20, 20), random.uniform(-1.5, 1.5)}));
  }
  return places;
}

class ReadCloud : public test::FolderTest {
 protected:
  ReadCloud() : FolderTest("read_cloud") {}

  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  std::filesystem::path write_points(const std::string& name,
                                     const std::vector<Eigen::Vector3d>& points,
                                     const io::PointCloudWriterOptions& options = {}) const {
    const auto writer = io::create_point_cloud(folder_ / name, options);
    std::vector<io::CloudPoint> block(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      block[k].position = points[k];
      block[k].rgb = {{static_cast<std::uint8_t>(k), 7, 9}};
    }
    writer->write(block);
    writer->finish();
    return folder_ / name;
  }
  /// `count` points of a parcel in its own frame, of 60 m by 40 m.
  static std::vector<Eigen::Vector3d> parcel(std::size_t count,
                                             const Eigen::Vector3d& corner = {0, 0, 0}) {
    RandomStream random(3, "", "parcel");
    std::vector<Eigen::Vector3d> points;
    for (std::size_t k = 0; k < count; ++k) {
      points.push_back(corner + Eigen::Vector3d(random.uniform(0, 60), random.uniform(0, 40),
                                                random.uniform(0, 3)));
    }
    return points;
  }
  std::string error_of(const std::filesystem::path& file, const CloudReadOptions& options = {}) {
    try {
      read_parcel_cloud(file, options, report_);
    } catch (const ConfigError& error) {
      return without_folder(error.what());
    }
    return "no error";
  }

  CloudReadReport report_;
};

TEST_F(ReadCloud, GeoreferencedPointsComeToAnOriginInTheirMiddle) {
  const std::vector<Geodetic> places = geodetic_parcel(500);
  std::vector<Eigen::Vector3d> utm;
  for (const Geodetic& place : places) {
    const Eigen::Vector2d en = io::utm32(place.latitude_rad, place.longitude_rad);
    utm.emplace_back(en.x(), en.y(), place.altitude_m);
  }
  io::PointCloudWriterOptions options;
  options.crs = "EPSG:25832";
  options.las_offset = {539000, 4983000, 100};
  options.las_scale = {1e-4, 1e-4, 1e-4};
  const ParcelCloud cloud = read_parcel_cloud(write_points("a.las", utm, options), {}, report_);

  EXPECT_EQ(report_.format, "LAS 1.2");
  EXPECT_EQ(report_.crs, "EPSG:25832");
  EXPECT_EQ(report_.file_bytes, std::filesystem::file_size(folder_ / "a.las"));
  ASSERT_TRUE(report_.has_origin);
  // The middle of a parcel around (45, 9.5) whose corners random points reach to a few metres.
  EXPECT_NEAR(deg_from_rad(report_.origin.latitude_rad), 45.0, 2e-5);
  EXPECT_NEAR(deg_from_rad(report_.origin.longitude_rad), 9.5, 2e-5);
  EXPECT_NEAR(report_.origin.altitude_m, 121.5, 0.6);
  for (const double angle : {report_.origin.latitude_rad, report_.origin.longitude_rad}) {
    const double steps = deg_from_rad(angle) * 1e5;
    EXPECT_NEAR(steps, std::round(steps), 1e-4);
  }
  EXPECT_EQ(cloud.origin_W, Eigen::Vector3d(cloud.origin_W.array().round()));
  EXPECT_LT(cloud.origin_W.norm(), 3.0);

  const LocalFrame local(report_.origin);
  ASSERT_EQ(cloud.points.size(), places.size());
  EXPECT_EQ(report_.points, places.size());
  EXPECT_TRUE(cloud.colours.empty());
  for (std::size_t k = 0; k < places.size(); ++k) {
    EXPECT_LT((cloud.point_W(k) - local.to_local(places[k])).norm(), 1e-3);  // of the series
    EXPECT_TRUE(report_.bounds_W.contains(cloud.point_W(k)));
  }
  EXPECT_TRUE(report_.sentences.empty());
}

TEST_F(ReadCloud, TheOriginGivenIsTheOrigin) {
  std::string text;
  for (const Geodetic& place : geodetic_parcel(50)) {
    std::ostringstream line;
    line.precision(12);
    line << deg_from_rad(place.longitude_rad) << " " << deg_from_rad(place.latitude_rad) << " "
         << place.altitude_m << "\n";
    text += line.str();
  }
  CloudReadOptions options;
  options.crs = "EPSG:4326";
  options.origin = GeoOrigin{rad_from_deg(45.001), rad_from_deg(9.501), 100.0};
  const ParcelCloud cloud = read_parcel_cloud(write("a.xyz", text), options, report_);
  EXPECT_EQ(report_.origin.latitude_rad, options.origin->latitude_rad);
  EXPECT_EQ(report_.origin.altitude_m, 100.0);
  const LocalFrame local(*options.origin);
  const std::vector<Geodetic> places = geodetic_parcel(50);
  for (std::size_t k = 0; k < places.size(); ++k) {
    EXPECT_LT((cloud.point_W(k) - local.to_local(places[k])).norm(), 1e-4);
  }
  options.origin = GeoOrigin{rad_from_deg(46.0), rad_from_deg(9.5), 0.0};
  EXPECT_EQ(error_of(folder_ / "a.xyz", options),
            "point cloud 'a.xyz' is 111 km from the given origin (latitude 46.00000 deg, longitude "
            "9.50000 deg), must be within 20 km; give an origin near the cloud, or none");
}

/// Vines of the Riseholme vineyard, surveyed in both systems: Ordnance Survey's easting and
/// northing, latitude and longitude. The datum shift that PROJ has without its grids leaves metres
/// of offset, so only the shape is compared; a wrong grid convergence (1.18 degrees) would leave
/// 0.3 m, a wrong scale (0.99975) 4 mm.
TEST_F(ReadCloud, TwoSurveysOfOneVineyardAgree) {
  VINEROW_OUTSIDE_DATA(data, "vineyard_detection/data");
  const auto clouds = [&](const std::string& name, bool swap, const std::string& crs) {
    std::ifstream stream(data / name);
    std::string line, text, id, a, b;
    std::getline(stream, line);
    while (std::getline(stream, line)) {
      std::istringstream fields(line);
      std::getline(fields, id, ','), std::getline(fields, a, ','), std::getline(fields, b, ',');
      text += (swap ? b + " " + a : a + " " + b) + " 30\n";
    }
    CloudReadOptions options;
    options.crs = crs;
    options.origin =
        GeoOrigin{rad_from_deg(53.26810042662116), rad_from_deg(-0.5244249078498293), 0};
    return read_parcel_cloud(write(crs.substr(5) + ".xyz", text), options, report_);
  };
  const ParcelCloud grid =
      clouds("riseholme_vineyard_easting_northing_vines.csv", false, "EPSG:27700");
  const ParcelCloud degrees = clouds("riseholme_vineyard_lat_long_vines.csv", true, "EPSG:4326");
  ASSERT_EQ(grid.points.size(), 120u);
  ASSERT_EQ(degrees.points.size(), 120u);
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < 120; ++k) {
    shift += (degrees.point_W(k) - grid.point_W(k)).head<2>() / 120.0;
  }
  double squares = 0.0;
  for (std::size_t k = 0; k < 120; ++k) {
    squares += ((degrees.point_W(k) - grid.point_W(k)).head<2>() - shift).squaredNorm() / 120.0;
  }
  EXPECT_LT(shift.norm(), 10.0);
  EXPECT_LT(std::sqrt(squares), 2e-3);  // 1e-8 degrees are 1.1 mm
}

TEST_F(ReadCloud, WithoutASystemTheNumbersAreTheWorlds) {
  // Far from zero, where single precision alone would be 0.5 m off.
  const std::vector<Eigen::Vector3d> points = parcel(300, {500000, 4649000, 120});
  io::PointCloudWriterOptions options;
  options.has_colour = true;
  const ParcelCloud cloud = read_parcel_cloud(write_points("a.ply", points, options), {}, report_);
  EXPECT_FALSE(report_.has_origin);
  ASSERT_EQ(cloud.points.size(), points.size());
  ASSERT_EQ(cloud.colours.size(), points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_LT((cloud.point_W(k) - points[k]).norm(), 1e-5);
    EXPECT_EQ(cloud.colours[k], (std::array<std::uint8_t, 3>{static_cast<std::uint8_t>(k), 7, 9}));
  }
  ASSERT_EQ(report_.sentences.size(), 1u);
  EXPECT_EQ(report_.sentences[0],
            "The cloud names no coordinate reference system and lies at x = 500030 m, y = 4649020 "
            "m of its frame; give the system by --crs EPSG:<code> to have a map near its origin "
            "and on Earth.");
  CloudReadOptions plain;
  plain.with_colours = false;
  EXPECT_TRUE(read_parcel_cloud(folder_ / "a.ply", plain, report_).colours.empty());
}

TEST_F(ReadCloud, TheSystemOfAFileCanBeReplaced) {
  const std::vector<Eigen::Vector3d> points = parcel(300, {540000, 4983000, 120});
  io::PointCloudWriterOptions written;
  written.crs = "EPSG:25832";
  written.las_offset = {540000, 4983000, 100};
  const std::filesystem::path file = write_points("a.las", points, written);
  CloudReadOptions options;
  options.crs = "none";
  const ParcelCloud cloud = read_parcel_cloud(file, options, report_);
  EXPECT_EQ(report_.crs, "");
  EXPECT_LT((cloud.point_W(5) - points[5]).norm(), 1e-3);  // of LAS's scale
  options.crs = "EPSG:25833";
  read_parcel_cloud(file, options, report_);
  EXPECT_NEAR(deg_from_rad(report_.origin.longitude_rad), 15.5, 0.02);  // six degrees east of 9.5
  ASSERT_EQ(report_.sentences.size(), 1u);
  // On the parallel of 45 degrees, of radius N cos 45 deg = 4517.6 km, six degrees are 472.2 km to
  // the west and, as the parallel curves away from the tangent plane's east, 17.5 km to the north.
  EXPECT_EQ(report_.sentences[0],
            "The coordinates were taken as EPSG:25833, as requested; the file names EPSG:25832, "
            "which puts them 473 km away.");
  EXPECT_EQ(report_.crs_warning, report_.sentences[0]);
  // The same system by another name is no conflict.
  options.crs = "EPSG:3044";  // ETRS89 / UTM 32 with northing first, read as easting and northing
  read_parcel_cloud(file, options, report_);
  EXPECT_EQ(report_.crs_warning, "");
  EXPECT_TRUE(report_.sentences.empty());
}

TEST_F(ReadCloud, StrayPointsAreLeftOut) {
  const std::vector<Eigen::Vector3d> good = parcel(5000, {540000, 4983000, 120});
  std::vector<Eigen::Vector3d> points = good;
  points.insert(points.begin() + 17, {1e7, 4983000, 120});  // one that would be a million parcels
  points.emplace_back(540010, 4983010, -9000);
  CloudReadOptions options;
  options.crs = "EPSG:25832";
  const ParcelCloud cloud = read_parcel_cloud(write_points("a.ply", points), options, report_);
  EXPECT_EQ(report_.far_away, 2u);
  EXPECT_EQ(report_.given, 5002u);
  ASSERT_EQ(cloud.points.size(), 5000u);
  EXPECT_LT(report_.bounds_W.sizes().x(), 61.0);
  EXPECT_LT(report_.bounds_W.sizes().z(), 4.0);
  EXPECT_LT(cloud.origin_W.norm(), 3.0);
  ASSERT_EQ(report_.sentences.size(), 1u);
  EXPECT_EQ(report_.sentences[0], "2 points were left out: they are far from the other 5000.");

  // Scanners write zeros where nothing came back: here 3 % of all.
  points = good;
  for (std::size_t k = 0; k < points.size(); k += 33) points[k].setZero();
  read_parcel_cloud(write_points("b.ply", points), options, report_);
  EXPECT_EQ(report_.far_away, 152u);
  EXPECT_LT(report_.bounds_W.sizes().x(), 61.0);
}

/// A hedge at the edge, or a lone pole, is no stray point.
TEST_F(ReadCloud, PointsNearTheParcelAreKept) {
  std::vector<Eigen::Vector3d> points = parcel(5000);
  points.emplace_back(-45, 80, 25);
  read_parcel_cloud(write_points("a.ply", points), {}, report_);
  EXPECT_EQ(report_.far_away, 0u);
  EXPECT_EQ(report_.points, 5001u);
}

TEST_F(ReadCloud, WrongBoundsInAHeaderChangeNothing) {
  const std::filesystem::path file = write_points("a.las", parcel(100));
  const ParcelCloud right = read_parcel_cloud(file, {}, report_);
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  const double wrong = 1e12;
  stream.seekp(179);  // the greatest x
  stream.write(reinterpret_cast<const char*>(&wrong), sizeof wrong);
  stream.close();
  const ParcelCloud cloud = read_parcel_cloud(file, {}, report_);
  EXPECT_EQ(cloud.origin_W, right.origin_W);
  EXPECT_EQ(cloud.points, right.points);
}

TEST_F(ReadCloud, CountsWhatItLeavesOut) {
  const std::filesystem::path file = write_points("a.las", parcel(100));
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(227 + 20 * 3 + 15);  // header, three points, the byte with the withheld bit
  stream.put('\x80');
  stream.close();
  read_parcel_cloud(file, {}, report_);
  EXPECT_EQ(report_.withheld, 1u);
  EXPECT_EQ(report_.points, 99u);
  EXPECT_EQ(report_.sentences,
            std::vector<std::string>{"1 points were left out: they are marked as withheld."});

  read_parcel_cloud(write("a.xyz", "0 0 0\nnan 1 1\n30 40 1\n5 inf 6\n20 5 2\n1 2 -inf\n"), {},
                    report_);
  EXPECT_EQ(report_.not_finite, 3u);
  EXPECT_EQ(report_.points, 3u);
  EXPECT_EQ(report_.sentences,
            std::vector<std::string>{"3 points were left out: their coordinates are not finite."});
}

TEST_F(ReadCloud, ThinningKeepsEveryNth) {
  const std::vector<Eigen::Vector3d> points = parcel(1000);
  CloudReadOptions options;
  options.thin = 7;
  const ParcelCloud cloud = read_parcel_cloud(write_points("a.ply", points), options, report_);
  ASSERT_EQ(cloud.points.size(), 143u);  // 0, 7, ..., 994
  for (std::size_t k = 0; k < cloud.points.size(); ++k) {
    EXPECT_LT((cloud.point_W(k) - points[7 * k]).norm(), 1e-5);
  }
  EXPECT_EQ(report_.given, 1000u);
  EXPECT_EQ(report_.sentences, std::vector<std::string>{"One of 7 points was kept."});
}

TEST_F(ReadCloud, RepeatedPointsAreCountedAndKept) {
  std::vector<Eigen::Vector3d> points = parcel(1000);
  points.insert(points.end(), points.begin(), points.begin() + 30);
  points.push_back(points[4]);
  read_parcel_cloud(write_points("a.ply", points), {}, report_);
  EXPECT_EQ(report_.points, 1031u);
  EXPECT_EQ(report_.repeated, 31u);
  EXPECT_TRUE(report_.repeated_is_exact);
  EXPECT_EQ(report_.sentences,
            std::vector<std::string>{"31 of 1031 points coincide exactly with another one."});
}

TEST_F(ReadCloud, OneSpotIsRefused) {
  const std::vector<Eigen::Vector3d> spot(200'000, Eigen::Vector3d(12.5, 40.25, 3));
  EXPECT_EQ(error_of(write_points("spot.las", spot)),
            "point cloud 'spot.las' has all of its 200000 points in one spot of 0 m by 0 m, a "
            "parcel is at least 2 m long; if its numbers are degrees, give their system by --crs "
            "EPSG:4326");
  // A parcel around it does not hide it.
  std::vector<Eigen::Vector3d> points = parcel(1000);
  points.insert(points.begin() + 500, spot.begin(), spot.begin() + 1500);
  EXPECT_EQ(error_of(write_points("most.ply", points)),
            "point cloud 'most.ply' has about 1500 of its 2500 points within one square "
            "centimetre, which no survey sees; leave the repeated points out; if its numbers are "
            "degrees, give their system by --crs EPSG:4326");
  EXPECT_EQ(error_of(write("one.xyz", "500000 4649000 3\n")),
            "point cloud 'one.xyz' has all of its 1 points in one spot of 0 m by 0 m, a parcel is "
            "at least 2 m long");
}

TEST_F(ReadCloud, OneLineIsRefused) {
  std::vector<Eigen::Vector3d> line;
  for (int k = 0; k < 1000; ++k) line.emplace_back(500000 + 0.3 * k, 4649000 + 0.4 * k, 2);
  EXPECT_EQ(error_of(write_points("line.ply", line)),
            "point cloud 'line.ply' has all of its 1000 points on one line, 494 m long and 0 m "
            "wide, a parcel is at least 0.1 m wide");
}

TEST_F(ReadCloud, DegreesAreRefusedOrUnderstood) {
  std::vector<Eigen::Vector3d> degrees;
  for (const Geodetic& place : geodetic_parcel(500)) {
    degrees.emplace_back(deg_from_rad(place.longitude_rad), deg_from_rad(place.latitude_rad),
                         place.altitude_m);
  }
  const std::filesystem::path file = write_points("degrees.ply", degrees);
  EXPECT_NE(error_of(file).find("point cloud 'degrees.ply' seems to be in degrees (x 9.49"),
            std::string::npos)
      << error_of(file);
  CloudReadOptions options;
  options.crs = "EPSG:4326";
  EXPECT_EQ(error_of(file, options), "no error");
  EXPECT_NEAR(report_.bounds_W.sizes().x(), 60.0, 1.0);
  // Metres, said to be degrees.
  const std::string error =
      error_of(write_points("m.ply", parcel(10, {540000, 4983000, 0})), options);
  EXPECT_NE(error.find("point cloud 'm.ply' cannot be brought to the local frame: point (5400"),
            std::string::npos)
      << error;
  EXPECT_NE(
      error.find("is outside the area of the crs 'WGS 84'; give the system of its coordinates by "
                 "--crs EPSG:<code>, or --crs none if they are metres of a local frame"),
      std::string::npos)
      << error;
}

TEST_F(ReadCloud, OtherFaultsAreNamed) {
  // A quarter of a parcel lies 30 km east of the rest; the outer twentieths do not count.
  std::vector<Eigen::Vector3d> wide;
  for (int k = 0; k < 1000; ++k) {
    wide.emplace_back(0.6 * (k % 100) + (k % 4 == 0 ? 30'000 : 0), 4 * (k / 100), 2 * (k % 2));
  }
  EXPECT_EQ(error_of(write_points("wide.ply", wide)),
            "point cloud 'wide.ply' extends over 30.04 km by 36 m and is 2 m high, must be at "
            "most 5 km in each direction; cut the parcel out of it");

  const std::filesystem::path file = write_points("a.ply", parcel(1000));
  CloudReadOptions options;
  options.memory_limit = 5'000;
  EXPECT_EQ(error_of(file, options),
            "point cloud 'a.ply' has 1000 points, which take 12000 bytes, more than the limit of "
            "5000 bytes; keep one of 3 by --thin 3");
  options.thin = 3;
  EXPECT_EQ(error_of(file, options), "no error");
  options = {};
  options.thin = 0;
  EXPECT_EQ(error_of(file, options),
            "point cloud 'a.ply' cannot be read with thin = 0, must be 1 or more");
  options = {};
  options.crs = "EPSG:nonsense";
  EXPECT_EQ(error_of(file, options),
            "point cloud 'a.ply' cannot be brought to the local frame: crs = 'EPSG:nonsense' is "
            "not a coordinate reference system, must be like EPSG:32632; give the system of its "
            "coordinates by --crs EPSG:<code>, or --crs none if they are metres of a local frame");

  EXPECT_EQ(error_of(write("nan.xyz", "nan nan nan\n1 inf 2\n")),
            "point cloud 'nan.xyz' has no points left: 2 are not finite, 0 are marked as withheld");
  EXPECT_EQ(error_of(write_points("none.ply", {})), "point cloud 'none.ply' has no points");
  EXPECT_EQ(error_of(write("empty.las", "")), "point cloud 'empty.las' is empty (0 bytes)");
}

/// Coordinates near the ends of double neither trap nor overflow.
TEST_F(ReadCloud, HugeNumbersAreRefused) {
  EXPECT_NE(error_of(write("huge.xyz", "1e308 -1e308 1e308\n-1e308 1e308 0\n1 2 3\n"))
                .find("must be at most 5 km in each direction"),
            std::string::npos)
      << error_of(folder_ / "huge.xyz");
}

}  // namespace
}  // namespace vinerow::mapping::read_cloud_test
