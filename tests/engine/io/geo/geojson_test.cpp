#include "engine/io/geo/geojson.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "engine/core/error.h"
#include "engine/io/geo/geo_features.h"
#include "engine/math/angles.h"
#include "tests/engine/io/geo/utm32.h"
#include "tests/support/data.h"

namespace vinerow::io::geojson_test {
namespace {

std::filesystem::path write(const std::string& content) {
  const auto file = std::filesystem::temp_directory_path() /
                    (std::string("vinerow_geojson_") +
                     ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".geojson");
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

template <class F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "no error";
}

std::string feature(const std::string& type, const std::string& coordinates,
                    const std::string& properties = "{}") {
  return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":{"type":")" + type +
         R"(","coordinates":)" + coordinates + "}}";
}
std::string collection(const std::string& features) {
  return R"({"type":"FeatureCollection","features":[)" + features + "]}";
}

TEST(GeoJson, ReadsLongitudeBeforeLatitude) {
  const auto features = read_geojson(
      write("\xEF\xBB\xBF" +
            collection(feature("LineString", "[[8.5,44.5],[8.6,44.6,300]]", R"({"row":3})"))));
  ASSERT_EQ(features.size(), 1u);
  EXPECT_EQ(features[0].kind, GeometryKind::kLineString);
  EXPECT_DOUBLE_EQ(deg_from_rad(features[0].points[0].latitude_rad), 44.5);
  EXPECT_DOUBLE_EQ(deg_from_rad(features[0].points[0].longitude_rad), 8.5);
  EXPECT_EQ(features[0].points[1].altitude_m, 300.0);
  EXPECT_FALSE(features[0].has_altitude);
  EXPECT_EQ(features[0].property("row"), "3");
}

TEST(GeoJson, MultiGeometriesAndNullGeometryAreTaken) {
  const auto features =
      read_geojson(write(collection(feature("MultiLineString", "[[[1,1],[2,2]],[[3,3],[4,4]]]") +
                                    "," + feature("Polygon", "[[[0,0],[1,0],[1,1],[0,0]]]") +
                                    R"(,{"type":"Feature","geometry":null})")));
  ASSERT_EQ(features.size(), 3u);
  EXPECT_EQ(features[1].index, 0);
  EXPECT_EQ(features[2].kind, GeometryKind::kPolygon);
}

TEST(GeoJson, RefusesBadInputInOneSentence) {
  EXPECT_EQ(error_of([] { read_geojson("/none.geojson"); }),
            "GeoJSON file '/none.geojson' does not exist");
  const auto broken = write("{\n\"type\": \"FeatureCollection\",\n oops }");
  EXPECT_EQ(error_of([&] { read_geojson(broken); }),
            "GeoJSON file '" + broken.string() + "' is not valid JSON (line 3)");
  const auto fails_with = [](const std::string& content, const std::string& text) {
    const auto file = write(content);
    const std::string error = error_of([&] { read_geojson(file); });
    EXPECT_NE(error.find(text), std::string::npos) << error;
  };
  fails_with("{}", "is JSON but not GeoJSON");
  fails_with("[1]", "is JSON but not GeoJSON");
  fails_with(collection(feature("Point", "[\"a\",1]")), "must be [longitude, latitude]");
  fails_with(collection(feature("Point", "[null,1]")), "must be [longitude, latitude]");
  fails_with(collection(feature("Point", "[NaN,1]")), "is not valid JSON");
  fails_with(collection(feature("Point", "[1e999,1]")), "has a number that is too large");
  fails_with(collection(feature("Point", "[498518.9,375589.6]")),
             "is not WGS84 degrees (longitude within +-180, latitude within +-90)");
  fails_with(collection(feature("LineString", "[[1,1]]")),
             "a line needs at least 2 points, it has 1");
  fails_with(collection(feature("Circle", "[[1,1]]")), "unknown geometry 'Circle'");
}

TEST(Survey, PointsOnlyAreNoRows) {
  const auto file = write(collection(feature("Point", "[1,1]") + "," + feature("Point", "[1,2]")));
  EXPECT_EQ(error_of([&] { read_survey(file); }),
            "GeoJSON file '" + file.string() +
                "' has no LineString (2 points, 0 other features): each row must be a LineString, "
                "or points, its end poles, with its number as the property 'row'");
}

