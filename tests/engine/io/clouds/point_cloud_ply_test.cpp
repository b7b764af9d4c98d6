#include "engine/io/clouds/point_cloud_ply.h"

#include <cmath>
#include <limits>

#include "tests/engine/io/clouds/point_cloud_files.h"

namespace vinerow::io::point_cloud_ply_test {
namespace {

using Ply = PointCloudFiles;

TEST_F(Ply, ReadsTextWithOtherElementsAndListsAround) {
  const std::string text =
      "ply\nformat ascii 1.0\ncomment made by hand\nobj_info none\n"
      "element camera 2\nproperty float focal\nproperty list uchar int ids\n"
      "element vertex 3\nproperty float nx\nproperty double y\nproperty double x\n"
      "property list uint8 float32 extra\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int label\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "35 2 7 8\n50 0\n"
      "0 2.25 1.5 0 -3 255 0 10 2\n"
      "\n"
      "0 500000.125 4649776.0625 3 7 7 7 1e1 1 2 3 -1\n"
      "0 +2.25 15e-1 1 9 -3.0 0 0 0 4\r\n"
      "3 0 1 2\n";
  const auto reader = open_point_cloud(write("a.ply", text));
  EXPECT_EQ(reader->info().format, "PLY ascii");
  EXPECT_EQ(reader->info().record_count, 3u);
  EXPECT_TRUE(reader->info().has_colour);
  EXPECT_TRUE(reader->info().has_classification);
  EXPECT_EQ(reader->info().crs, "");
  const std::vector<CloudPoint> points = points_of(*reader);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(shown(points[0]), "1.5 2.25 -3 255 0 10 2");
  EXPECT_EQ(points[1].position, Eigen::Vector3d(4649776.0625, 500000.125, 10.0));
  EXPECT_FALSE(points[1].classification);  // -1 is no class of LAS
  EXPECT_EQ(shown(points[2]), "1.5 2.25 -3 0 0 0 4");
}

/// A camera with a list, two vertices (float x y z, ushort colours, a list), one face.
std::string binary_ply(std::endian order) {
  const auto put = [&](auto value) { return bytes_of(value, order); };
  std::string text = std::string("ply\nformat binary_") +
                     (order == std::endian::little ? "little" : "big") +
                     "_endian 1.0\n"
                     "element camera 1\nproperty list ushort double ids\n"
                     "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
                     "property list uchar short extra\n"
                     "property ushort red\nproperty ushort green\nproperty ushort blue\n"
                     "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  text += put(std::uint16_t{2}) + put(1.0) + put(2.0);
  text += put(1.5f) + put(-2.0f) + put(0.25f) + put(std::uint8_t{1}) + put(std::int16_t{-5});
  text += put(std::uint16_t{65535}) + put(std::uint16_t{0}) + put(std::uint16_t{257});
  text += put(8.0f) + put(16.0f) + put(32.0f) + put(std::uint8_t{0});
  text += put(std::uint16_t{514}) + put(std::uint16_t{1}) + put(std::uint16_t{65534});
  return text + put(std::uint8_t{1}) + put(std::int32_t{0});
}

TEST_F(Ply, ReadsBothByteOrders) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const std::vector<CloudPoint> points = read("b.ply", binary_ply(order));
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(shown(points[0]), "1.5 -2 0.25 255 0 1 -1");
    EXPECT_EQ(shown(points[1]), "8 16 32 2 0 255 -1");
  }
}

TEST_F(Ply, ReadsEveryTypeOfNumber) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\n"
      "property char x\nproperty short y\nproperty int z\n"
      "property float32 red\nproperty float32 green\nproperty float32 blue\n"
      "property uint class\nend_header\n";
  text += bytes_of(std::int8_t{-7}) + bytes_of(std::int16_t{-300}) + bytes_of(-70000) +
          bytes_of(1.0f) + bytes_of(0.0f) + bytes_of(0.5f) + bytes_of(std::uint32_t{6});
  const std::vector<CloudPoint> points = read("types.ply", text);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(shown(points[0]), "-7 -300 -70000 255 0 128 6");
}

TEST_F(Ply, LeavesOutWhatIsNotFiniteAndKeepsEqualPoints) {
  const auto reader = open_point_cloud(
      write("nan.ply",
            "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\n"
            "property float z\nend_header\n"
            "1 2 3\nnan 2 3\n1 inf 3\n1 2 -inf\n1 2 1e999\n1 2 3\n1 2 1e-999\n"));
  const std::vector<CloudPoint> points = points_of(*reader);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0].position, points[1].position);
  EXPECT_EQ(points[2].position.z(), 0.0);
  EXPECT_EQ(reader->tally().given, 3u);
  EXPECT_EQ(reader->tally().not_finite, 4u);
}

const std::string kHead = "ply\nformat ascii 1.0\n";
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

