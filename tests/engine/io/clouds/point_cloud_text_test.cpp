// PCD, and the text files of points.
#include <cmath>
#include <limits>

#include "tests/engine/io/clouds/point_cloud_files.h"

namespace vinerow::io::point_cloud_text_test {
namespace {

std::string pcd(const std::string& fields, const std::string& sizes, const std::string& types,
                int points, const std::string& data, const std::string& more = "") {
  return "# .PCD v.7 - Point Cloud Data file format\nVERSION .7\nFIELDS " + fields + "\nSIZE " +
         sizes + "\nTYPE " + types + "\n" + more + "WIDTH " + std::to_string(points) +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA " +
         data + "\n";
}

class PcdFiles : public PointCloudFiles {};

TEST_F(PcdFiles, ReadsText) {
  // The layout of the example in PCL's documentation, whose colour is the float with the bits
  // 0x4a808080 (4210752 = 2^22 (1 + 0x8080 / 2^23)).
  const auto reader = open_point_cloud(
      write("a.pcd", pcd("x y z rgb", "4 4 4 4", "F F F F", 3, "ascii", "COUNT 1 1 1 1\n") +
                         "0.93773 0.33763 0 4.210752e+06\nnan nan nan 4.2108e+06\n1 2 3 nan\n"));
  EXPECT_EQ(reader->info().format, "PCD ascii");
  EXPECT_EQ(reader->info().record_count, 3u);
  EXPECT_TRUE(reader->info().has_colour);
  const std::vector<CloudPoint> points = points_of(*reader);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(shown(points[0]), "0.93773 0.33763 0 128 128 128 -1");
  EXPECT_EQ(shown(points[1]), "1 2 3 -1 -1 -1 -1");
  EXPECT_EQ(reader->tally().not_finite, 1u);
}

TEST_F(PcdFiles, ReadsWholeColoursLabelsAndOtherFields) {
  const std::vector<CloudPoint> points =
      read("a.pcd", pcd("normal z y x rgba label", "4 8 4 4 4 4", "F F F F U U", 2, "ascii",
                        "COUNT 3 1 1 1 1 1\n") +
                        "0 0 1 3.25 2 1 4278255361 5\n0 0 1 3 2 1 16711680 70000\n");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(shown(points[0]), "1 2 3.25 0 255 1 5");  // 0xff00ff01
  EXPECT_EQ(shown(points[1]), "1 2 3 255 0 0 -1");
}

TEST_F(PcdFiles, ReadsBytes) {
  std::string text =
      pcd("x _ y z rgb label", "4 1 8 2 4 1", "F U F I F U", 2, "binary", "COUNT 1 3 1 1 1 1\n");
  for (const double s : {1.0, -1.0}) {
    text += bytes_of(static_cast<float>(0.5 * s)) + "\x01\x02\x03" + bytes_of(1e7 * s);
    text += bytes_of(static_cast<std::int16_t>(300 * s)) + bytes_of(std::uint32_t{0xff0a141e});
    text += bytes_of(std::uint8_t{9});
  }
  const std::vector<CloudPoint> points = read("a.pcd", text);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(shown(points[0]), "0.5 1e+07 300 10 20 30 9");
  EXPECT_EQ(shown(points[1]), "-0.5 -1e+07 -300 10 20 30 9");
  EXPECT_EQ(error_of("a.pcd", text.substr(0, text.size() - 1)),
            "point cloud 'a.pcd' is cut off: its header counts 2 points, it holds 1");
  EXPECT_EQ(error_of("a.pcd", text + std::string(22, 'a')),
            "point cloud 'a.pcd' has more data than its header counts: 2 points, it holds 3");
  for (std::size_t bytes = 0; bytes < text.size(); ++bytes) {
    EXPECT_NE(error_of("a.pcd", text.substr(0, bytes)), "no error") << bytes;
  }
}

TEST_F(PcdFiles, FaultsAreNamed) {
  const auto error = [&](const std::string& text) { return error_of("a.pcd", text); };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = pcd("x y z", "4 4 4", "F F F", 2, "ascii") + "1 2 3\n4 5 6\n";
    text.replace(text.find(from), from.size(), to);
    return error(text);
  };
  EXPECT_EQ(with("VERSION", "VERSION"), "no error");
  EXPECT_EQ(error(pcd("x y z", "4 4 4", "F F F", 2, "binary_compressed")),
            "point cloud 'a.pcd' is compressed (DATA binary_compressed), which is not supported; "
            "decompress it first, with 'pcl_convert_pcd_ascii_binary in.pcd out.pcd 1'");
  EXPECT_EQ(with("DATA ascii", "DATA hex"),
            "point cloud 'a.pcd' has DATA hex, must be ascii or binary");
  EXPECT_EQ(with("DATA ascii\n", ""),
            "point cloud 'a.pcd' has the unknown word '1' in line 10 of its header");
  EXPECT_EQ(error("# .PCD v.7\nVERSION .7\n"),
            "point cloud 'a.pcd' is cut off: its header has no line DATA");
  EXPECT_EQ(with("FIELDS x y z", "FIELDS x y"),
            "point cloud 'a.pcd' has 2 FIELDS but 3 words after SIZE");
  EXPECT_EQ(with("FIELDS x y z\n", ""), "point cloud 'a.pcd' has no FIELDS in its header");
  EXPECT_EQ(with("FIELDS x y z", "FIELDS x y t"), "point cloud 'a.pcd' has no field 'z'");
  EXPECT_EQ(with("SIZE 4 4 4", "SIZE 4 4 3"),
            "point cloud 'a.pcd' has a field of TYPE F and SIZE 3, must be I or U with 1, 2, 4, 8 "
            "or F with 4, 8");
  EXPECT_EQ(with("POINTS 2", "POINTS 3"),
            "point cloud 'a.pcd' has POINTS 3, but WIDTH 2 and HEIGHT 1");
  EXPECT_EQ(with("WIDTH 2", "WIDTH -2"),
            "point cloud 'a.pcd' has WIDTH = '-2', must be a whole number >= 0");
  EXPECT_EQ(with("WIDTH 2", "WIDTH 9000000000"),
            "point cloud 'a.pcd' has WIDTH 9000000000 and HEIGHT 1, must be at most 2147483648");
  EXPECT_EQ(with("TYPE", "COUNT 1 1 9000000\nTYPE"),
            "point cloud 'a.pcd' has COUNT = 9000000, must be at most 262144");
  EXPECT_EQ(with("5 6", "5 six"),
            "point cloud 'a.pcd' has 'six' as z in line 12, must be a number");
  EXPECT_EQ(with("4 5 6\n", ""),
            "point cloud 'a.pcd' is cut off: its header counts 2 points, it holds 1");
  EXPECT_EQ(with("4 5 6", "4 5 6\n7 8 9"),
            "point cloud 'a.pcd' has more data than its header counts: 2 points, then line 13");
}

class XyzFiles : public PointCloudFiles {};

TEST_F(XyzFiles, ReadsPlainNumbers) {
  const auto reader = open_point_cloud(
      write("a.xyz", "# a survey of x y z\n\n500000.125  4649776.0625\t-1.5\r\n  1 +2 3e0 \n"));
  EXPECT_EQ(reader->info().format, "XYZ");
  EXPECT_FALSE(reader->info().record_count);
  EXPECT_FALSE(reader->info().has_colour);
  const std::vector<CloudPoint> points = points_of(*reader);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].position, Eigen::Vector3d(500000.125, 4649776.0625, -1.5));
  EXPECT_EQ(shown(points[1]), "1 2 3 -1 -1 -1 -1");
}

