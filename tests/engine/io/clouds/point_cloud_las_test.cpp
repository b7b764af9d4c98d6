#include "engine/io/clouds/point_cloud_las.h"

#include <cmath>
#include <limits>

#include "tests/engine/io/clouds/point_cloud_files.h"

namespace vinerow::io::point_cloud_las_test {
namespace {

using Las = PointCloudFiles;

/// A point as the tables of the specification lay it out, field by field.
struct HandPoint {
  std::int32_t x = 0, y = 0, z = 0;
  int classification = 0;
  bool is_withheld = false;
  std::array<std::uint16_t, 3> rgb{};
};

/// LAS 1.4-R15, tables 7 to 17 (formats 0 to 10).
std::string hand_point(int format, const HandPoint& p, int extra_bytes = 0) {
  Bytes b;
  b.put(p.x).put(p.y).put(p.z).put(std::uint16_t{777});  // intensity
  const auto classification = static_cast<std::uint8_t>(p.classification);
  if (format < 6) {
    b.put(std::uint8_t{0x49});  // returns, scan flags
    b.put(static_cast<std::uint8_t>(classification | (p.is_withheld ? 0x80 : 0)));
    b.put(std::int8_t{-9}).put(std::uint8_t{1}).put(std::uint16_t{5});  // angle, user, source
    if (format == 1 || format >= 3) b.put(1234.5);                      // GPS time
  } else {
    b.put(std::uint8_t{0x11}).put(static_cast<std::uint8_t>(p.is_withheld ? 0x04 : 0));
    b.put(classification).put(std::uint8_t{1}).put(std::int16_t{-900});  // user, angle
    b.put(std::uint16_t{5}).put(1234.5);                                 // source, GPS time
  }
  if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10) {
    for (const std::uint16_t c : p.rgb) b.put(c);
  }
  if (format == 8 || format == 10) b.put(std::uint16_t{9999});  // near infrared
  if (format == 4 || format == 5 || format == 9 || format == 10) {
    b.put(std::uint8_t{1}).put(std::uint64_t{60}).put(std::uint32_t{256});  // waveform packet
    b.put(1.0f).put(0.1f).put(0.2f).put(0.3f);
  }
  return b.text + std::string(static_cast<std::size_t>(extra_bytes), '\x7f');
}

struct HandFile {
  int minor = 2;
  int format = 0;
  std::vector<std::string> points;
  std::vector<std::string> records;  // whole variable length records
  std::string extended;              // whole extended records
  std::uint32_t extended_count = 0;
  std::optional<std::uint64_t> count;         // else the true one
  std::optional<std::uint32_t> legacy_count;  // of 1.4, else 0 there
  std::uint16_t encoding = 0;
  int header_extra = 0;  // bytes between header and records
  std::array<double, 3> scale = {0.01, 0.01, 0.001};
  std::array<double, 3> offset = {500000, 4649000, -10};
  std::array<double, 6> bounds = {500001, 500000, 4649002, 4649000, 3, -10};
  std::uint16_t record_bytes = 0;  // else of the first point
};

/// LAS 1.4-R15, table 3, and its shorter predecessors of 1.2 and 1.3.
std::string hand_file(const HandFile& f) {
  const int own = (f.minor == 2 ? 227 : f.minor == 3 ? 235 : 375) + f.header_extra;
  std::string records, points;
  for (const std::string& record : f.records) records += record;
  for (const std::string& point : f.points) points += point;
  const std::uint64_t count = f.count.value_or(f.points.size());
  Bytes b;
  b.put_text("LASF").put(std::uint16_t{0}).put(f.encoding).put_text("", 16);
  b.put(std::uint8_t{1}).put(static_cast<std::uint8_t>(f.minor));
  b.put_text("by hand", 32).put_text("a test", 32).put(std::uint16_t{32}).put(std::uint16_t{2024});
  b.put(static_cast<std::uint16_t>(own));
  b.put(static_cast<std::uint32_t>(own + static_cast<int>(records.size())));
  b.put(static_cast<std::uint32_t>(f.records.size())).put(static_cast<std::uint8_t>(f.format));
  b.put(static_cast<std::uint16_t>(f.record_bytes     ? f.record_bytes
                                   : f.points.empty() ? 20
                                                      : f.points[0].size()));
  b.put(f.legacy_count.value_or(f.minor == 4 ? 0 : static_cast<std::uint32_t>(count)));
  b.put_text("", 20);  // by return
  for (const double s : f.scale) b.put(s);
  for (const double o : f.offset) b.put(o);
  for (const double v : f.bounds) b.put(v);
  if (f.minor >= 3) b.put(std::uint64_t{0});  // waveforms
  if (f.minor >= 4) {
    b.put(f.extended_count ? static_cast<std::uint64_t>(own) + records.size() + points.size() : 0);
    b.put(f.extended_count).put(count).put_text("", 15 * 8);
  }
  b.put_text("", static_cast<std::size_t>(f.header_extra));
  EXPECT_EQ(b.text.size(), static_cast<std::size_t>(own));
  return b.text + records + points + f.extended;
}

std::string record(const std::string& user, std::uint16_t id, const std::string& data) {
  Bytes b;
  b.put(std::uint16_t{0}).put_text(user, 16).put(id).put(static_cast<std::uint16_t>(data.size()));
  return b.put_text("", 32).text + data;
}

std::string extended_record(const std::string& user, std::uint16_t id, const std::string& data) {
  Bytes b;
  b.put(std::uint16_t{0}).put_text(user, 16).put(id).put(static_cast<std::uint64_t>(data.size()));
  return b.put_text("", 32).text + data;
}

/// A GeoTIFF key directory of keys whose values are in the directory itself.
std::string geo_keys(const std::vector<std::array<std::uint16_t, 2>>& keys) {
  Bytes b;
  b.put(std::uint16_t{1}).put(std::uint16_t{1}).put(std::uint16_t{0});
  b.put(static_cast<std::uint16_t>(keys.size()));
  for (const auto& [id, value] : keys) {
    b.put(id).put(std::uint16_t{0}).put(std::uint16_t{1}).put(value);
  }
  return record("LASF_Projection", 34735, b.text);
}

const std::vector<HandPoint> kPoints = {
    {0, 0, 0, 2, false, {65535, 0, 256}},
    {100, 200, 13000, 5, false, {0, 512, 65280}},
    {-1, -2147483647, 2147483647, 31, false, {255, 255, 255}},
    {7, 7, 7, 1, true, {1, 1, 1}},
};

TEST_F(Las, ReadsEveryVersionAndPointFormat) {
  for (int minor = 2; minor <= 4; ++minor) {
    const int max_format = minor == 2 ? 3 : minor == 3 ? 5 : 10;
    for (int format = 0; format <= max_format; ++format) {
      for (const int extra : {0, 5}) {
        SCOPED_TRACE(::testing::Message() << "1." << minor << " format " << format);
        HandFile f;
        f.minor = minor;
        f.format = format;
        f.header_extra = extra;
        for (const HandPoint& p : kPoints) f.points.push_back(hand_point(format, p, extra));
        const auto reader = open_point_cloud(write("a.las", hand_file(f)));
        const bool has_colour =
            format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
        EXPECT_EQ(reader->info().format, "LAS 1." + std::to_string(minor));
        EXPECT_EQ(reader->info().record_count, 4u);
        EXPECT_EQ(reader->info().has_colour, has_colour);
        EXPECT_EQ(reader->info().crs, "");
        ASSERT_TRUE(reader->info().bounds);
        EXPECT_EQ(reader->info().bounds->min(), Eigen::Vector3d(500000, 4649000, -10));
        EXPECT_EQ(reader->info().bounds->max(), Eigen::Vector3d(500001, 4649002, 3));
        const std::vector<CloudPoint> points = points_of(*reader);
        ASSERT_EQ(points.size(), 3u);
        EXPECT_EQ(points[0].position, Eigen::Vector3d(500000, 4649000, -10));
        EXPECT_NEAR(points[1].position.x(), 500001, 1e-9);
        EXPECT_NEAR(points[1].position.y(), 4649002, 1e-9);
        EXPECT_NEAR(points[1].position.z(), 3.0, 1e-9);
        EXPECT_NEAR(points[2].position.y(), 4649000 - 21474836.47, 1e-6);
        EXPECT_NEAR(points[2].position.z(), 2147483.647 - 10, 1e-6);
        EXPECT_EQ(points[0].classification, 2);
        EXPECT_EQ(points[2].classification, 31);
        ASSERT_EQ(points[0].rgb.has_value(), has_colour);
        if (has_colour) {
          EXPECT_EQ(*points[0].rgb, (std::array<std::uint8_t, 3>{255, 0, 1}));
          EXPECT_EQ(*points[1].rgb, (std::array<std::uint8_t, 3>{0, 2, 255}));
        }
        EXPECT_EQ(reader->tally().withheld, 1u);
        EXPECT_EQ(reader->tally().given, 3u);
      }
    }
  }
}

TEST_F(Las, FormatsFromSixOnHaveClassesOfEightBits) {
  HandFile f;
  f.minor = 4;
  f.format = 6;
  f.points = {hand_point(6, {.classification = 200})};
  EXPECT_EQ(points_of(*open_point_cloud(write("a.las", hand_file(f))))[0].classification, 200);
}

TEST_F(Las, ColoursOfEightBitsAreTakenAsTheyAre) {
  HandFile f;
  f.format = 2;
  for (int k = 0; k < 3000; ++k) {
    f.points.push_back(hand_point(2, {.rgb = {static_cast<std::uint16_t>(k % 256), 200, 3}}));
  }
  const std::vector<CloudPoint> points = read("a.las", hand_file(f));
  EXPECT_EQ(*points[130].rgb, (std::array<std::uint8_t, 3>{130, 200, 3}));
  // One sampled value beyond a byte, and the file is as the specification has it.
  f.points[1000] = hand_point(2, {.rgb = {256, 0, 0}});
  EXPECT_EQ(*read("a.las", hand_file(f))[1000].rgb, (std::array<std::uint8_t, 3>{1, 0, 0}));
}

TEST_F(Las, TellsTheCrs) {
  HandFile f;
  f.points = {hand_point(0, {})};
  const auto crs = [&] { return open_point_cloud(write("a.las", hand_file(f)))->info().crs; };
  f.records = {record("another", 34735, "abc"), geo_keys({{1024, 1}, {3072, 25832}})};
  EXPECT_EQ(crs(), "EPSG:25832");
  f.records = {geo_keys({{1024, 1}, {3072, 25832}, {4096, 7837}})};
  EXPECT_EQ(crs(), "EPSG:25832+7837");
  f.records = {geo_keys({{1024, 2}, {2048, 4326}})};
  EXPECT_EQ(crs(), "EPSG:4326");
  f.records = {geo_keys({{2048, 4258}, {3072, 32767}})};  // "user-defined" is no code
  EXPECT_EQ(crs(), "EPSG:4258");
  f.records = {geo_keys({{3072, 0}})};
  EXPECT_EQ(crs(), "");
  f.records = {record("LASF_Projection", 34735, "abc")};
  EXPECT_EQ(crs(), "");
  // A directory that counts more keys than it has.
  f.records = {geo_keys({{3072, 32632}})};
  f.records[0][54 + 6] = '\x7f';
  EXPECT_EQ(crs(), "EPSG:32632");

  const std::string wkt = "PROJCS[\"ETRS89 / UTM zone 32N\"]";
  f.records = {geo_keys({{3072, 25832}}), record("LASF_Projection", 2112, wkt + '\0')};
  EXPECT_EQ(crs(), "EPSG:25832");
  f.minor = 4;
  f.encoding = 0x10;
  EXPECT_EQ(crs(), wkt);
  f.records.clear();
  f.extended = extended_record("another", 7, std::string(70'000, 'a')) +
               extended_record("LASF_Projection", 2112, wkt);
  f.extended_count = 2;
  EXPECT_EQ(crs(), wkt);
}

TEST_F(Las, CountsOfSixtyFourBits) {
  HandFile f;
  f.minor = 4;
  f.format = 6;
  f.points = {hand_point(6, {}), hand_point(6, {})};
  f.count = 5'000'000'000;
  EXPECT_EQ(error_of("a.las", hand_file(f)),
            "point cloud 'a.las' is cut off: its header counts 5000000000 points, it holds 2");
  f.count = 2;
  f.legacy_count = 3;
  EXPECT_EQ(error_of("a.las", hand_file(f)),
            "point cloud 'a.las' has a broken header: it counts 3 points in 32 bits, 2 in 64");
  f.legacy_count = 2;
  f.count = 0;
  EXPECT_EQ(error_of("a.las", hand_file(f)), "no error");
}

TEST_F(Las, CompressedFilesSayHowToDecompressThem) {
  const std::string sentence =
      "point cloud 'a.laz' is compressed (LAZ), which is not supported; "
      "Debian 12 has no program for it, Python's laspy has: pip install 'laspy[lazrs]', then "
      "python3 -c \"import laspy; laspy.read('in.laz').write('out.las')\"";
  HandFile f;
  f.points = {hand_point(0, {})};
  f.format = 0x80;
  EXPECT_EQ(error_of("a.laz", hand_file(f)), sentence);
  f.format = 0;
  f.records = {record("laszip encoded", 22204, std::string(40, 'a'))};
  EXPECT_EQ(error_of("a.laz", hand_file(f)), sentence);
}

TEST_F(Las, FaultsInTheHeaderAreNamed) {
  HandFile good;
  good.points = {hand_point(0, {}), hand_point(0, {})};
  const std::string bytes = hand_file(good);
  const auto error = [&](const std::string& content) { return error_of("a.las", content); };
  const auto with = [&](auto change) {
    HandFile f = good;
    change(f);
    return error(hand_file(f));
  };
  const auto patched = [&](std::size_t at, const std::string& value) {
    return error(std::string(bytes).replace(at, value.size(), value));
  };
  EXPECT_EQ(error(bytes), "no error");
  EXPECT_EQ(error("LASF"), "point cloud 'a.las' is cut off: its header is 227 bytes, it holds 4");
  EXPECT_EQ(error(bytes.substr(0, 226)),
            "point cloud 'a.las' is cut off: its header is 227 bytes, it holds 226");
  EXPECT_EQ(error("LASX" + bytes.substr(4)),
            "point cloud 'a.las' is not a LAS file: it begins with 'LASX', must begin with LASF");
  EXPECT_EQ(error(bytes.substr(0, 230)),
            "point cloud 'a.las' is cut off: its header counts 2 points, it holds 0");
  EXPECT_EQ(error(bytes.substr(0, bytes.size() - 1)),
            "point cloud 'a.las' is cut off: its header counts 2 points, it holds 1");
  // A byte too many anywhere among the points shifts all behind it.
  EXPECT_EQ(
      error(std::string(bytes).insert(240, 1, '\x2a')),
      "point cloud 'a.las' is damaged: 2 points are followed by 1 bytes, less than one point");
  EXPECT_EQ(with([](HandFile& f) { f.count = 1; }),
            "point cloud 'a.las' has more data than its header counts: 1 points, it holds 2");
  EXPECT_EQ(patched(25, "\x05"), "point cloud 'a.las' is LAS 1.5, must be 1.2, 1.3 or 1.4");
  EXPECT_EQ(patched(25, "\x01"), "point cloud 'a.las' is LAS 1.1, must be 1.2, 1.3 or 1.4");
  EXPECT_EQ(patched(25, "\x04"),
            "point cloud 'a.las' is cut off: its header is 375 bytes, it holds 267");
  EXPECT_EQ(patched(94, bytes_of(std::uint16_t{200})),
            "point cloud 'a.las' has a broken header: 200 bytes long, LAS 1.2 has at least 227");
  EXPECT_EQ(patched(96, bytes_of(std::uint32_t{100})),
            "point cloud 'a.las' has a broken header: its points begin at byte 100, inside its "
            "header of 227 bytes");
  EXPECT_EQ(patched(96, bytes_of(std::uint32_t{9'000'000})),
            "point cloud 'a.las' is cut off: its points begin at byte 9000000, it holds 267 bytes");
  EXPECT_EQ(patched(100, bytes_of(std::uint32_t{4'000'000'000})),
            "point cloud 'a.las' counts 4000000000 variable length records in its header, but "
            "holds 0");
  EXPECT_EQ(patched(104, "\x04"), "point cloud 'a.las' has points of format 4, LAS 1.2 has 0 to 3");
  EXPECT_EQ(patched(105, bytes_of(std::uint16_t{19})),
            "point cloud 'a.las' has points of 19 bytes, format 0 has at least 20");
  const double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(with([](HandFile& f) { f.scale[1] = 0.0; }),
            "point cloud 'a.las' has a broken header: scale 0 and offset 4649000 along y, must be "
            "finite and the scale not 0");
  EXPECT_EQ(with([&](HandFile& f) { f.offset[2] = kNaN; }),
            "point cloud 'a.las' has a broken header: scale 0.001 and offset nan along z, must be "
            "finite and the scale not 0");
  // Bounds are the file's word, and no reason to refuse it.
  good.bounds[0] = kNaN;
  EXPECT_FALSE(open_point_cloud(write("a.las", hand_file(good)))->info().bounds);
}

TEST_F(Las, CutExtendedRecordsAreNamed) {
  HandFile f;
  f.minor = 4;
  f.points = {hand_point(0, {})};
  f.extended = extended_record("LASF_Projection", 2112, "PROJCS[]");
  f.extended_count = 2;
  EXPECT_EQ(error_of("a.las", hand_file(f)),
            "point cloud 'a.las' counts 2 extended variable length records in its header, but "
            "holds 1");
  f.extended_count = 1;
  const std::string bytes = hand_file(f);
  EXPECT_EQ(error_of("a.las", bytes), "no error");
  EXPECT_EQ(error_of("a.las", bytes.substr(0, bytes.size() - 1)),
            "point cloud 'a.las' counts 1 extended variable length records in its header, but "
            "holds 0");
  for (std::size_t cut = 4; cut < bytes.size(); ++cut) {
    EXPECT_NE(error_of("a.las", bytes.substr(0, cut)), "no error") << cut;
  }
}

}  // namespace
}  // namespace vinerow::io::point_cloud_las_test
