#include "tests/fuzz/cloud_seeds.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

#include "engine/io/clouds/point_cloud_writer.h"

namespace vinerow::fuzz {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class T>
std::string bytes_of(T value, bool big_endian = false) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return {bytes.data(), bytes.size()};
}

std::string padded(std::string text, std::size_t bytes) {
  text.resize(bytes, '\0');
  return text;
}

std::string read_and_remove(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  stream.close();
  std::filesystem::remove(file);
  return bytes;
}

void add_written(const std::filesystem::path& folder, std::vector<CloudSeed>& seeds) {
  std::vector<io::CloudPoint> points(5);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto t = static_cast<double>(k);
    points[k].position = {500000.0 + t, 4649000.0 + 0.5 * t * t, 120.25 - t};
    points[k].rgb = {{static_cast<std::uint8_t>(50 * k), 255, 0}};
    points[k].classification = static_cast<std::uint8_t>(k);
  }
  const auto add = [&](const std::string& name, CloudKind kind,
                       const io::PointCloudWriterOptions& options) {
    const auto writer = io::create_point_cloud(folder / name, options);
    writer->write(points);
    writer->finish();
    seeds.push_back({name, kind, read_and_remove(folder / name)});
  };
  for (const bool rich : {false, true}) {
    io::PointCloudWriterOptions options;
    options.has_colour = options.has_classification = rich;
    options.las_offset = {500000, 4649000, 0};
    const std::string suffix = rich ? "_rich" : "_plain";
    add("written" + suffix + ".ply", CloudKind::kPly, options);
    add("written" + suffix + ".xyz", CloudKind::kXyz, options);
    if (rich) options.crs = "EPSG:25832";
    add("written" + suffix + ".las", CloudKind::kLas, options);
  }
}

std::string record(bool extended, const std::string& user, std::uint16_t id,
                   const std::string& data) {
  const std::string length = extended ? bytes_of(std::uint64_t{data.size()})
                                      : bytes_of(static_cast<std::uint16_t>(data.size()));
  return padded("", 2) + padded(user, 16) + bytes_of(id) + length + padded("", 32) + data;
}

/// LAS 1.4-R15, table 3; two points of zeros, the second withheld.
std::string las_by_hand(int minor, int format, std::size_t point_bytes, const std::string& records,
                        std::uint32_t record_count, const std::string& extended) {
  const std::size_t own = minor == 2 ? 227 : minor == 3 ? 235 : 375;
  std::string points(2 * point_bytes, '\0');
  points[point_bytes + 15] = static_cast<char>(format >= 6 ? 0x04 : 0x80);
  std::string b = "LASF" + padded("", 2);
  b += bytes_of(static_cast<std::uint16_t>(format >= 6 ? 0x10 : 0)) + padded("", 16);
  b += bytes_of(std::uint8_t{1}) + bytes_of(static_cast<std::uint8_t>(minor));
  b += padded("by hand", 64) + padded("", 4) + bytes_of(static_cast<std::uint16_t>(own));
  b += bytes_of(static_cast<std::uint32_t>(own + records.size())) + bytes_of(record_count);
  b += bytes_of(static_cast<std::uint8_t>(format));
  b += bytes_of(static_cast<std::uint16_t>(point_bytes));
  b += bytes_of(std::uint32_t{minor == 4 ? 0u : 2u}) + padded("", 20);
  for (int k = 0; k < 3; ++k) b += bytes_of(0.01);
  for (const double offset : {500000.0, 4649000.0, -10.0}) b += bytes_of(offset);
  for (const double bound : {500001.0, 500000.0, 4649002.0, 4649000.0, 3.0, -10.0}) {
    b += bytes_of(bound);
  }
  if (minor >= 3) b += bytes_of(std::uint64_t{0});
  if (minor >= 4) {
    const std::uint64_t at = extended.empty() ? 0 : own + records.size() + points.size();
    b += bytes_of(at) + bytes_of(std::uint32_t{extended.empty() ? 0u : 1u});
    b += bytes_of(std::uint64_t{2}) + padded("", 120);
  }
  return b + records + points + extended;
}

void add_las(std::vector<CloudSeed>& seeds) {
  const auto add = [&](const std::string& name, const std::string& bytes) {
    seeds.push_back({name + ".las", CloudKind::kLas, bytes});
  };
  std::string keys;  // of a projected and a vertical system
  for (const std::uint16_t value : {1, 1, 0, 2, 3072, 0, 1, 25832, 4096, 0, 1, 7837}) {
    keys += bytes_of(value);
  }
  const std::string projection = record(false, "LASF_Projection", 34735, keys);
  const std::string wkt = "GEOGCS[\"WGS 84\",AUTHORITY[\"EPSG\",\"4326\"]]";
  add("keys", las_by_hand(2, 0, 20, projection, 1, ""));
  add("waveforms", las_by_hand(3, 5, 63, "", 0, ""));
  add("extra_bytes",
      las_by_hand(2, 3, 40, record(false, "someone", 7, "data") + projection, 2, ""));
  add("wkt", las_by_hand(4, 7, 36, record(false, "LASF_Projection", 2112, wkt), 1, ""));
  add("extended", las_by_hand(4, 10, 67, "", 0, record(true, "LASF_Projection", 2112, wkt)));
  add("laszip", las_by_hand(2, 1, 28, record(false, "laszip encoded", 22204, "zipped"), 1, ""));
  std::string broken = las_by_hand(2, 0, 20, projection, 1, "");
  broken.replace(131, 8, bytes_of(kNan));  // scale of x
  add("scale_nan", broken);
  broken = las_by_hand(4, 6, 30, "", 0, "");
  broken.replace(247, 8, bytes_of(~std::uint64_t{0}));  // count
  add("count_huge", broken);
}

