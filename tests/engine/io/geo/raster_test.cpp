#include "engine/io/geo/raster.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "tests/support/data.h"

namespace vinerow::io::raster_test {
namespace {

std::filesystem::path temporary(const std::string& name) {
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_raster_test";
  std::filesystem::create_directories(folder);
  return folder / name;
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

/// NaN where there is no height.
double height_at(const ElevationRaster& raster, double latitude_rad, double longitude_rad) {
  return ElevationLookup(raster)
      .height_m(latitude_rad, longitude_rad)
      .value_or(std::numeric_limits<double>::quiet_NaN());
}

/// Uncompressed float32 GeoTIFF written byte by byte after the TIFF 6.0 and GeoTIFF 1.0
/// specifications.
/// @param epsg  of a projected system; 0 leaves the key directory out
std::filesystem::path write_tiff(const std::string& name, int columns, int rows, double left,
                                 double top, double cell, const std::vector<float>& heights,
                                 std::uint16_t epsg) {
  std::string out = "II*";
  out += '\0';
  const auto put = [&](auto value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const std::uint16_t tags = epsg ? 13 : 12;
  const std::uint32_t after = 8 + 2 + 12u * tags + 4;
  const std::uint32_t scale_at = after, tie_at = scale_at + 24, keys_at = tie_at + 48;
  const std::uint32_t data_at = keys_at + 32;
  put(std::uint32_t{8});
  put(tags);
  const auto tag = [&](std::uint16_t id, std::uint16_t type, std::uint32_t count,
                       std::uint32_t value) { put(id), put(type), put(count), put(value); };
  const auto bytes = static_cast<std::uint32_t>(heights.size() * 4);
  tag(256, 4, 1, static_cast<std::uint32_t>(columns));
  tag(257, 4, 1, static_cast<std::uint32_t>(rows));
  tag(258, 3, 1, 32);       // bits
  tag(259, 3, 1, 1);        // no compression
  tag(262, 3, 1, 1);        // black is zero
  tag(273, 4, 1, data_at);  // the one strip
  tag(277, 3, 1, 1);
  tag(278, 4, 1, static_cast<std::uint32_t>(rows));
  tag(279, 4, 1, bytes);
  tag(339, 3, 1, 3);  // float
  tag(33550, 12, 3, scale_at);
  tag(33922, 12, 6, tie_at);
  if (epsg) tag(34735, 3, 16, keys_at);
  put(std::uint32_t{0});
  for (const double v : {cell, cell, 0.0}) put(v);
  for (const double v : {0.0, 0.0, 0.0, left, top, 0.0}) put(v);
  // Version, three keys: projected model, pixel is area, the system's code.
  for (const int v : {1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, int{epsg}}) {
    put(static_cast<std::uint16_t>(v));
  }
  out.append(reinterpret_cast<const char*>(heights.data()), bytes);
  const auto file = temporary(name);
  std::ofstream(file, std::ios::binary) << out;
  return file;
}

// UTM zone 32N has its central meridian at 9 deg east (easting 500 km, scale 0.9996). Meridian arc
// of WGS84 to 45 deg north: 4984944.378 m (Snyder, "Map Projections", eq. 3-21), times 0.9996.
constexpr double kNorthing45_m = 4984944.378 * 0.9996;
const GeoOrigin kOrigin{rad_from_deg(45.0), rad_from_deg(9.0), 100.0};

/// A plane 100 + 0.02 E + 0.05 N above the origin, 5 m cells.
std::filesystem::path write_plane(const std::string& name, std::uint16_t epsg) {
  constexpr int kSize = 80;
  std::vector<float> heights;
  for (int j = 0; j < kSize; ++j) {
    for (int i = 0; i < kSize; ++i) {
      const double e = 5.0 * (i + 0.5) - 200.0, n = 200.0 - 5.0 * (j + 0.5);
      heights.push_back(static_cast<float>(100.0 + 0.02 * e + 0.05 * n));
    }
  }
  return write_tiff(name, kSize, kSize, 500000.0 - 200.0, kNorthing45_m + 200.0, 5.0, heights,
                    epsg);
}

TEST(Raster, PlaneInUtmBecomesAPlaneInEastNorthUp) {
  const ElevationRaster raster = read_elevation(write_plane("utm.tif", 32632));
  EXPECT_EQ(raster.columns, 80);
  EXPECT_EQ(raster.crs_name, "WGS 84 / UTM zone 32N");
  const HeightField field = resample_elevation(raster, kOrigin, {{-100, -80}, 200, 160, 2.0});
  EXPECT_EQ(field.columns, 101);
  EXPECT_EQ(field.rows, 81);
  double worst_m = 0.0;
  for (double y = -80; y <= 80; y += 7.0) {
    for (double x = -100; x <= 100; x += 7.0) {
      worst_m = std::max(worst_m, std::abs(field.height_m(x, y) - 0.9996 * (0.02 * x + 0.05 * y)));
    }
  }
  // The fall of the ellipsoid below the tangent plane (1.3 mm at 128 m), a millimetre of the
  // meridian arc times the slope, float32.
  EXPECT_LT(worst_m, 2e-3);
}

TEST(Raster, GeoTiffWithoutCrsNeedsOneFromTheUser) {
  const auto file = write_plane("nocrs.tif", 0);
  EXPECT_EQ(error_of([&] { read_elevation(file); }),
            "raster '" + file.string() +
                "' has no coordinate reference system; give it by 'crs: EPSG:<code>'");
  const ElevationRaster raster = read_elevation(file, "EPSG:32632");
  EXPECT_NEAR(height_at(raster, kOrigin.latitude_rad, kOrigin.longitude_rad), 100.0, 0.01);
  EXPECT_EQ(read_elevation(file, "32632").crs_name, read_elevation(file, "EPSG:32632").crs_name);
  EXPECT_EQ(error_of([&] { read_elevation(file, "EPSG:nonsense"); }),
            "crs = 'EPSG:nonsense' is not a coordinate reference system, must be like EPSG:32632");
}

TEST(Raster, GeographicRasterKeepsLongitudeEast) {
  // EPSG:4326 officially has latitude first; a raster has longitude along its columns all the same.
  std::vector<float> heights;
  for (int j = 0; j < 10; ++j) {
    for (int i = 0; i < 10; ++i) heights.push_back(static_cast<float>(i));  // rises to the east
  }
  const auto file = write_tiff("geographic.tif", 10, 10, 9.0, 45.0, 0.001, heights, 0);
  const ElevationRaster raster = read_elevation(file, "EPSG:4326");
  EXPECT_NEAR(height_at(raster, rad_from_deg(44.9955), rad_from_deg(9.0035)), 3.0, 1e-6);
  EXPECT_NEAR(height_at(raster, rad_from_deg(44.9925), rad_from_deg(9.0070)), 6.5, 1e-6);
}

TEST(Raster, RefusesBadInputInOneSentence) {
  EXPECT_EQ(error_of([] { read_elevation("/none.tif"); }), "raster '/none.tif' does not exist");
  const auto text = temporary("text.tif");
  std::ofstream(text) << "no raster";
  EXPECT_NE(
      error_of([&] { read_elevation(text); }).find("cannot be read: GDAL knows no such format"),
      std::string::npos);
  const ElevationRaster raster = read_elevation(write_plane("small.tif", 32632));
  const std::string error = error_of([&] {
    resample_elevation(raster, kOrigin, {{-500, -500}, 1000, 1000, 10.0});
  });
  EXPECT_NE(error.find("has no height at latitude"), std::string::npos) << error;
  EXPECT_NE(error.find("it covers x 499800 to 500200"), std::string::npos) << error;
  EXPECT_EQ(error.find("swapped"), std::string::npos) << error;
}

/// The middle of the plane is the origin by construction, on the central meridian.
TEST(Raster, AWorldBesideItIsShownWhereItIs) {
  const ElevationRaster raster = read_elevation(write_plane("beside.tif", 32632));
  GeoOrigin beside = kOrigin;
  beside.latitude_rad = rad_from_deg(44.0);
  const std::string error = error_of([&] {
    resample_elevation(raster, beside, {{-5, -5}, 10, 10, 5.0});
  });
  EXPECT_TRUE(
      error.ends_with("of WGS 84 / UTM zone 32N; its middle is at latitude 45.000000 deg, "
                      "longitude 9.000000 deg"))
      << error;
  // In degrees the bounds need their decimals.
  const auto degrees = write_tiff("degrees.tif", 2, 2, 9.0, 45.0, 0.0001, {1.f, 1.f, 1.f, 1.f}, 0);
  const std::string fine = error_of([&] {
    resample_elevation(read_elevation(degrees, "EPSG:4326"), beside, {{-5, -5}, 10, 10, 5.0});
  });
  EXPECT_NE(fine.find("it covers x 9 to 9.0002, y 44.9998 to 45 of WGS 84"), std::string::npos)
      << fine;
}

TEST(Raster, HolesAndUndeclaredNoDataAreRefusedByWhatTheyAre) {
  const auto error_with = [](float height) {
    std::vector<float> heights(100, 100.f);
    heights[55] = height;
    const auto file = write_tiff("hole.tif", 10, 10, 9.0, 45.0, 0.001, heights, 0);
    const GeoOrigin middle{rad_from_deg(44.9945), rad_from_deg(9.0055), 100.0};  // of pixel (5, 5)
    return error_of([&] {
      resample_elevation(read_elevation(file, "EPSG:4326"), middle, {{-5, -5}, 10, 10, 5.0});
    });
  };
  EXPECT_EQ(error_with(101.f), "no error");
  EXPECT_NE(error_with(std::numeric_limits<float>::quiet_NaN()).find("has a hole (\"no data\") at"),
            std::string::npos);
  // -9999 is the usual mark of ESRI's grids.
  for (const float mark : {-9999.f, 65535.f, -32768.f}) {
    EXPECT_NE(error_with(mark).find("is this an undeclared \"no data\" value?"), std::string::npos)
        << error_with(mark);
  }
}

/// 100 m are 328.084 ft, and 328.083 ft of the US survey (1 m = 39.37 in).
TEST(Raster, HeightsInFeetBecomeMetres) {
  write_plane("feet.tif", 32632);
  const auto height_m = [](const std::string& unit) {
    const auto file = temporary("feet.vrt");
    std::ofstream(file)
        << "<VRTDataset rasterXSize=\"80\" rasterYSize=\"80\"><SRS>EPSG:32632</SRS><GeoTransform>"
        << fmt::format("{:.6f}, 5, 0, {:.6f}, 0, -5", 500000.0 - 200.0, kNorthing45_m + 200.0)
        << "</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\"><UnitType>" << unit
        << "</UnitType><SimpleSource><SourceFilename relativeToVRT=\"1\">feet.tif</SourceFilename>"
           "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
    return height_at(read_elevation(file), kOrigin.latitude_rad, kOrigin.longitude_rad);
  };
  EXPECT_NEAR(height_m("m"), 100.0, 1e-3);
  EXPECT_NEAR(height_m("ft"), 30.48, 1e-3);
  EXPECT_NEAR(height_m("US survey foot"), 100.0 / 3.2808333333, 1e-3);
}

TEST(Raster, SwappedLatitudeAndLongitudeAreSuspected) {
  const ElevationRaster raster = read_elevation(write_plane("swapped.tif", 32632));
  GeoOrigin swapped = kOrigin;
  std::swap(swapped.latitude_rad, swapped.longitude_rad);
  const std::string error = error_of([&] {
    resample_elevation(raster, swapped, {{-5, -5}, 10, 10, 5.0});
  });
  EXPECT_NE(error.find("of WGS 84 / UTM zone 32N; are latitude and longitude swapped?"),
            std::string::npos)
      << error;
}

TEST(Raster, AHeightOfNoPlaceOnEarthIsRefused) {
  std::vector<float> heights(100, 250.0f);
  heights[55] = -32768.0f;
  const ElevationRaster raster =
      read_elevation(write_tiff("void.tif", 10, 10, 9.0, 45.0, 0.001, heights, 0), "EPSG:4326");
  GeoOrigin origin;
  origin.latitude_rad = rad_from_deg(44.9945);
  origin.longitude_rad = rad_from_deg(9.0055);
  const std::string error = error_of([&] {
    resample_elevation(raster, origin, {{0, 0}, 1.0, 1.0, 1.0});
  });
  EXPECT_NE(error.find("is this an undeclared \"no data\" value?"), std::string::npos) << error;
}

TEST(Raster, DavosdorfHasTheKnownFacts) {
  VINEROW_OUTSIDE_DATA(file, "terrain_navigation/resources/davosdorf.tif");
  const ElevationRaster raster = read_elevation(file);
  EXPECT_EQ(raster.columns, 559);
  EXPECT_EQ(raster.rows, 495);
  EXPECT_EQ(raster.geo_transform[0], 779503.0);
  EXPECT_EQ(raster.geo_transform[3], 190480.0);
  EXPECT_EQ(raster.geo_transform[1], 10.0);
  double low = 1e9, high = -1e9, sum = 0.0;
  for (const float h : raster.heights_m) {
    low = std::min(low, double{h});
    high = std::max(high, double{h});
    sum += h;
  }
  EXPECT_NEAR(low, 1535.92, 0.005);
  EXPECT_NEAR(high, 2843.08, 0.005);
  EXPECT_NEAR(sum / static_cast<double>(raster.heights_m.size()), 2006.50, 0.005);
}

/// swisstopo, "Approximate formulas for the transformation between Swiss projection coordinates and
/// WGS84" (2016), section 4; good to about 1 m.
void swiss_to_wgs84(double y_m, double x_m, double* latitude_deg, double* longitude_deg) {
  const double y = (y_m - 600000.0) / 1e6, x = (x_m - 200000.0) / 1e6;
  const double lambda =
      2.6779094 + 4.728982 * y + 0.791484 * y * x + 0.1306 * y * x * x - 0.0436 * y * y * y;
  const double phi = 16.9023892 + 3.238272 * x - 0.270978 * y * y - 0.002528 * x * x -
                     0.0447 * y * y * x - 0.0140 * x * x * x;
  *longitude_deg = lambda * 100.0 / 36.0;
  *latitude_deg = phi * 100.0 / 36.0;
}

TEST(Raster, DavosdorfLiesWhereSwisstoposFormulasSay) {
  VINEROW_OUTSIDE_DATA(file, "terrain_navigation/resources/davosdorf.tif");
  const ElevationRaster raster = read_elevation(file);
  const ElevationLookup lookup(raster);
  double worst_m = 0.0;
  for (int j = 20; j < raster.rows - 20; j += 60) {
    for (int i = 20; i < raster.columns - 20; i += 60) {
      double latitude_deg, longitude_deg;
      swiss_to_wgs84(779503.0 + 10.0 * (i + 0.5), 190480.0 - 10.0 * (j + 0.5), &latitude_deg,
                     &longitude_deg);
      const double here = raster.heights_m[static_cast<std::size_t>(j) * raster.columns + i];
      const std::optional<double> read =
          lookup.height_m(rad_from_deg(latitude_deg), rad_from_deg(longitude_deg));
      ASSERT_TRUE(read);
      worst_m = std::max(worst_m, std::abs(*read - here));
    }
  }
  // 1 m of place on slopes of up to 45 deg; half a pixel (the usual mistake) would be 5 m and more.
  EXPECT_LT(worst_m, 2.0);
}

TEST(Raster, DavosdorfBecomesAHeightField) {
  VINEROW_OUTSIDE_DATA(file, "terrain_navigation/resources/davosdorf.tif");
  const ElevationRaster raster = read_elevation(file);
  double latitude_deg, longitude_deg;
  swiss_to_wgs84(782000.0, 188000.0, &latitude_deg, &longitude_deg);
  GeoOrigin origin{rad_from_deg(latitude_deg), rad_from_deg(longitude_deg), 0.0};
  origin.altitude_m = height_at(raster, origin.latitude_rad, origin.longitude_rad);
  const HeightField field = resample_elevation(raster, origin, {{-100, -100}, 200, 200, 1.0});
  EXPECT_NEAR(field.height_m(0, 0), 0.0, 1e-3);
  for (const float h : field.heights_m) ASSERT_TRUE(std::isfinite(h));
}

}  // namespace
}  // namespace vinerow::io::raster_test
