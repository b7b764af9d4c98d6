#include "engine/io/geo/height_raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "engine/core/error.h"
#include "engine/io/geo/raster.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "tests/support/folder_test.h"

namespace vinerow::io::height_raster_test {
namespace {

class HeightRasterTest : public vinerow::test::FolderTest {
 protected:
  HeightRasterTest() : FolderTest("height_raster") {}

  static HeightField hills() {
    HeightField field;
    field.columns = 41;
    field.rows = 23;
    field.cell_m = 2.5;
    field.corner_W = {-30.0, -12.5};
    for (int j = 0; j < field.rows; ++j) {
      for (int i = 0; i < field.columns; ++i) {
        field.heights_m.push_back(static_cast<float>(3.0 * std::sin(0.2 * i) + 0.3 * j));
      }
    }
    return field;
  }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  std::string refusal(const std::filesystem::path& file) const {
    try {
      read_height_raster(file);
      return "no error";
    } catch (const ConfigError& error) {
      return without_folder(error.what());
    }
  }
};

TEST_F(HeightRasterTest, ReadsBackWhatWasWritten) {
  const HeightField field = hills();
  for (const bool with_origin : {false, true}) {
    std::optional<GeoOrigin> origin;
    if (with_origin) origin = GeoOrigin{rad_from_deg(44.6), rad_from_deg(7.9), 310.0};
    write_height_raster(field, origin, folder_ / "hills.tif");
    const HeightField read = read_height_raster(folder_ / "hills.tif");
    EXPECT_EQ(read.columns, field.columns);
    EXPECT_EQ(read.rows, field.rows);
    EXPECT_EQ(read.heights_m, field.heights_m);
    EXPECT_NEAR(read.cell_m, field.cell_m, 1e-9);
    EXPECT_NEAR((read.corner_W - field.corner_W).norm(), 0.0, 1e-6);
  }
}

TEST_F(HeightRasterTest, LiesWhereGeodesySaysForAReaderOfElevationModels) {
  const HeightField field = hills();
  const GeoOrigin origin{rad_from_deg(44.6), rad_from_deg(7.9), 310.0};
  write_height_raster(field, origin, folder_ / "hills.tif");
  const ElevationLookup lookup(read_elevation(folder_ / "hills.tif"));
  const LocalFrame frame(origin);
  for (int j = 2; j < field.rows - 2; j += 3) {
    for (int i = 2; i < field.columns - 2; i += 3) {
      const Eigen::Vector3d p_W(field.corner_W.x() + i * field.cell_m,
                                field.corner_W.y() + j * field.cell_m,
                                field.heights_m[static_cast<std::size_t>(j) * field.columns + i]);
      const Geodetic place = frame.to_geodetic(p_W);
      const auto height_m = lookup.height_m(place.latitude_rad, place.longitude_rad);
      ASSERT_TRUE(height_m);
      // The band's offset is the altitude; a reader may leave it to its caller.
      const double above_m = *height_m > 200.0 ? *height_m - origin.altitude_m : *height_m;
      EXPECT_NEAR(above_m, p_W.z(), 2e-3) << i << " " << j;
    }
  }
}

TEST_F(HeightRasterTest, RefusesWhatIsNoHeightFieldByName) {
  EXPECT_EQ(refusal(folder_ / "none.tif"), "raster 'none.tif' does not exist");
  EXPECT_EQ(refusal(write("words.tif", "no raster")),
            "raster 'words.tif' cannot be read: GDAL knows no such format, or it is cut off");
  const std::string grid = "xllcorner 0\nyllcorner 0\n";
  EXPECT_EQ(refusal(write("thin.asc", "ncols 1\nnrows 3\n" + grid + "cellsize 2\n1\n2\n3\n")),
            "raster 'thin.asc' has 1 x 3 pixels, needs at least 2 x 2");
  EXPECT_EQ(refusal(write("oblong.asc", "ncols 2\nnrows 2\n" + grid + "dx 2\ndy 3\n1 2\n3 4\n")),
            "raster 'oblong.asc' must have square pixels with north up");
  EXPECT_EQ(
      refusal(write("turned.vrt",
                    "<VRTDataset rasterXSize=\"4\" rasterYSize=\"4\"><GeoTransform>0, 1, 0.5, "
                    "0, 0.5, -1</GeoTransform><VRTRasterBand dataType=\"Float32\" "
                    "band=\"1\"/></VRTDataset>")),
      "raster 'turned.vrt' must have square pixels with north up");
}

TEST_F(HeightRasterTest, RefusesHeightsThatAreNotFinite) {
  HeightField field = hills();
  field.heights_m[7] = std::numeric_limits<float>::quiet_NaN();
  try {
    write_height_raster(field, std::nullopt, folder_ / "hills.tif");
    FAIL() << "written";
  } catch (const ConfigError& error) {
    EXPECT_EQ(without_folder(error.what()),
              "raster 'hills.tif' cannot be written: the terrain has a height that is not finite");
  }
}

TEST_F(HeightRasterTest, RefusesAFileThatIsCutOff) {
  write_height_raster(hills(), std::nullopt, folder_ / "hills.tif");
  const auto size = std::filesystem::file_size(folder_ / "hills.tif");
  for (const double share : {0.2, 0.6, 0.9}) {
    std::filesystem::copy_file(folder_ / "hills.tif", folder_ / "cut.tif",
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(folder_ / "cut.tif",
                                 static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    const std::string said = refusal(folder_ / "cut.tif");
    EXPECT_EQ(said.find("raster 'cut.tif' "), 0u) << said;
  }
}

}  // namespace
}  // namespace vinerow::io::height_raster_test
