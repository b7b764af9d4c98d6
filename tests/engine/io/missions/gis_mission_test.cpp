#include "engine/io/missions/gis_mission.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>

#include "engine/core/error.h"
#include "engine/io/geo/gis_files.h"
#include "engine/math/angles.h"
#include "tests/support/paths.h"

namespace vinerow::io::gis_mission_test {
namespace {

std::filesystem::path test_file(const std::string& ending) {
  return std::filesystem::temp_directory_path() /
         (std::string("vinerow_gis_mission_") +
          ::testing::UnitTest::GetInstance()->current_test_info()->name() + ending);
}

/// A GeoPackage as GDAL writes it, in longitude and latitude.
std::filesystem::path write_package(const std::vector<GisLayer>& layers) {
  const std::filesystem::path file = test_file(".gpkg");
  write_geopackage(layers, "EPSG:4326", file);
  return file;
}

std::filesystem::path write_geojson(const std::string& features) {
  const std::filesystem::path file = test_file(".geojson");
  std::ofstream(file) << R"({"type": "FeatureCollection", "features": [)" << features << "]}";
  return file;
}

/// A feature of GeoJSON. @param properties  R"("speed_mps": 1)"
std::string feature(const std::string& type, const std::string& coordinates,
                    const std::string& properties = "") {
  return R"({"type": "Feature", "properties": {)" + properties + R"(}, "geometry": {"type": ")" +
         type + R"(", "coordinates": )" + coordinates + "}}";
}

