/// What a map's folder keeps of its points.

#include "worlds/mapping/folder/map_points.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/folder_test.h"
#include "tests/worlds/mapping/cloud_map_fixture.h"

namespace vinerow::mapping::map_points_test {
namespace {

namespace fs = std::filesystem;

MapPoints some_points() {
  MapPoints points;
  points.reading.crs = "EPSG:32632";
  points.reading.thin = 3;
  points.reading.origin = GeoOrigin{0.1 + 0.2, -1.0 / 3.0, 300.1};
  points.occupancy.cell_m = 0.1;
  points.occupancy.virtual_walls = false;
  points.occupancy.first_wall = RowEnd::kLast;
  points.classes = {PointClass::kGround, PointClass::kCanopy, PointClass::kOther,
                    PointClass::kLowVegetation, PointClass::kUnclassified};
  return points;
}

class MapPointsFiles : public test::FolderTest {
 protected:
  MapPointsFiles() : FolderTest("map_points") {}

  void write(const char* file, const std::string& text) const {
    std::ofstream(folder_ / file, std::ios::binary) << text;
  }
  std::string error_of_load() const {
    return without_folder(test::config_error_of([&] { load_map_points(folder_); }));
  }
};

TEST_F(MapPointsFiles, ReadBackToTheBit) {
  const MapPoints wrote = some_points();
  save_map_points(wrote, folder_);
  const auto read = load_map_points(folder_);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->reading.crs, wrote.reading.crs);
  EXPECT_EQ(read->reading.thin, wrote.reading.thin);
  ASSERT_TRUE(read->reading.origin);
  EXPECT_EQ(read->reading.origin->latitude_rad, wrote.reading.origin->latitude_rad);
  EXPECT_EQ(read->reading.origin->longitude_rad, wrote.reading.origin->longitude_rad);
  EXPECT_EQ(read->reading.origin->altitude_m, wrote.reading.origin->altitude_m);
  EXPECT_EQ(read->occupancy.cell_m, wrote.occupancy.cell_m);
  EXPECT_EQ(read->occupancy.virtual_walls, wrote.occupancy.virtual_walls);
  EXPECT_EQ(read->occupancy.first_wall, wrote.occupancy.first_wall);
  EXPECT_EQ(read->classes, wrote.classes);

  save_map_points({}, folder_);
  const auto usual = load_map_points(folder_);
  ASSERT_TRUE(usual);
  EXPECT_FALSE(usual->reading.origin);
  EXPECT_FALSE(usual->occupancy.first_wall);
  EXPECT_TRUE(usual->classes.empty());
}

TEST_F(MapPointsFiles, GoWithAnEarlierMap) {
  EXPECT_FALSE(load_map_points(folder_));
  save_map_points(some_points(), folder_);
  save_map(test::map_of_world("vineyard"), folder_);
  EXPECT_FALSE(fs::exists(folder_ / "points.json"));
  EXPECT_FALSE(fs::exists(folder_ / "points.classes"));
  EXPECT_FALSE(load_map_points(folder_));
}

TEST_F(MapPointsFiles, BrokenOnesAreRefusedInASentence) {
  save_map_points(some_points(), folder_);
  write("points.classes", "\2\5");
  EXPECT_EQ(error_of_load(), "'points.classes' contains 2 classes, but points.json states 5");
  write("points.classes", "\2\5\6\3\7");
  EXPECT_EQ(error_of_load(), "'points.classes' contains 7, which is not a point class");
  fs::remove(folder_ / "points.classes");
  EXPECT_EQ(error_of_load(), "'points.classes' contains 0 classes, but points.json states 5");
  write("points.json", "{\"vinerow_map_points\": 2}");
  EXPECT_EQ(error_of_load(),
            "points of a map 'points.json' are of another version, must be of version 1");
  write("points.json", "{");
  EXPECT_EQ(error_of_load(), "points of a map 'points.json' are not valid JSON");
}

}  // namespace
}  // namespace vinerow::mapping::map_points_test
