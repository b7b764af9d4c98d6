#include "engine/io/grids/ros_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/io/grids/pgm.h"
#include "tests/support/folder_test.h"

namespace vinerow::io::ros_map_test {
namespace {

class RosMapFiles : public vinerow::test::FolderTest {
 protected:
  RosMapFiles() : FolderTest("ros_map") {}

  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return (folder_ / name).string();
  }
  /// The map of a picture with the usual YAML.
  RosMap load(const std::string& picture, const std::string& more = "negate: 0\n") const {
    write("map.pgm", picture);
    return load_ros_map(write("map.yaml", kYaml + more));
  }
  std::string error_of(const std::string& picture, const std::string& yaml) const {
    write("map.pgm", picture);
    const std::string file = write("map.yaml", yaml);
    try {
      load_ros_map(file);
    } catch (const ConfigError& e) {
      return without_folder(e.what());
    }
    return "no error";
  }

  const std::string kYaml =
      "image: map.pgm\nresolution: 0.5\norigin: [-1.0, 2.0, 0.0]\n"
      "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
  const std::string kPicture =
      std::string("P5\n2 2\n255\n") + "\xfe" + std::string(1, '\0') + "\xcd\xfe";
};

TEST_F(RosMapFiles, ReadsAMapAsMapSaverWritesIt) {
  // What `rosrun map_server map_saver` writes: a comment in the header, 254, 0 and 205.
  const std::string header = "P5\n# CREATOR: map_saver.cpp 0.050 m/pix\n4 3\n255\n";
  const std::string pixels =
      "\xfe\xfe\xcd\xcd" + std::string("\xfe\0\0\xfe", 4) + std::string("\xfe\xfe\xfe\0", 4);
  write("map.pgm", header + pixels);
  const RosMap map = load_ros_map(
      write("map.yaml",
            "image: map.pgm\nresolution: 0.050000\norigin: [-12.200000, -13.800000, 0.000000]\n"
            "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n\n"));
  EXPECT_EQ(map.grid.columns, 4);
  EXPECT_EQ(map.grid.rows, 3);
  EXPECT_EQ(map.grid.cell_m, 0.05);
  EXPECT_EQ(map.grid.corner_W, Eigen::Vector2d(-12.2, -13.8));
  // The picture's last row is the grid's first.
  const std::vector<std::uint8_t> expected = {0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1};
  EXPECT_EQ(map.grid.cells, expected);
  ASSERT_EQ(map.notes.size(), 1u);
  EXPECT_NE(map.notes[0].find("map.yaml': 2 of 12 cells are unknown and count as occupied"),
            std::string::npos);
}

TEST_F(RosMapFiles, ReadsWhatNav2Writes) {
  write("map.pgm", kPicture);
  const RosMap map = load_ros_map(
      write("map.yaml",
            "image: map.pgm\nmode: trinary\nresolution: 0.5\norigin: [-1, 2, 0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.25\n"));
  // 205 is (255 - 205) / 255 = 0.196, which is free below Nav2's threshold.
  EXPECT_EQ(map.grid.cells, (std::vector<std::uint8_t>{0, 0, 0, 1}));
  EXPECT_TRUE(map.notes.empty());
}

TEST_F(RosMapFiles, RoundTripIsExact) {
  RandomStream random(3, "", "map");
  OccupancyGrid grid;
  grid.columns = 173;
  grid.rows = 91;
  grid.cell_m = 0.1 / 3.0;
  grid.corner_W = {std::sqrt(2.0) * 1e3, -3.141592653589793};
  for (int k = 0; k < grid.columns * grid.rows; ++k) {
    grid.cells.push_back(random.uniform(0, 1) < 0.4 ? 1 : 0);
  }
  const std::filesystem::path file = folder_ / "round trip.yaml";
  save_ros_map(grid, file);
  const RosMap back = load_ros_map(file);
  EXPECT_EQ(back.grid.columns, grid.columns);
  EXPECT_EQ(back.grid.rows, grid.rows);
  EXPECT_EQ(back.grid.cell_m, grid.cell_m);
  EXPECT_EQ(back.grid.corner_W, grid.corner_W);
  EXPECT_EQ(back.grid.cells, grid.cells);
  EXPECT_TRUE(back.notes.empty());
  // The pixels are those of map_saver.
  const GrayImage image = read_pgm(folder_ / "round trip.pgm");
  EXPECT_EQ(image.values[0], grid.occupied(0, grid.rows - 1) ? 0 : 254);
}

TEST_F(RosMapFiles, ReadsTextPicturesOtherMaximaAndNegatedOnes) {
  const std::vector<std::uint8_t> expected = {1, 0, 0, 1};  // lower row, upper row
  EXPECT_EQ(load("P2 # a\n2 2 #b\n# c\n15\n15 0\n0 15\n").grid.cells, expected);
  EXPECT_EQ(load("P2\n2 2\n1\n0 1 1 0", "negate: 1\n").grid.cells, expected);
  EXPECT_EQ(load("P2\n2 2\n1\n0 1 1 0", "negate: true\n").grid.cells, expected);
  // Two bytes a pixel, the higher first: 1000 is white.
  const std::string wide("\x03\xe8\x00\x00\x00\x00\x03\xe8", 8);
  EXPECT_EQ(load("P5\n2 2\n1000\n" + wide).grid.cells, expected);
  // A binary picture whose first byte looks like a blank or a comment.
  const std::string odd = "P5\n2 1\n255\n#\n";
  EXPECT_EQ(load(odd).grid.cells, (std::vector<std::uint8_t>{1, 1}));
}

TEST_F(RosMapFiles, FaultsInTheYamlAreNamed) {
  const auto with = [&](const std::string& key, const std::string& value) {
    std::string text = kYaml;
    const std::size_t at = text.find(key + ":");
    const std::size_t end = text.find('\n', at);
    text.replace(at, end - at, value.empty() ? "x: 1" : key + ": " + value);
    return error_of(kPicture, text);
  };
  EXPECT_EQ(with("resolution", "-1"), "map.yaml:2: resolution = -1, must be > 0 m");
  EXPECT_EQ(with("resolution", "fine"), "map.yaml:2: resolution = 'fine', must be a finite number");
  EXPECT_EQ(with("resolution", ".nan"), "map.yaml:2: resolution = .nan, must be a finite number");
  EXPECT_EQ(with("resolution", ""), "ROS map 'map.yaml' has no key 'resolution'");
  EXPECT_EQ(with("origin", "[1, 2]"),
            "map.yaml:3: origin = a list, must be [x, y, yaw] in m and rad");
  EXPECT_EQ(with("origin", "[1, 2, 0.1]"),
            "map.yaml:3: origin's yaw = 0.1 rad, must be 0: rotated maps are not supported");
  EXPECT_EQ(with("free_thresh", "1.5"), "map.yaml:5: free_thresh = 1.5, must be >= 0 and <= 1");
  EXPECT_EQ(with("free_thresh", "0.7"),
            "ROS map 'map.yaml': free_thresh = 0.7 must not be above occupied_thresh = 0.65");
  EXPECT_EQ(with("image", "[]"), "map.yaml:1: image = a list, must be the name of a PGM file");
  EXPECT_EQ(with("image", "mop.pgm"),
            "map.yaml:1: image = 'mop.pgm': 'mop.pgm' does not exist; did you mean 'map.pgm'?");
  EXPECT_EQ(error_of(kPicture, kYaml + "negate: 2\n"), "map.yaml:6: negate = 2, must be 0 or 1");
  EXPECT_EQ(error_of(kPicture, kYaml + "mode: scale\n"),
            "map.yaml:6: mode = 'scale', must be 'trinary'");
  EXPECT_EQ(error_of(kPicture, "just a text\n"),
            "ROS map 'map.yaml' must be a mapping with image, resolution, origin");
  EXPECT_NE(error_of(kPicture, "a: [1\n").find("map.yaml:"), std::string::npos);
  EXPECT_THROW(load_ros_map(folder_ / "none.yaml"), ConfigError);
}

TEST_F(RosMapFiles, FaultsInThePictureAreNamed) {
  const auto with = [&](const std::string& picture) { return error_of(picture, kYaml); };
  EXPECT_EQ(with("\x89PNG\r\n"),
            "'map.pgm' is not a PGM image: it begins with '\\x89P', must begin with P5 or P2");
  EXPECT_EQ(with(""), "'map.pgm' is not a PGM image: it begins with '', must begin with P5 or P2");
  EXPECT_EQ(with("P6\n1 1\n255\nabc"),
            "'map.pgm' is not a PGM image: it begins with 'P6', must begin with P5 or P2");
  EXPECT_EQ(with("P5\n2 "), "'map.pgm' ends before its height");
  EXPECT_EQ(with("P5\n2 # no more"), "'map.pgm' ends before its height");
  EXPECT_EQ(with("P5\n-2 2\n255\n"),
            "'map.pgm' has no whole number as its width, but '-2 2\\x0a255'");
  EXPECT_EQ(with("P5\n0 2\n255\n"), "'map.pgm' has width = 0, must be 1 to 1000000");
  EXPECT_EQ(with("P5\n99999999999999999999 2\n255\n"),
            "'map.pgm' has width = 1000000000000, must be 1 to 1000000");
  EXPECT_EQ(with("P5\n900000 900000\n255\n"),
            "'map.pgm' has 900000 x 900000 pixels, must be at most 100 million");
  EXPECT_EQ(with("P5\n2 2\n70000\n"), "'map.pgm' has maximum = 70000, must be 1 to 65535");
  EXPECT_EQ(with("P5\n2 2\n255\nabc"),
            "'map.pgm' is cut off: 2 x 2 pixels are 4 bytes, it holds 3");
  EXPECT_EQ(with("P5\n9000 9000\n255\nabc"),
            "'map.pgm' is cut off: 9000 x 9000 pixels are 81000000 bytes, it holds 3");
  EXPECT_EQ(with("P5\n2 1\n100\nab\x7f"), "no error");
  EXPECT_EQ(with("P5\n2 1\n100\n\x7f "), "'map.pgm' has a pixel of 127, must be at most 100");
  EXPECT_EQ(with("P2\n2 2\n255\n1 2 3"), "'map.pgm' ends before its pixel");
  EXPECT_EQ(with("P2\n2 1\n9\n1 12"), "'map.pgm' has pixel = 12, must be 0 to 9");
  EXPECT_EQ(with("P2\n9000 9000\n9\n1 2"),
            "'map.pgm' is cut off: 9000 x 9000 pixels do not fit into its 18 bytes");
}

TEST_F(RosMapFiles, AFolderThatIsNotThereIsTold) {
  OccupancyGrid grid;
  grid.columns = grid.rows = 1;
  grid.cells = {0};
  try {
    save_ros_map(grid, folder_ / "none" / "map.yaml");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("map.pgm' cannot be written"), std::string::npos);
  }
}

}  // namespace
}  // namespace vinerow::io::ros_map_test