std::string error_of(const std::filesystem::path& file) {
  try {
    read_mission(file);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(GisMission, ReadsLinesWithSpeedsSprayerAndFencesOfAGeoPackage) {
  GisLayer rows{"rows", GeometryKind::kLineString, {"speed_mps", "sprayer"}, {}};
  rows.features.push_back({{{8.1, 44.5, 0}, {8.2, 44.5, 0}}, {1.5, std::int64_t{1}}});
  rows.features.push_back(
      {{{8.2, 44.6, 0}, {8.15, 44.6, 0}, {8.1, 44.6, 0}}, {2.0, std::int64_t{0}}});
  GisLayer areas{"areas", GeometryKind::kPolygon, {"fence"}, {}};
  areas.features.push_back({{{8, 44, 0}, {9, 44, 0}, {9, 45, 0}, {8, 44, 0}}, {"inclusion"}});
  areas.features.push_back({{{8, 44, 0}, {9, 44, 0}, {9, 45, 0}, {8, 44, 0}}, {""}});
  GisLayer poles{"poles", GeometryKind::kPoint, {"name"}, {}};
  poles.features.push_back({{{8.3, 44.3, 0}}, {"pole"}});
  const MissionFile mission = read_mission(write_package({rows, areas, poles}));

  std::vector<int> commands;
  for (const MissionItem& item : mission.items) commands.push_back(item.command);
  // The pole is no place to go to, as there are lines.
  EXPECT_EQ(commands, (std::vector<int>{16, 178, 216, 16, 216, 16, 178, 16, 16}));
  EXPECT_EQ(mission.items[1].params[1], 1.5);
  EXPECT_EQ(mission.items[2].params[0], 1.0);
  EXPECT_EQ(mission.items[4].params[0], 0.0);
  EXPECT_NEAR(mission.items[3].params[4], 44.5, 1e-12);
  EXPECT_NEAR(mission.items[3].params[5], 8.2, 1e-12);
  EXPECT_NEAR(mission.items[7].params[5], 8.15, 1e-12);
  ASSERT_EQ(mission.fence_polygons.size(), 1u);
  EXPECT_TRUE(mission.fence_polygons[0].inclusion);
  EXPECT_EQ(mission.fence_polygons[0].points.size(), 3u);
  EXPECT_NEAR(deg_from_rad(mission.fence_polygons[0].points[2].latitude_rad), 45.0, 1e-12);
}

TEST(GisMission, EndsWithALandingOrAReturn) {
  const std::string line = "[[8.1, 44.5], [8.2, 44.5]]";
  const auto ending = [&](const std::string& end) {
    return write_geojson(feature("LineString", line, R"("height_m": 12)") + "," +
                         feature("LineString", line, R"("height_m": 12, "at_end": ")" + end + '"'));
  };
  const MissionFile landing = read_mission(ending("land"));
  ASSERT_EQ(landing.items.size(), 5u);
  EXPECT_EQ(landing.items[4].command, 21);
  EXPECT_EQ(landing.items[4].frame, 3);
  EXPECT_EQ(landing.items[4].params[4], 44.5);
  EXPECT_EQ(landing.items[4].params[5], 8.2);
  EXPECT_EQ(landing.items[4].params[6], 0.0);
  // GIS programs store lines as multiple ones.
  const MissionFile parts = read_mission(write_geojson(
      feature("MultiLineString", "[" + line + ", " + line + "]", R"("at_end": "land")")));
  ASSERT_EQ(parts.items.size(), 5u);
  EXPECT_EQ(parts.items[4].command, 21);
  const MissionFile returning = read_mission(ending("return"));
  ASSERT_EQ(returning.items.size(), 5u);
  EXPECT_EQ(returning.items[4].command, 20);
  EXPECT_TRUE(
      error_of(ending("lnd")).ends_with(", feature 1: at_end = 'lnd', must be land or return"));
  const auto early = write_geojson(feature("LineString", line, R"("at_end": "land")") + "," +
                                   feature("LineString", line));
  EXPECT_TRUE(
      error_of(early).ends_with(", feature 0: at_end = 'land', but another line or point follows"));
}

TEST(GisMission, VisitsPointsInTheirOrder) {
  const MissionFile mission =
      read_mission(write_geojson(feature("Point", "[8.3, 44.5]", R"("order": 3, "height_m": 12)") +
                                 "," + feature("Point", "[8.1, 44.5, 250]", R"("order": 1)") + "," +
                                 feature("Point", "[8.2, 44.5]", R"("order": 2)")));
  ASSERT_EQ(mission.items.size(), 3u);
  EXPECT_EQ(mission.items[0].params[5], 8.1);
  EXPECT_EQ(mission.items[0].frame, 0);  // above mean sea level
  EXPECT_EQ(mission.items[0].params[6], 250.0);
  EXPECT_EQ(mission.items[1].params[5], 8.2);
  EXPECT_EQ(mission.items[1].params[6], 0.0);
  EXPECT_EQ(mission.items[2].params[5], 8.3);
  EXPECT_EQ(mission.items[2].frame, 3);  // above home
  EXPECT_EQ(mission.items[2].params[6], 12.0);
}

TEST(GisMission, HeightsOfKmlAreAboveWhatTheirAltitudeModeNames) {
  struct Case {
    std::string mode;
    int frame;
    double altitude_m;
  };
  for (const Case& c : {Case{"<altitudeMode>relativeToGround</altitudeMode>", 10, 20.0},
                        Case{"<altitudeMode>absolute</altitudeMode>", 0, 20.0},
                        Case{"<altitudeMode>clampToGround</altitudeMode>", 3, 0.0}}) {
    SCOPED_TRACE(c.mode);
    const auto file = test_file(".kml");
    std::ofstream(file) << R"(<?xml version="1.0" encoding="UTF-8"?>
<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><LineString>)"
                        << c.mode << "<coordinates>8.1,44.5,20 8.2,44.5,20</coordinates>"
                        << "</LineString></Placemark></Document></kml>";
    const MissionFile mission = read_mission(file);
    ASSERT_EQ(mission.items.size(), 2u);
    for (const MissionItem& item : mission.items) {
      EXPECT_EQ(item.frame, c.frame);
      EXPECT_EQ(item.params[6], c.altitude_m);
    }
  }
}

TEST(GisMission, SaysWhatIsWrong) {
  const std::string line = "[[8.1, 44.5], [8.2, 44.5]]";
  const auto error = [&](const std::string& properties) {
    const auto file = write_geojson(feature("LineString", line, properties));
    return std::pair(error_of(file), "mission '" + file.string() + "', feature 0: ");
  };
  for (const auto& [properties, what] :
       {std::pair<std::string, std::string>{R"("speed_mps": "fast")",
                                            "speed_mps = 'fast' is not a number"},
        {R"("speed_mps": -1)", "speed_mps = -1, must be > 0"},
        {R"("sprayer": "perhaps")", "sprayer = 'perhaps', must be true or false"},
        {R"("height_m": "1e999")", "height_m = '1e999' is not a number"}}) {
    const auto [text, place] = error(properties);
    EXPECT_EQ(text, place + what);
  }
  const std::string ring = "[[[8, 44], [9, 44], [9, 45], [8, 44]]]";
  const auto areas = write_geojson(feature("Polygon", ring, R"("fence": "keep out")"));
  EXPECT_EQ(error_of(areas),
            "mission '" + areas.string() +
                "', feature 0: fence = 'keep out', must be inclusion or exclusion");
  const std::string bow = "[[[8, 44], [8, 44], [9, 45], [9, 44], [8, 45], [8, 44]]]";
  const auto crossed = write_geojson(feature("LineString", line) + "," +
                                     feature("Polygon", bow, R"("fence": "exclusion")"));
  EXPECT_EQ(error_of(crossed),
            "mission '" + crossed.string() +
                "', fence polygon 1: the edge from its point 1 meets the edge from its point 4, "
                "points must be in order around it");
  const auto none = write_geojson(feature("Polygon", ring));
  EXPECT_EQ(error_of(none), "mission '" + none.string() + "' has neither lines nor points");
  std::ofstream(test_file(".gpkg")) << "hello";
  EXPECT_EQ(error_of(test_file(".gpkg")),
            "file '" + test_file(".gpkg").string() + "' cannot be read: it is not a GeoPackage");
}

}  // namespace
}  // namespace vinerow::io::gis_mission_test
