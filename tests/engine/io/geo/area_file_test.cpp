#include "engine/io/geo/area_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "engine/core/error.h"
#include "engine/io/geo/point_csv.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"

namespace vinerow::io::area_file_test {
namespace {

using Eigen::Vector2d;

const Polygon kSquare = {{0, 0}, {100, 0}, {100, 100}, {0, 100}};
/// An arrow head: its notch reaches to the middle.
const Polygon kArrow = {{0, 0}, {200, 100}, {0, 200}, {80, 100}};

std::string fault_of(const Polygon& polygon) {
  return find_area_fault(polygon).value_or("none");
}

TEST(AreaFile, FaultsNameTheEdgesThatCross) {
  EXPECT_EQ(fault_of(kSquare), "none");
  EXPECT_EQ(fault_of(kArrow), "none");
  EXPECT_EQ(fault_of({{0, 0}, {100, 100}, {100, 0}, {0, 100}}),
            "its edge from point 1 (0.0, 0.0) to point 2 (100.0, 100.0) crosses its edge from "
            "point 3 (100.0, 0.0) to point 4 (0.0, 100.0)");
  // A corner that touches an edge, an edge on an edge, and a spike.
  EXPECT_NE(fault_of({{0, 0}, {100, 0}, {100, 100}, {50, 0}, {0, 100}}), "none");
  EXPECT_NE(fault_of({{0, 0}, {100, 0}, {100, 50}, {80, 0}, {20, 0}, {0, 50}}), "none");
  EXPECT_NE(fault_of({{0, 0}, {100, 0}, {100, 100}, {100, 160}, {100, 100}, {0, 100}}), "none");
  EXPECT_EQ(fault_of({{0, 0}, {1, 1}}), "it has 2 different points, needs at least 3");
  EXPECT_EQ(fault_of({{0, 0}, {50, 50}, {100, 100}}),
            "its 3 points enclose 0.000 m2, must be at least 1 m2");
  EXPECT_EQ(fault_of({{0, 0}, {100, 0}, {-8e6, 100}}),
            "its points 1 and 3 are 8000 km apart, must be at most 50 km");
  Polygon circle;
  for (int i = 0; i < 5001; ++i) {
    const double angle_rad = 2.0 * 3.141592653589793 * i / 5001;
    circle.emplace_back(100.0 * std::cos(angle_rad), 100.0 * std::sin(angle_rad));
  }
  EXPECT_EQ(fault_of(circle), "it has 5001 points, must have at most 5000: simplify it");
}

TEST(AreaFile, ReadsGeoJsonAndCsv) {
  const auto folder = std::filesystem::temp_directory_path();
  const GeoOrigin origin{rad_from_deg(44.7), rad_from_deg(8.0), 300.0};
  const LocalFrame frame(origin);
  std::string ring;
  for (const Vector2d& p : {Vector2d(0, 0), Vector2d(100, 0), Vector2d(50, 80), Vector2d(0, 0)}) {
    const Geodetic g = frame.to_geodetic({p.x(), p.y(), 0.0});
    ring += (ring.empty() ? "[" : ",[") + std::to_string(deg_from_rad(g.longitude_rad)) + "," +
            std::to_string(deg_from_rad(g.latitude_rad)) + "]";
  }
  const auto geojson = folder / "vinerow_survey_area.geojson";
  std::ofstream(geojson) << R"({"type":"Polygon","coordinates":[[)" << ring << "]]}";
  const Polygon polygon = read_area(geojson, origin);
  ASSERT_EQ(polygon.size(), 3u);
  EXPECT_LT((polygon[2] - Vector2d(50, 80)).norm(), 0.2);  // six digits of a degree

  std::ofstream(geojson) << R"({"type":"Point","coordinates":[8,44]})";
  EXPECT_THROW(read_area(geojson, origin), ConfigError);

  const auto csv = folder / "vinerow_survey_area.CSV";
  std::ofstream(csv) << "x,y\n# corners\n0,0\r\n100;0\n 50, 80 \n0,0\n";
  EXPECT_EQ(read_area(csv, origin), (Polygon{{0, 0}, {100, 0}, {50, 80}}));
  std::ofstream(csv) << "0,0\n1,2,3\n";
  try {
    read_area(csv, origin);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find(":2: '1,2,3' must be two numbers"), std::string::npos);
  }
}

TEST(PointCsv, ReadsWhatSpreadsheetsWriteAndDropsNoPoint) {
  const std::string file = ::testing::TempDir() + "vinerow_points.csv";
  const auto read = [&](const std::string& text) {
    std::ofstream(file) << text;
    return read_points_csv(file);
  };
  const std::vector<Vector2d> points = {{1, 2}, {-3, 4.5}};
  EXPECT_EQ(read("\xEF\xBB\xBF"
                 "1,2\r\n-3;4.5\r\n"),
            points);
  EXPECT_EQ(read("\xEF\xBB\xBFx,y\n1,2\n-3,4.5\n"), points);
  EXPECT_EQ(read("\"x (m)\",\"y (m)\"\n1,2\n-3,4.5\n"), points);
  const auto fault = [&](const std::string& text) {
    try {
      read(text);
    } catch (const ConfigError& e) {
      return std::string(e.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(fault("1,2x\n3,4\n"), file + ":1: '1,2x' must be two numbers, x and y in metres");
  EXPECT_EQ(fault("x,y\n# nothing\n"), file + ": has no points");
  EXPECT_EQ(fault(""), file + ": has no points");
  EXPECT_THROW(read_points_csv(::testing::TempDir()), ConfigError);
}

}  // namespace
}  // namespace vinerow::io::area_file_test
