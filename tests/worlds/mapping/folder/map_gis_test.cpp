/// What a surveyor's program is given: layers in the cloud's system with the rows' figures, and
/// rasters of ground, surface and canopy height. Judged by SQLite and by the elevation reader.

#include "worlds/mapping/folder/map_gis.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/io/geo/local_to_crs.h"
#include "engine/io/geo/raster.h"
#include "engine/math/geo.h"
#include "tests/support/folder_test.h"
#include "tests/worlds/mapping/cloud_map_fixture.h"

namespace vinerow::mapping::map_gis_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Four points on every 0.25 m of ground, and a pole of 3 m at `pole`.
ParcelCloud cloud_over(const CloudMap& map, const Eigen::Vector2d& pole) {
  ParcelCloud cloud;
  const Eigen::Vector3d& first = map.map.rows.front().line_W.front();
  cloud.origin_W = first.array().round();
  const auto add = [&](double x, double y, double above_m) {
    const Eigen::Vector3d p(x, y, map.map.terrain->height_m(x, y) + above_m);
    cloud.points.push_back((p - cloud.origin_W).cast<float>());
  };
  for (double x = -20.0; x < 20.0; x += 0.1) {
    for (double y = -20.0; y < 20.0; y += 0.1) add(pole.x() + x, pole.y() + y, 0.0);
  }
  for (double z = 0.0; z <= 3.0; z += 0.1) add(pole.x(), pole.y(), z);
  return cloud;
}

class MapGis : public test::FolderTest {
 protected:
  MapGis() : FolderTest("map_gis") {}