TEST_F(XyzFiles, ReadsColumnsByTheirNames) {
  const std::string rows = "1,2,3,0.5,10,20,30,2\n4,5,6,0.5,11,21,31,5\n";
  for (const std::string head :
       {"X,Y,Z,Intensity,R,G,B,Classification\n", "//x,y,z,i,Red,Green,Blue,class\n",
        "# Easting,Northing,Height,time,r,g,b,\"label\"\n"}) {
    const std::vector<CloudPoint> points = read("a.csv", head + rows);
    ASSERT_EQ(points.size(), 2u) << head;
    EXPECT_EQ(shown(points[0]), "1 2 3 10 20 30 2") << head;
    EXPECT_EQ(shown(points[1]), "4 5 6 11 21 31 5") << head;
  }
  // Another order, semicolons, empty fields of no interest.
  const std::vector<CloudPoint> points = read("a.csv", "z;note;x;y\n3;;1;2;\n6; a b ;4;5\n");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(shown(points[0]), "1 2 3 -1 -1 -1 -1");
  EXPECT_EQ(shown(points[1]), "4 5 6 -1 -1 -1 -1");
}

TEST_F(XyzFiles, GuessesColoursFromWholeNumbersAlone) {
  EXPECT_EQ(shown(read("a.txt", "1 2 3 0 128 255\n")[0]), "1 2 3 0 128 255 -1");
  EXPECT_EQ(shown(read("a.txt", "1 2 3 0.0 0.6 0.8\n")[0]), "1 2 3 -1 -1 -1 -1");
  EXPECT_EQ(shown(read("a.txt", "1 2 3 10 20\n")[0]), "1 2 3 -1 -1 -1 -1");
  // PTS: the count, then an intensity before the colour.
  const auto reader = open_point_cloud(write("a.pts", "2\n1 2 3 -900 1 2 3\n4 5 6 80 4 5 6\n"));
  EXPECT_EQ(reader->info().record_count, 2u);
  EXPECT_EQ(shown(points_of(*reader)[1]), "4 5 6 4 5 6 -1");
}

