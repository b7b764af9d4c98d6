#include "engine/io/geojson.h"

#include <gtest/gtest.h>

#include <fstream>

#include "engine/core/error.h"
#include "engine/math/angles.h"
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
                "' has no LineString (2 points, 0 other features): each row must be a LineString");
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