  json layers() const {
    const std::string out = (folder_ / "layers.json").string();
    const int status = std::system(("python3 " VINEROW_SOURCE_DIR
                                    "/tests/worlds/mapping/folder/geopackage_check.py " +
                                    (folder_ / "gis/map.gpkg").string() + " > " + out)
                                       .c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    std::ifstream in(out);
    return json::parse(in);
  }
};

TEST_F(MapGis, LayersHaveOneKindOfGeometryAndTheRowsFigures) {
  CloudMap map = test::map_of_world("vineyard");
  const Eigen::Vector2d pole = map.map.rows[0].line_W.front().head<2>();
  save_gis(map, cloud_over(map, pole), folder_);
  const json made = layers();
  ASSERT_EQ(made.size(), 4u);
  const std::map<std::string, std::string> kinds = {{"alleys", "LINESTRING"},
                                                    {"boundary", "POLYGON"},
                                                    {"row_ends", "POINT"},
                                                    {"rows", "LINESTRING"}};
  for (const auto& [name, kind] : kinds) {
    EXPECT_EQ(made.at(name).at("type"), kind);
    EXPECT_EQ(made.at(name).at("epsg"), 32632) << "the cloud's own";
  }
  const io::LocalToCrs exact("EPSG:32632", map.origin);
  const json& rows = made.at("rows").at("features");
  ASSERT_EQ(rows.size(), map.map.rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const json& values = rows[k].at("values");
    const MappedRowFigures& figures = map.report.rows[k];
    EXPECT_EQ(values.at("row"), map.map.rows[k].id);
    EXPECT_EQ(values.at("block"), 0);
    EXPECT_EQ(values.at("volume_m3").get<double>(), figures.volume_m3);
    EXPECT_NEAR(values.at("volume_m3_per_m").get<double>(), figures.volume_m3 / figures.length_m,
                1e-12);
    // 2 m - 1/3 m and 1.1 m.
    EXPECT_NEAR(values.at("gaps_m").get<double>(), 2.0 - 1.0 / 3.0 + 1.1, 1e-12);
    ASSERT_EQ(rows[k].at("points").size(), map.map.rows[k].line_W.size());
    for (std::size_t n = 0; n < map.map.rows[k].line_W.size(); ++n) {
      const Eigen::Vector3d expected = exact.from_local(map.map.rows[k].line_W[n]);
      for (int axis = 0; axis < 3; ++axis) {
        // The files' straight maps reach 20 m around the cloud's own tiles.
        EXPECT_NEAR(rows[k].at("points")[n][axis].get<double>(), expected[axis], 5e-3);
      }
    }
  }
  EXPECT_EQ(made.at("row_ends").at("features").size(), 2 * rows.size());
  EXPECT_EQ(made.at("alleys").at("features").size(), map.map.alleys.size());
}

TEST_F(MapGis, RastersAreGroundSurfaceAndWhatStandsBetween) {
  CloudMap map = test::map_of_world("vineyard");
  map.report.density_per_m2 = 100.0;  // pixels of 0.2 m
  const Eigen::Vector2d pole =
      map.map.rows[0].line_W.front().head<2>() + Eigen::Vector2d(5.03, 5.04);
  save_gis(map, cloud_over(map, pole), folder_);
  const LocalFrame frame(map.origin);
  const io::ElevationLookup dtm(io::read_elevation(folder_ / "gis/dtm.tif", ""));
  const io::ElevationLookup dsm(io::read_elevation(folder_ / "gis/dsm.tif", ""));
  const auto at = [&](const io::ElevationLookup& raster, double x, double y) {
    const Geodetic place = frame.to_geodetic({x, y, map.map.terrain->height_m(x, y)});
    const auto height_m = raster.height_m(place.latitude_rad, place.longitude_rad);
    EXPECT_TRUE(height_m.has_value()) << x << " " << y;
    return height_m.value_or(-1e9) - place.altitude_m;
  };
  for (double x = -15.0; x <= 15.0; x += 3.1) {
    for (double y = -15.0; y <= 15.0; y += 3.3) {
      EXPECT_NEAR(at(dtm, pole.x() + x, pole.y() + y), 0.0, 0.02);
      if (std::abs(x) < 1.0 && std::abs(y) < 1.0) continue;
      EXPECT_NEAR(at(dsm, pole.x() + x, pole.y() + y), 0.0, 0.12) << "half a pixel up the slope";
    }
  }
  EXPECT_TRUE(fs::exists(folder_ / "gis/chm.tif"));
}

TEST_F(MapGis, WritesTheSameBytesTwice) {
  const CloudMap& map = test::map_of_world("vineyard");
  const ParcelCloud cloud = cloud_over(map, map.map.rows[0].line_W.front().head<2>());
  const auto read = [](const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  save_gis(map, cloud, folder_ / "a");
  save_gis(map, cloud, folder_ / "b");
  for (const char* file : {"map.gpkg", "dtm.tif", "dsm.tif", "chm.tif"}) {
    const std::string bytes = read(folder_ / "a/gis" / file);
    EXPECT_FALSE(bytes.empty()) << file;
    EXPECT_EQ(bytes, read(folder_ / "b/gis" / file)) << file;
  }
}

TEST(MapGisCrs, IsTheCloudsWhereItHasMetresElseTheUtmZone) {
  CloudMap map = test::map_of_world("vineyard");
  EXPECT_EQ(gis_crs(map), "EPSG:32632");
  map.report.crs = "EPSG:25831";
  EXPECT_EQ(gis_crs(map), "EPSG:25831");
  map.report.crs = "EPSG:4326";
  map.origin = {0.7, 0.14, 300.0};  // 8.02 degrees east: zone 32
  EXPECT_EQ(gis_crs(map), "EPSG:32632");
  map.report.crs = "";
  map.origin = {-0.6, 2.4, 300.0};  // 137.5 degrees east, south: zone 53
  EXPECT_EQ(gis_crs(map), "EPSG:32753");
  map.has_origin = false;
  EXPECT_EQ(gis_crs(map), "");
}

TEST(RowsCsv, HasALineForEachRow) {
  const CloudMap& map = test::map_of_world("vineyard");
  std::istringstream text(rows_to_csv(map));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line,
            "block,row,length_m,bearing_deg,canopy_width_m,canopy_base_m,canopy_top_m,volume_m3,"
            "volume_m3_per_m,seen_volume_m3,gaps,gaps_m");
  std::size_t rows = 0;
  while (std::getline(text, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 11);
    EXPECT_EQ(line.rfind("0," + std::to_string(map.report.rows[rows].row) + ",", 0), 0u);
    ++rows;
  }
  EXPECT_EQ(rows, map.report.rows.size());
}

}  // namespace
}  // namespace vinerow::mapping::map_gis_test
