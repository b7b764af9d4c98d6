#include "engine/io/clouds/point_cloud.h"

#include "engine/core/random.h"
#include "engine/io/clouds/point_cloud_writer.h"
#include "tests/engine/io/clouds/point_cloud_files.h"
#include "tests/support/heap.h"
#include "tests/support/no_alloc.h"

namespace vinerow::io::point_cloud_test {
namespace {

class PointCloud : public PointCloudFiles {
 protected:
  static std::vector<CloudPoint> cloud(int count) {
    RandomStream random(5, "", "cloud");
    std::vector<CloudPoint> points;
    for (int k = 0; k < count; ++k) {
      CloudPoint point;
      point.position = {random.uniform(500000, 500300), random.uniform(4649000, 4649300),
                        random.uniform(-5, 40)};
      const auto byte = [&] { return static_cast<std::uint8_t>(random.uniform(0, 256)); };
      point.rgb = {{byte(), byte(), byte()}};
      point.classification = static_cast<std::uint8_t>(k % 32);
      points.push_back(point);
    }
    return points;
  }
  static PointCloudWriterOptions options() {
    PointCloudWriterOptions all;
    all.has_colour = all.has_classification = true;
    all.las_offset = {500000, 4649000, 0};
    return all;
  }
  std::filesystem::path written(const std::string& name, const std::vector<CloudPoint>& points,
                                const PointCloudWriterOptions& how) const {
    const auto writer = create_point_cloud(folder_ / name, how);
    const std::size_t half = points.size() / 2;
    writer->write(std::span(points).first(half));
    writer->write(std::span(points).subspan(half));
    writer->finish();
    return folder_ / name;
  }
};

TEST_F(PointCloud, RoundTripsKeepEveryPoint) {
  const std::vector<CloudPoint> points = cloud(10'001);
  for (const std::string name : {"a.ply", "a.xyz", "a.las"}) {
    SCOPED_TRACE(name);
    const auto reader = open_point_cloud(written(name, points, options()));
    EXPECT_TRUE(reader->info().has_colour);
    EXPECT_TRUE(reader->info().has_classification);
    const std::vector<CloudPoint> back = points_of(*reader);
    ASSERT_EQ(back.size(), points.size());
    // LAS rounds to 1 mm; the others keep every bit.
    const double tolerance_m = name == "a.las" ? 0.5e-3 + 1e-9 : 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      ASSERT_LE((back[k].position - points[k].position).cwiseAbs().maxCoeff(), tolerance_m);
      ASSERT_EQ(*back[k].rgb, *points[k].rgb);
      ASSERT_EQ(back[k].classification, points[k].classification);
    }
    if (name != "a.xyz") {
      EXPECT_EQ(reader->info().record_count, 10'001u);
    }
  }
}

TEST_F(PointCloud, LasTellsItsBoundsAndCrs) {
  const std::vector<CloudPoint> points = cloud(100);
  PointCloudWriterOptions how = options();
  how.crs = "EPSG:25832";
  const auto reader = open_point_cloud(written("a.las", points, how));
  EXPECT_EQ(reader->info().crs, "EPSG:25832");
  std::vector<CloudPoint> back(points.size());
  ASSERT_EQ(reader->read(back), back.size());
  Eigen::AlignedBox3d bounds;
  for (const CloudPoint& point : back) bounds.extend(point.position);
  ASSERT_TRUE(reader->info().bounds);
  EXPECT_EQ(reader->info().bounds->min(), bounds.min());
  EXPECT_EQ(reader->info().bounds->max(), bounds.max());
  how.crs = "EPSG:4326";
  EXPECT_EQ(open_point_cloud(written("a.las", points, how))->info().crs, "EPSG:4326");
  how.crs = "EPSG:9999999";
  EXPECT_EQ(error_in([&] { written("a.las", points, how); }),
            "crs = 'EPSG:9999999' is not a coordinate reference system, must be like EPSG:32632");
  how.crs = "EPSG:5773";  // heights alone
  EXPECT_EQ(error_in([&] { written("a.las", points, how); }),
            "crs = 'EPSG:5773' must be the EPSG code of a geographic or projected system, like "
            "EPSG:32632");
}

TEST_F(PointCloud, EqualCloudsAreEqualFiles) {
  const std::vector<CloudPoint> points = cloud(100);
  for (const std::string extension : {".ply", ".xyz", ".las"}) {
    const auto bytes = [](const std::filesystem::path& file) {
      std::ifstream stream(file, std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    EXPECT_EQ(bytes(written("a" + extension, points, options())),
              bytes(written("b" + extension, points, options())));
  }
}

TEST_F(PointCloud, MemoryDoesNotGrowWithTheFile) {
  const std::vector<CloudPoint> points = cloud(200'000);
  std::string pcd =
      "VERSION .7\nFIELDS x y z i\nSIZE 8 8 8 8\nTYPE F F F F\nWIDTH 200000\nHEIGHT 1\n"
      "POINTS 200000\nDATA binary\n";
  pcd += std::string(200'000 * 32, '\0');
  std::vector<std::filesystem::path> files = {write("a.pcd", pcd)};
  for (const std::string name : {"a.ply", "a.xyz", "a.las"}) {
    files.push_back(written(name, points, options()));
  }
  for (const std::filesystem::path& file : files) {
    SCOPED_TRACE(file);
    ASSERT_GT(std::filesystem::file_size(file), kPointCloudMemory);
    const std::size_t before = vinerow::test::heap_bytes();
    const auto reader = open_point_cloud(file);
    const std::size_t after = vinerow::test::heap_bytes();
    EXPECT_LT(after, before + kPointCloudMemory);
    std::vector<CloudPoint> block(1000);
    std::size_t count = 0, total = 0, blocks = 0;
    const vinerow::test::AllocationCounter allocations;
    while ((count = reader->read(block)) > 0) {
      ASSERT_LE(count, block.size());
      total += count;
      ++blocks;
    }
    EXPECT_EQ(allocations.count(), 0u);
    EXPECT_EQ(total, points.size());
    EXPECT_EQ(blocks, 200u);
  }
}

TEST_F(PointCloud, FormatsAreKnownByTheirFirstBytes) {
  // A PLY file of another name is read as what it is.
  const std::vector<CloudPoint> points = cloud(3);
  const auto file = written("a.ply", points, options());
  std::filesystem::rename(file, folder_ / "a.las");
  EXPECT_EQ(open_point_cloud(folder_ / "a.las")->info().format, "PLY binary");
}

TEST_F(PointCloud, WhatIsNoPointCloudIsToldInOneSentence) {
  EXPECT_EQ(error_of("a.las", ""), "point cloud 'a.las' is empty (0 bytes)");
  EXPECT_EQ(error_of("a.xyz", ""), "point cloud 'a.xyz' is empty (0 bytes)");
  EXPECT_EQ(error_of("a.e57", "ASTM-E57"),
            "point cloud 'a.e57' has the unknown format '.e57', must be one of: .ply, .las, .pcd, "
            ".xyz, .csv, .txt, .asc, .pts");
  EXPECT_EQ(error_of("a.las", "PK\x03\x04zip"),
            "point cloud 'a.las' is not a LAS file: it begins with 'PK\\x03\\x04', must begin with "
            "LASF");
  EXPECT_EQ(error_of("a.ply", "plx"),
            "point cloud 'a.ply' is not a PLY file: it begins with 'plx', must begin with ply");
  EXPECT_EQ(
      error_of("a.pcd", "1 2 3"),
      "point cloud 'a.pcd' is not a PCD file: it begins with '1 2 ', must begin with # .PCD or "
      "VERSION");
  EXPECT_EQ(error_in([&] { open_point_cloud(folder_ / "b.las"); }),
            "point cloud 'b.las' does not exist; did you mean 'a.las'?");
  EXPECT_EQ(error_in([&] { open_point_cloud(folder_ / "."); }), "point cloud '.' is not a file");
}

TEST_F(PointCloud, WritersRefuseWhatTheyCannotHold) {
  CloudPoint point;
  point.position.z() = std::numeric_limits<double>::infinity();
  for (const std::string name : {"a.ply", "a.las", "a.xyz"}) {
    EXPECT_EQ(error_in([&] { written(name, {point}, {}); }),
              "point cloud '" + name + "' cannot hold a point that is not finite");
  }
  point.position = {0, -3e6, 0};
  EXPECT_EQ(error_in([&] { written("a.las", {point}, {}); }),
            "point cloud 'a.las' cannot hold y = -3000000: 32 bits of scale 0.001 reach from 0 by "
            "2147483.647");
  point.position = {0, 0, 0};
  point.classification = 32;
  EXPECT_EQ(error_in([&] { written("a.las", {point}, {}); }),
            "point cloud 'a.las' cannot hold the classification 32, LAS 1.2 has 0 to 31");
  PointCloudWriterOptions how;
  how.las_scale.x() = 0.0;
  EXPECT_EQ(error_in([&] { written("a.las", {}, how); }),
            "point cloud 'a.las' cannot have the LAS scale 0 and offset 0, must be finite and the "
            "scale > 0");
  EXPECT_EQ(error_in([&] { written("a.laz", {}, {}); }),
            "point cloud 'a.laz' cannot be written as '.laz', must be one of: .ply, .las, .xyz, "
            ".txt");
  EXPECT_EQ(error_in([&] { written("none/a.ply", {}, {}); }),
            "point cloud 'none/a.ply' cannot be written: No such file or directory");
}

TEST_F(PointCloud, BrokenBytesAreReadOrRefusedInWords) {
  const std::vector<CloudPoint> points = cloud(20);
  PointCloudWriterOptions how = options();
  how.crs = "EPSG:25832";
  const std::string pcd =
      "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nWIDTH 4\nHEIGHT 1\nPOINTS 4\n"
      "DATA binary\n" +
      std::string(64, '\x01');
  write("a.pcd", pcd);
  RandomStream random(9, "", "broken");
  for (const std::string name : {"a.ply", "a.las", "a.xyz", "a.pcd"}) {
    if (name != "a.pcd") written(name, points, how);
    std::ifstream stream(folder_ / name, std::ios::binary);
    const std::string whole(std::istreambuf_iterator<char>(stream), {});
    int refused = 0;
    for (int k = 0; k < 500; ++k) {
      std::string bytes = whole;
      // The header is what everything hangs on.
      const double reach = k % 2 ? 400.0 : static_cast<double>(whole.size());
      for (int n = 0; n < 1 + k % 3; ++n) {
        const std::size_t at = static_cast<std::size_t>(random.uniform(0, reach)) % whole.size();
        bytes[at] = static_cast<char>(static_cast<unsigned char>(random.uniform(0, 256)));
      }
      const std::string error = error_of("broken" + name.substr(1), bytes);
      if (error == "no error") continue;
      ++refused;
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
      EXPECT_NE(error.find("'broken" + name.substr(1) + "'"), std::string::npos) << error;
    }
    EXPECT_GT(refused, 25) << name;  // most bytes of a LAS header are free
  }
}

}  // namespace
}  // namespace vinerow::io::point_cloud_test