TEST_F(XyzFiles, LeavesOutWhatIsNotFinite) {
  const auto reader = open_point_cloud(write("a.xyz", "1 2 3\nNaN 2 3\n1 2 -Inf\n1 1e400 3\n"));
  EXPECT_EQ(points_of(*reader).size(), 1u);
  EXPECT_EQ(reader->tally().not_finite, 3u);
}

TEST_F(XyzFiles, FaultsAreNamed) {
  const auto error = [&](const std::string& text) { return error_of("a.xyz", text); };
  EXPECT_EQ(error("1 2 3\n4 5\n"),
            "point cloud 'a.xyz' has 2 columns in line 2, must have at least 3");
  EXPECT_EQ(error("# x y z\n1 2 3\n4 five 6\n"),
            "point cloud 'a.xyz' has 'five' as y in line 3, must be a number");
  EXPECT_EQ(error("1,2,3\n4,,6\n"), "point cloud 'a.xyz' has '' as y in line 2, must be a number");
  EXPECT_EQ(error("1,5;2,5;3,5\n"),
            "point cloud 'a.xyz' has '1,5;2,5;3,5' in line 1, must be numbers or the names of "
            "columns with x, y and z");
  EXPECT_EQ(error("a b c\n1 2 3\n"),
            "point cloud 'a.xyz' has 'a b c' in line 1, must be numbers or the names of columns "
            "with x, y and z");
  EXPECT_EQ(error(std::string("\x89PNG\r\n\x1a\n\0", 9)),
            "point cloud 'a.xyz' has '\\x89PNG' in line 1, must be numbers or the names of columns "
            "with x, y and z");
  EXPECT_EQ(error("1 2 3 0 0 0\n1 2 3 0 0.5 0\n"),
            "point cloud 'a.xyz' has green = 0.5 in line 2, must be a whole number from 0 to 255");
  EXPECT_EQ(error("# nothing\n\n"), "point cloud 'a.xyz' has no line of points");
  EXPECT_EQ(error("x y z\n"), "point cloud 'a.xyz' has no line of points");
  EXPECT_EQ(error("3\n1 2 3\n4 5 6\n"),
            "point cloud 'a.xyz' is cut off: its first line counts 3 points, it holds 2");
  EXPECT_EQ(error("1\n1 2 3\n4 5 6\n"),
            "point cloud 'a.xyz' has more data than its first line counts: 1 points, then line 3");
}

}  // namespace
}  // namespace vinerow::io::point_cloud_text_test