void add_ply(std::vector<CloudSeed>& seeds) {
  const auto add = [&](const std::string& name, const std::string& bytes) {
    seeds.push_back({name + ".ply", CloudKind::kPly, bytes});
  };
  add("text",
      "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\nelement face 1\n"
      "property list uchar int vertex_indices\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nproperty list uchar float other\n"
      "property float red\nproperty float green\nproperty float blue\nproperty int label\n"
      "end_header\n3 0 1 2\n1 2 3 0 0 0.5 1 2\nnan inf -1e999 1 7 0.25 1 0 300\n\n"
      "4 5 6 2 8 9 0 0 0 -1\n");
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\r\nelement camera 2\r\nproperty list ushort short pixels\r\n"
                        "property double focus\r\nelement vertex 2\r\nproperty list char uint "
                        "other\r\nproperty double x\r\nproperty short y\r\nproperty uint z\r\n"
                        "end_header\r\n";
    for (int k = 0; k < 2; ++k) {
      bytes += bytes_of(static_cast<std::uint16_t>(k), big);
      for (int j = 0; j < k; ++j) bytes += bytes_of(std::int16_t{-3}, big);
      bytes += bytes_of(50.0, big);
    }
    for (int k = 0; k < 2; ++k) {
      bytes += bytes_of(static_cast<std::int8_t>(k));
      for (int j = 0; j < k; ++j) bytes += bytes_of(std::uint32_t{9}, big);
      bytes += bytes_of(k == 0 ? 1.5 : kNan, big) + bytes_of(std::int16_t{-7}, big);
      bytes += bytes_of(std::uint32_t{4000000000u}, big);
    }
    add(big ? "lists_big" : "lists_little", bytes);
  }
  std::string plain =
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"
      "property float y\nproperty float z\nproperty ushort red\n"
      "property ushort green\nproperty ushort blue\nproperty uchar class\n"
      "element face 0\nproperty list uchar int vertex_indices\nend_header\n";
  for (int k = 0; k < 6; ++k) {
    plain += bytes_of(static_cast<float>(k));
    if (k % 3 == 2) plain += padded("\x01\x02\x03\x04\x05\x06\x07", 7);
  }
  add("plain_float", plain);
  add("count_huge",
      "ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n123456789012");
  add("empty_element",
      "ply\nformat ascii 1.0\nelement nothing 9999999999999\nelement vertex 1\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n1 2 3");
}

void add_pcd(std::vector<CloudSeed>& seeds) {
  const auto add = [&](const std::string& name, const std::string& bytes) {
    seeds.push_back({name + ".pcd", CloudKind::kPcd, bytes});
  };
  add("text",
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb label\n"
      "SIZE 4 4 4 4 2\nTYPE F F F F U\nCOUNT 1 1 1 1 1\nWIDTH 3\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA ascii\n1 2 3 4.2108e+06 2\nnan nan nan nan 0\n"
      "-1e-400 1e400 5 0 256\n");
  std::string bytes =
      "# .PCD v.7 - Point Cloud Data file format\nVERSION .7\nFIELDS normal x y z rgba "
      "classification\nSIZE 4 8 8 4 4 1\nTYPE F F F F U I\nCOUNT 3 1 1 1 1 1\nWIDTH 1\n"
      "HEIGHT 2\nPOINTS 2\nDATA binary\n";
  for (int k = 0; k < 2; ++k) {
    bytes += padded("", 12) + bytes_of(1.25) + bytes_of(k == 0 ? -7.5 : kNan) + bytes_of(3.0f);
    bytes += bytes_of(std::uint32_t{0xff102030}) + bytes_of(static_cast<std::int8_t>(-k));
  }
  add("binary", bytes);
  add("columns",
      "VERSION 0.6\nCOLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n+1 2. "
      ".3");
  add("compressed",
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\n"
      "DATA binary_compressed\nabcdefgh");
  add("count_huge",
      "VERSION 0.7\nFIELDS x y z pad\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 0\n"
      "WIDTH 2147483648\nHEIGHT 2147483648\nDATA binary\n123456789012");
}

void add_xyz(std::vector<CloudSeed>& seeds) {
  const auto add = [&](const std::string& name, const std::string& bytes) {
    seeds.push_back({name + ".xyz", CloudKind::kXyz, bytes});
  };
  add("names", "// easting;northing;height;R;G;B;class\n1;2;3;0;128;255;2\n\n4;5;6;1;2;3;5;\n");
  add("pts", "2\n1.5 -2.5 3.5 -1024 10 20 30\r\n1e3 +2 3 100 0 0 0\r\n");
  add("commas", "# a comment\nx,\"y\",z,intensity\n1,2,3,4\nnan,inf,-inf,0\n 7 , 8 , 9 ,\n");
  add("odd", "1e308 -1e-308 1e999 256 0 0\n\t.5\v-.5\f5. 1 2 3");
}

}  // namespace

std::vector<CloudSeed> cloud_seeds(const std::filesystem::path& folder) {
  std::vector<CloudSeed> seeds;
  add_written(folder, seeds);
  add_las(seeds);
  add_ply(seeds);
  add_pcd(seeds);
  add_xyz(seeds);
  return seeds;
}

}  // namespace vinerow::fuzz