TEST(GeoJson, AMemberCrsIsConvertedFrom) {
  // ETRS89 / UTM zone 32N, from WGS84 by Krueger's series (utm32.h): the two agree to 1 mm here.
  const double latitude_rad = rad_from_deg(44.7), longitude_rad = rad_from_deg(8.03);
  const auto utm = utm32(latitude_rad, longitude_rad);
  const auto file_of = [&](const std::string& crs) {
    return write(R"({"type":"FeatureCollection","crs":)" + crs + R"(,"features":[)" +
                 feature("Point", fmt::format("[{:.4f},{:.4f}]", utm[0], utm[1])) + "]}");
  };
  const auto named = [](const std::string& name) {
    return R"({"type":"name","properties":{"name":")" + name + R"("}})";
  };
  for (const char* name : {"urn:ogc:def:crs:EPSG::25832", "EPSG:25832", "25832"}) {
    const auto features = read_geojson(file_of(named(name)));
    ASSERT_EQ(features.size(), 1u) << name;
    EXPECT_NEAR(features[0].points[0].latitude_rad, latitude_rad, 2e-10) << name;
    EXPECT_NEAR(features[0].points[0].longitude_rad, longitude_rad, 2e-10) << name;
  }
  const auto fails_with = [&](const std::string& crs, const std::string& text) {
    const auto file = file_of(crs);
    const std::string error = error_of([&] { read_geojson(file); });
    EXPECT_NE(error.find(text), std::string::npos) << error;
  };
  fails_with(named("urn:ogc:def:crs:OGC:1.3:CRS84"), "is not WGS84 degrees");
  fails_with("null", "convert projected coordinates with 'ogr2ogr -s_srs EPSG:<code> -t_srs");
  fails_with(named("EPSG:nonsense"), "crs = 'EPSG:nonsense' is not a coordinate reference system");
  fails_with("7", "crs = 7, must be like {\"type\": \"name\"");
}

TEST(GeoJson, NestingThatNoFileNeedsIsRefused) {
  const auto file = write(
      collection(feature("Point", std::string(200'000, '[') + "1" + std::string(200'000, ']'))));
  EXPECT_EQ(error_of([&] { read_geojson(file); }),
            "GeoJSON file '" + file.string() + "' is nested deeper than 100 levels");
}

std::filesystem::path write_as(const std::string& ending, const std::string& content) {
  const auto file = std::filesystem::path(write("")).replace_extension(ending);
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

TEST(GeoFeatures, KmlGivesRowsPolygonsAndNames) {
  const auto file = write_as(
      ".kml",
      R"(<?xml version="1.0" encoding="UTF-8"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document>
<Placemark><name>first</name><LineString><coordinates>8.03,44.7,300 8.04,44.71,301</coordinates>
</LineString></Placemark><Placemark><name>field</name><Polygon><outerBoundaryIs><LinearRing>
<coordinates>8,44 8.1,44 8.1,44.1 8,44</coordinates></LinearRing></outerBoundaryIs></Polygon>
</Placemark></Document></kml>)");
  const auto features = read_features(file);
  ASSERT_EQ(features.size(), 2u);
  EXPECT_EQ(features[0].kind, GeometryKind::kLineString);
  EXPECT_EQ(features[0].property("name"), "first");
  ASSERT_EQ(features[0].points.size(), 2u);
  EXPECT_NEAR(deg_from_rad(features[0].points[1].latitude_rad), 44.71, 1e-9);
  EXPECT_NEAR(deg_from_rad(features[0].points[1].longitude_rad), 8.04, 1e-9);
  EXPECT_EQ(features[0].points[1].altitude_m, 301.0);
  EXPECT_EQ(features[1].kind, GeometryKind::kPolygon);
  EXPECT_EQ(features[1].points.size(), 4u);
  EXPECT_EQ(read_survey(file).rows.size(), 1u);
  const auto broken = write_as(".kml", "no KML");
  EXPECT_EQ(error_of([&] { read_features(broken); }),
            "file '" + broken.string() + "' cannot be read: it is not a KML file");
  EXPECT_EQ(error_of([] { read_features("/none.kml"); }), "file '/none.kml' does not exist");
}

/// Bytes of a shapefile of one line (ESRI Shapefile Technical Description, 1998): the header's
/// lengths are in 16-bit words, big-endian.
std::string shapefile_of(const std::vector<std::array<double, 2>>& line, bool index) {
  std::string out;
  const auto big = [&](std::int32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift);
  };
  const auto put = [&](auto value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto box = [&] {
    for (const auto& p : {line.front(), line.back()}) put(p[0]), put(p[1]);
  };
  const auto content = static_cast<std::int32_t>(48 + 16 * line.size());
  big(9994);
  for (int i = 0; i < 5; ++i) big(0);
  big((100 + 8 + (index ? 0 : content)) / 2);
  put(std::int32_t{1000}), put(std::int32_t{3});
  box();
  for (int i = 0; i < 4; ++i) put(0.0);
  big(index ? 50 : 1), big(content / 2);
  if (index) return out;
  put(std::int32_t{3});
  box();
  put(std::int32_t{1}), put(static_cast<std::int32_t>(line.size())), put(std::int32_t{0});
  for (const auto& p : line) put(p[0]), put(p[1]);
  return out;
}

TEST(GeoFeatures, ShapefileIsConvertedFromItsOwnSystem) {
  const double latitude_rad = rad_from_deg(44.7), longitude_rad = rad_from_deg(8.03);
  const auto a = utm32(latitude_rad, longitude_rad);
  const std::vector<std::array<double, 2>> line = {{a[0], a[1]}, {a[0] + 50.0, a[1] + 10.0}};
  const auto file = write_as(".shp", shapefile_of(line, false));
  write_as(".shx", shapefile_of(line, true));
  std::filesystem::remove(std::filesystem::path(file).replace_extension(".prj"));
  EXPECT_EQ(error_of([&] { read_features(file); }),
            "'" + file.string() +
                "', feature 0: its layer has no coordinate reference system; a shapefile needs a "
                ".prj file with it in the same folder");
  write_as(
      ".prj",
      R"(PROJCS["ETRS_1989_UTM_Zone_32N",GEOGCS["GCS_ETRS_1989",DATUM["D_ETRS_1989",SPHEROID["GRS_1980",6378137.0,298.257222101]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",9.0],PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]])");
  const SurveyFile survey = read_survey(file);
  ASSERT_EQ(survey.rows.size(), 1u);
  ASSERT_EQ(survey.rows[0].points.size(), 2u);
  EXPECT_NEAR(survey.rows[0].points[0].latitude_rad, latitude_rad, 2e-10);
  EXPECT_NEAR(survey.rows[0].points[0].longitude_rad, longitude_rad, 2e-10);
}