TEST_F(Ply, FaultsInTheHeaderAreNamed) {
  const auto with = [&](const std::string& text) { return error_of("a.ply", text); };
  EXPECT_EQ(with("ply\n"), "point cloud 'a.ply' is cut off: its header has no end_header");
  EXPECT_EQ(with("ply\nelement vertex 0\n" + kXyz + "end_header\n"),
            "point cloud 'a.ply' has no line 'format' in its header");
  EXPECT_EQ(with("ply\nformat text 1.0\n"),
            "point cloud 'a.ply' has the format 'text', must be ascii, binary_little_endian or "
            "binary_big_endian");
  EXPECT_EQ(with("ply\nformat ascii 2.0\n"), "point cloud 'a.ply' is PLY '2.0', must be 1.0");
  EXPECT_EQ(with(kHead + "element vertex many\n"),
            "point cloud 'a.ply' has 'many' as the count of the element 'vertex', must be a whole "
            "number >= 0");
  EXPECT_EQ(with(kHead + "element vertex -1\n"),
            "point cloud 'a.ply' has '-1' as the count of the element 'vertex', must be a whole "
            "number >= 0");
  EXPECT_EQ(with(kHead + "property float x\n"),
            "point cloud 'a.ply' has a property before the first element in line 3");
  EXPECT_EQ(with(kHead + "element vertex 1\nproperty half x\n"),
            "point cloud 'a.ply' has the unknown type 'half' in line 4");
  EXPECT_EQ(with(kHead + "element vertex 1\nproperty float\n"),
            "point cloud 'a.ply' has a property without name in line 4");
  EXPECT_EQ(with(kHead + "element vertex 1\nproperty list float int x\n"),
            "point cloud 'a.ply' has a list counted by real numbers in line 4");
  EXPECT_EQ(with(kHead + "\x1b[31m\n"),
            "point cloud 'a.ply' has the unknown word '\\x1b[31m' in line 3 of its header");
  EXPECT_EQ(with(kHead + "element face 0\nend_header\n"),
            "point cloud 'a.ply' has no element 'vertex'");
  EXPECT_EQ(with(kHead + "element vertex 0\nproperty float x\nproperty float y\nend_header\n"),
            "point cloud 'a.ply' has no property 'z' of its vertices");
  EXPECT_EQ(with(kHead + "element vertex 0\n" + kXyz + "property float x\nend_header\n"),
            "point cloud 'a.ply' has the property 'x' twice");
  EXPECT_EQ(with(kHead + std::string(300'000, 'x')),
            "point cloud 'a.ply' has a line longer than 262144 bytes: line 3");
  std::string comments = kHead;
  for (int k = 0; k < 200; ++k) comments += "comment " + std::string(9'000, 'x') + "\n";
  EXPECT_EQ(with(comments),
            "point cloud 'a.ply' has no PLY header: no end_header within 10000 lines and 1048576 "
            "bytes");
}

TEST_F(Ply, WrongCountsAreToldWithBothNumbers) {
  const std::string text = kHead + "element vertex 3\n" + kXyz + "end_header\n1 2 3\n4 5 6\n";
  EXPECT_EQ(error_of("a.ply", text),
            "point cloud 'a.ply' is cut off: its header counts 3 points, it holds 2");
  EXPECT_EQ(error_of("a.ply", text + "7 8 9\n"), "no error");
  EXPECT_EQ(error_of("a.ply", text + "7 8 9\n\n1 1 1\n"),
            "point cloud 'a.ply' has more data than its header counts: 3 points, then line 12");
  EXPECT_EQ(error_of("a.ply", text + "7 8\n"),
            "point cloud 'a.ply' has '' as z in line 10, must be a number");
  EXPECT_EQ(error_of("a.ply", text + "7 8 0x10\n"),
            "point cloud 'a.ply' has '0x10' as z in line 10, must be a number");

  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\n" + kXyz +
      "end_header\n";
  EXPECT_EQ(error_of("b.ply", head + std::string(25, '\0')),
            "point cloud 'b.ply' is cut off: its header counts 18446744073709551615 points, it "
            "holds 2");
  const std::string one =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + kXyz + "end_header\n";
  EXPECT_EQ(error_of("b.ply", one + std::string(24, '\0')),
            "point cloud 'b.ply' has more data than its header counts: 1 points, it holds 2");
  const std::string whole = binary_ply(std::endian::big);
  for (std::size_t bytes = 0; bytes < whole.size() - 5; ++bytes) {
    EXPECT_NE(error_of("b.ply", whole.substr(0, bytes)), "no error") << bytes;
  }
  EXPECT_EQ(error_of("b.ply", whole.substr(0, whole.size() - 6)),
            "point cloud 'b.ply' is cut off: its header counts 2 points, it holds 1");
}

TEST_F(Ply, ListsAndElementsOfImpossibleLengthEnd) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement camera 9000000000000000000\n"
      "property list int double ids\nelement vertex 0\n" +
      kXyz + "end_header\n";
  EXPECT_EQ(error_of("a.ply", head + bytes_of(2'000'000'000)),
            "point cloud 'a.ply' is cut off: its header counts 9000000000000000000 of the element "
            "'camera', it holds 0");
  EXPECT_EQ(error_of("a.ply", head + bytes_of(-1)),
            "point cloud 'a.ply' has a list 'ids' of -1 values in 'camera' 1");
  const std::string empty =
      "ply\nformat binary_little_endian 1.0\nelement camera 9000000000000000000\n"
      "element vertex 0\n" +
      kXyz + "end_header\n";
  EXPECT_EQ(error_of("a.ply", empty), "no error");
}

TEST_F(Ply, ColoursBeyondTheirTypeAreNamed) {
  EXPECT_EQ(error_of("a.ply", kHead + "element vertex 1\n" + kXyz +
                                  "property float red\nproperty float green\n"
                                  "property float blue\nend_header\n0 0 0 1 0 200\n"),
            "point cloud 'a.ply' has a colour of 200 at point 1, must be 0 to 1");
}

}  // namespace
}  // namespace vinerow::io::point_cloud_ply_test