TEST(Survey, EndPolesWithARowsNumberMakeTheRows) {
  const auto pole = [](const char* place, const char* row) {
    return feature("Point", place, R"({"type":"pole","row":)" + std::string(row) + "}");
  };
  // Row 7's three poles out of order, a vine of the same number, a pole of no row.
  const auto file =
      write(collection(pole("[8.0010,44]", "7") + "," + pole("[8.0000,44]", "7") + "," +
                       pole("[8.0000,44.0001]", "8") + "," + pole("[8.0005,44]", "7") + "," +
                       pole("[8.0010,44.0001]", "8") + "," +
                       feature("Point", "[8.002,44]", R"({"type":"vine","row":7})") + "," +
                       feature("Point", "[8.003,44]", R"({"type":"pole"})")));
  const SurveyFile survey = read_survey(file);
  ASSERT_EQ(survey.rows.size(), 2u);
  ASSERT_EQ(survey.rows[0].points.size(), 3u);
  EXPECT_NEAR(deg_from_rad(survey.rows[0].points[1].longitude_rad), 8.0005, 1e-12);
  EXPECT_NEAR(
      std::abs(survey.rows[0].points[2].longitude_rad - survey.rows[0].points[0].longitude_rad),
      rad_from_deg(0.001), 1e-12);
  EXPECT_EQ(survey.rows[1].property("row"), "8");
  EXPECT_EQ(survey.poles.size(), 6u);
  EXPECT_EQ(survey.vines.size(), 1u);
  const auto lonely = write(collection(pole("[8,44]", "7") + "," + pole("[8,44.1]", "8")));
  EXPECT_EQ(
      error_of([&] { read_survey(lonely); }),
      "'" + lonely.string() + "', feature 0: row '7' has one point, it needs two: its end poles");
}

TEST(Survey, SortsRowsPolesAndVines) {
  const auto file = write(collection(
      feature("LineString", "[[1,1],[1,2]]", R"({"type":"row"})") + "," +
      feature("LineString", "[[1,1],[1,2]]", R"({"type":"mid_row_line"})") + "," +
      feature("Point", "[1,1]", R"({"Point":"ROW01POLE01"})") + "," +
      feature("Point", "[1,1]", R"({"type":"vine"})") + "," + feature("Point", "[1,1]")));
  const SurveyFile survey = read_survey(file);
  EXPECT_EQ(survey.rows.size(), 1u);
  EXPECT_EQ(survey.poles.size(), 1u);
  EXPECT_EQ(survey.vines.size(), 1u);
  EXPECT_EQ(read_survey(file, "mid_row_line").rows.size(), 1u);
  const std::string error = error_of([&] { read_survey(file, "mid_row_lines"); });
  EXPECT_NE(error.find("has 2 LineStrings but none of type 'mid_row_lines'"), std::string::npos)
      << error;
  EXPECT_NE(error.find("did you mean 'mid_row_line'?"), std::string::npos) << error;
}

TEST(Survey, ReadsTheRiseholmeFiles) {
  VINEROW_OUTSIDE_DATA(folder, "vineyard_detection/data");
  EXPECT_EQ(read_survey(folder / "vineyard_poles_and_rows.geojson").rows.size(), 10u);
  EXPECT_EQ(read_survey(folder / "mid_row_lines.geojson", "mid_row_line").rows.size(), 9u);
  EXPECT_EQ(read_geojson(folder / "riseholme_rtk_gps_poles.geojson").size(), 40u);
  const std::string error =
      error_of([&] { read_survey(folder / "riseholme_rtk_gps_poles.geojson"); });
  EXPECT_NE(error.find("has no LineString (40 points"), std::string::npos) << error;
}

}  // namespace
}  // namespace vinerow::io::geojson_test
