#include "worlds/vineyard/vineyard.h"
#include "engine/api/height_field.h"
#include "engine/api/map.h"
#include "engine/api/world_model.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "engine/core/error.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "engine/physics/world_scene.h"
#include "tests/worlds/world_fixture.h"
#include "worlds/parts/mesh_store.h"

namespace vinerow::worlds::vineyard_test {
namespace {

using Eigen::Vector3d;

const WorldModel& parcel_f() {
  static const auto world = test::make_world("vineyard", test::world_parameters("vineyard"));
  return *world;
}

TEST(Vineyard, DefaultIsParcelF) {
  const RowMap& map = parcel_f().rows;
  ASSERT_EQ(map.rows.size(), 16u);
  EXPECT_EQ(map.alleys.size(), 15u);
  for (const PlantRow& row : map.rows) {
    EXPECT_NEAR((row.line_W.back() - row.line_W.front()).head<2>().norm(), 118.0, 1e-9);
  }
  for (const Alley& alley : map.alleys) EXPECT_NEAR(alley.width_m, 2.5, 1e-9);
}

/// The centre of an arc that hardly bends is so far off that its points would fall together.
TEST(Vineyard, RowsThatHardlyBendKeepTheirLength) {
  for (const double bend_deg : {1e-308, -1e-12, 1e-7, 1e-4}) {
    ParameterSet parameters = test::world_parameters("vineyard");
    parameters.set("row_count", std::int64_t{3}).set("row_length_m", 60.0);
    parameters.set("row_bearing_deg", 0.0).set("row_bend_deg", bend_deg);
    parameters.set("leaf_cards_per_m", 10.0);
    const auto world = test::make_world("vineyard", parameters);
    for (const PlantRow& row : world->rows->rows) {
      const Eigen::Vector2d chord = (row.line_W.back() - row.line_W.front()).head<2>();
      EXPECT_NEAR(chord.norm(), 60.0, 1e-5) << bend_deg;
      EXPECT_NEAR(chord.x(), 0.0, 1e-5) << bend_deg;
    }
  }
}

TEST(Vineyard, BentRowsAreArcsAboutOneCentre) {
  for (const double bend_deg : {40.0, -40.0}) {
    ParameterSet parameters = test::world_parameters("vineyard");
    parameters.set("row_count", std::int64_t{5}).set("row_length_m", 60.0);
    parameters.set("row_bearing_deg", 0.0).set("row_bend_deg", bend_deg);
    parameters.set("leaf_cards_per_m", 10.0);
    const auto world = test::make_world("vineyard", parameters);
    // Rows run north; those that turn left do so about a centre in the west.
    const double radius_m = 60.0 / rad_from_deg(bend_deg);
    const Eigen::Vector2d centre(71.4 - radius_m, 38.9);
    for (std::size_t i = 0; i < 5; ++i) {
      const auto& line = world->rows->rows[i].line_W;
      const double offset_m = 2.5 * (static_cast<double>(i) - 2.0);  // to the left, west
      const double own_m = radius_m - offset_m;
      for (const Eigen::Vector3d& p : line) {
        EXPECT_NEAR((p.head<2>() - centre).norm(), std::abs(own_m), 1e-9);
      }
      const Eigen::Vector2d chord = (line.back() - line.front()).head<2>();
      EXPECT_NEAR(chord.x(), 0.0, 1e-9);
      EXPECT_NEAR(chord.y(), 2.0 * std::abs(own_m * std::sin(rad_from_deg(0.5 * bend_deg))), 1e-9);
    }
    // Chords of 1 m lie up to 1 / (8 * 81 m) = 1.5 mm inside their arcs.
    for (const Alley& alley : world->rows->alleys) EXPECT_NEAR(alley.width_m, 2.5, 1.6e-3);
  }
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_bend_deg", 180.0).set("row_length_m", 50.0);
  try {
    test::make_world("vineyard", parameters);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "row_bend_deg = 180 deg bends rows of 50 m about a centre 15.9 m beside the "
                 "block's middle, and a row 16.2 m beside it does not fit");
  }
}

// Four wires, evenly from the arms' height to 5 cm below the posts' top, over each row's middle.
TEST(Vineyard, WiresAreInTheWayOfWhatPassesBetweenRows) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_count", std::int64_t{2}).set("row_length_m", 30.0);
  parameters.set("relief_m", 0.0).set("row_bearing_deg", 90.0).set("leaf_cards_per_m", 10.0);
  parameters.set("arm_height_m", 0.8).set("post_height_m", 2.05);
  const auto world = test::make_world("vineyard", parameters);
  const physics::WorldScene scene(*world);
  const Vector3d middle_W =
      0.5 * (world->rows->rows[0].line_W.front() + world->rows->rows[0].line_W.back());
  const double ground_m = *scene.ground_height_m(middle_W.x(), middle_W.y(), 1e3);
  constexpr double kHalf_m = 0.05, kWireRadius_m = 0.0025;
  for (const double height_m : {0.8, 1.2, 1.6, 2.0}) {
    const Pose X_WBox{Eigen::Quaterniond::Identity(),
                      {middle_W.x(), middle_W.y() + 0.4, ground_m + height_m}};
    // Rows run east. The tube has three sides: it is half as thick across one of them.
    const double distance_m = scene.distance_to_box_m(X_WBox, Vector3d::Constant(kHalf_m), 3.0,
                                                      mask_of(SurfaceClass::kWire));
    EXPECT_NEAR(distance_m, 0.4 - kHalf_m - 0.75 * kWireRadius_m, 0.3 * kWireRadius_m) << height_m;
  }
  const Pose between{Eigen::Quaterniond::Identity(), {middle_W.x(), middle_W.y(), ground_m + 1.4}};
  EXPECT_NEAR(scene.distance_to_box_m(between, Vector3d::Constant(kHalf_m), 3.0,
                                      mask_of(SurfaceClass::kWire)),
              0.2 - kHalf_m, 2.0 * kWireRadius_m);
}

TEST(Vineyard, ReliefUnderTheRowsIsThirtyMetres) {
  double low = 1e9, high = -1e9;
  for (const PlantRow& row : parcel_f().rows->rows) {
    for (int i = 0; i <= 1000; ++i) {
      const Eigen::Vector3d p = row.line_W[0] + (row.line_W[1] - row.line_W[0]) * (i / 1000.0);
      const double h = parcel_f().terrain->height_m(p.x(), p.y());
      low = std::min(low, h);
      high = std::max(high, h);
    }
  }
  // Fitted on samples each 2 m; a cell of 0.5 m on a slope of 25 % bends by millimetres.
  EXPECT_NEAR(high - low, 30.0, 0.05);
}

TEST(Vineyard, ParcelLiesInsideThePapersCoordinates) {
  const LocalFrame frame(parcel_f().origin);
  for (const PlantRow& row : parcel_f().rows->rows) {
    for (const Eigen::Vector3d& p : row.line_W) {
      const Geodetic g = frame.to_geodetic(p);
      EXPECT_GT(deg_from_rad(g.latitude_rad), 44.6150);
      EXPECT_LT(deg_from_rad(g.latitude_rad), 44.6157);
      EXPECT_GT(deg_from_rad(g.longitude_rad), 7.9244);
      EXPECT_LT(deg_from_rad(g.longitude_rad), 7.9262);
    }
  }
}

TEST(Vineyard, HasTheWantedNumberOfTriangles) {
  std::vector<const TriangleMesh*> seen;
  std::size_t triangles = 2u * (parcel_f().terrain->columns - 1) * (parcel_f().terrain->rows - 1);
  for (const MeshInstance& instance : parcel_f().meshes) {
    if (std::find(seen.begin(), seen.end(), instance.mesh.get()) != seen.end()) continue;
    seen.push_back(instance.mesh.get());
    triangles += instance.mesh->triangles.size();
  }
  EXPECT_GT(triangles, 500000u);
  EXPECT_LT(triangles, 800000u);
}

ParameterSet small_vineyard(const std::filesystem::path& folder) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_count", 2.0).set("row_length_m", 12.0).set("relief_m", 1.0);
  parameters.set("mesh_folder", folder.string());
  return parameters;
}

std::string meshes_digest(const WorldModel& world) {
  Hasher hasher;
  for (const MeshInstance& m : world.meshes) hasher.add(mesh_digest(*m.mesh));
  return hasher.hex();
}

std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Vineyard, WarmColdAndDamagedCacheGiveTheSameBits) {
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_vineyard_cache_test";
  std::filesystem::remove_all(folder);
  const std::string cold = meshes_digest(*test::make_world("vineyard", small_vineyard(folder)));
  const auto files = files_below(folder);
  ASSERT_GT(files.size(), 5u);
  const auto written = std::filesystem::last_write_time(files.front());
  EXPECT_EQ(meshes_digest(*test::make_world("vineyard", small_vineyard(folder))), cold);
  EXPECT_EQ(std::filesystem::last_write_time(files.front()), written) << "written again";
  EXPECT_EQ(files_below(folder), files) << "left something behind";

  // Cut off, changed in one byte, gone.
  std::filesystem::resize_file(files[0], std::filesystem::file_size(files[0]) / 2);
  {
    std::fstream stream(files[1], std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(-30, std::ios::end);
    stream.put('\x55');
  }
  std::filesystem::remove(files[2]);
  EXPECT_EQ(meshes_digest(*test::make_world("vineyard", small_vineyard(folder))), cold);
  EXPECT_EQ(files_below(folder), files);
  std::filesystem::remove_all(folder);
}

TEST(Vineyard, OtherParametersUseOtherFiles) {
  const auto folder = std::filesystem::temp_directory_path() / "vinerow_vineyard_key_test";
  std::filesystem::remove_all(folder);
  test::make_world("vineyard", small_vineyard(folder));
  ParameterSet sunny = small_vineyard(folder);
  sunny.set("sun_elevation_deg", 20.0).set("soil", std::string("wet_soil"));
  test::make_world("vineyard", sunny);
  const auto count = [&] {
    return std::distance(std::filesystem::directory_iterator(folder),
                         std::filesystem::directory_iterator());
  };
  EXPECT_EQ(count(), 1) << "light and soil change no mesh";
  ParameterSet wider = small_vineyard(folder);
  wider.set("canopy_width_m", 0.7);
  test::make_world("vineyard", wider);
  EXPECT_EQ(count(), 2);
  std::filesystem::remove_all(folder);
}

TEST(Vineyard, SurroundingsChangeNothingInTheParcel) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_count", std::int64_t{2}).set("row_length_m", 12.0);
  const auto narrow = test::make_world("vineyard", parameters);
  parameters.set("surroundings_m", 106.0);
  const auto wide = test::make_world("vineyard", parameters);
  const HeightField &small = *narrow->terrain, &large = *wide->terrain;
  EXPECT_EQ(large.columns, small.columns + 400);
  // The grids share their samples: 100 m are 200 cells.
  float difference = 0.0f;
  for (int j = 0; j < small.rows; ++j) {
    for (int i = 0; i < small.columns; ++i) {
      const float near = small.heights_m[static_cast<std::size_t>(j * small.columns + i)];
      const float far =
          large.heights_m[static_cast<std::size_t>((j + 200) * large.columns + i + 200)];
      difference = std::max(difference, std::abs(near - far));
    }
  }
  EXPECT_LT(difference, 1e-5f);
  ASSERT_EQ(wide->rows->rows.size(), narrow->rows->rows.size());
  EXPECT_LT((wide->rows->rows[1].line_W[0] - narrow->rows->rows[1].line_W[0]).norm(), 1e-5);
}

TEST(Vineyard, TheHillsideEndsInARidgeAndAValley) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("surroundings_m", 400.0).set("slope_fade_m", 150.0).set("terrain_cell_m", 2.0);
  parameters.set("row_count", std::int64_t{1}).set("relief_m", 30.0);
  parameters.set("waves_m", 0.0).set("row_bearing_deg", 90.0).set("uphill_bearing_deg", 90.0);
  const auto world = test::make_world("vineyard", parameters);
  // By hand: 30 m over rows of 118 m along the slope. It goes on over headlands of 10 m, the 6 m of
  // ground that are always there and one cell; then it fades, which climbs half as much as it would
  // have over 150 m, and is over.
  const double slope = 30.0 / 118.0, centre = 71.4, plain = 59.0 + 10.0 + 6.0 + 2.0;
  const auto height_m = [&](double uphill_m) {
    return world->terrain->height_m(centre + uphill_m, 38.9);
  };
  const double level = height_m(0.0);
  EXPECT_NEAR(height_m(70.0) - level, 70.0 * slope, 1e-3);
  EXPECT_NEAR(height_m(-76.0) - level, -76.0 * slope, 1e-3);
  for (const double beyond : {150.0, 220.0, 300.0}) {
    EXPECT_NEAR(height_m(plain + beyond) - level, (plain + 75.0) * slope, 1e-3) << beyond;
    EXPECT_NEAR(height_m(-plain - beyond) - level, -(plain + 75.0) * slope, 1e-3) << beyond;
  }
  // Half-way the slope is half: 1 - 3/4 + 2/8. The climb until there is 150 (1/2 - 1/8 + 1/32).
  EXPECT_NEAR(height_m(plain + 75.0) - level, (plain + 150.0 * 0.40625) * slope, 0.01);
  EXPECT_NEAR((height_m(plain + 77.0) - height_m(plain + 73.0)) / 4.0, 0.5 * slope, 1e-3);
}

TEST(Vineyard, RefusesBadInputInOneSentence) {
  const auto error = [](const char* name, ParameterSet::Value value) {
    return test::config_error_of([&] {
      ParameterSet parameters = test::world_parameters("vineyard");
      parameters.set(name, std::move(value));
      test::make_world("vineyard", parameters);
    });
  };
  EXPECT_EQ(error("row_count", -2.0), "row_count = -2, must be >= 1 and <= 1000");
  EXPECT_EQ(error("pitch_m", std::nan("")), "pitch_m = nan, must be a finite number");
  EXPECT_EQ(error("canopy_base_m", 3.0), "canopy_base_m = 3 m, must be < canopy_top_m = 2 m");
  EXPECT_EQ(error("dem_file", std::string("/none.tif")), "raster '/none.tif' does not exist");
  EXPECT_EQ(error("terrain_cell_m", 0.01),
            "terrain_cell_m = 0.01 m, must be >= 0.05 m and <= 100 m");
  EXPECT_NE(error("soil", std::string("dry_gras")).find("did you mean 'dry_grass'?"),
            std::string::npos);
  EXPECT_NE(error("headland_m", 3.0).find("must be >= 8 m"), std::string::npos);
  EXPECT_EQ(error("vine_spacing_m", 0.001),
            "vine_spacing_m = 0.001 m, must be >= 0.1 m and <= 100 m");
  // 40 m rows of such posts took 22 GB.
  EXPECT_EQ(error("post_spacing_m", 5.4e-6),
            "post_spacing_m = 5.4e-06 m, must be >= 0.1 m and <= 100 m");
  EXPECT_EQ(error("trunk_radius_m", 28000.0),
            "trunk_radius_m = 28000 m, must be >= 0.001 m and <= 0.5 m");
  EXPECT_EQ(error("row_length_m", 1e9),
            "row_length_m = 1000000000 m, must be >= 1 m and <= 5000 m");
}

TEST(Vineyard, TooMuchGroundIsRefusedBeforeTheSlopeIsFitted) {
  ParameterSet parameters = test::world_parameters("vineyard");
  parameters.set("row_count", std::int64_t{900}).set("row_length_m", 5000.0).set("pitch_m", 2.5);
  parameters.set("terrain_cell_m", 0.5);
  const std::string error =
      test::config_error_of([&] { test::make_world("vineyard", parameters); });
  EXPECT_EQ(error.find("terrain_cell_m = 0.5 m gives "), 0u) << error;
  EXPECT_NE(error.find("must be at most 25 million: take cells of "), std::string::npos) << error;
}

/// Mesh files are read back as long as the generator's version is the same. If this test fails,
/// raise kGeneratorVersion in planted_folder.cpp and take over the new digests: otherwise old files
/// would be read for new meshes, on machines that have them.
TEST(Vineyard, MeshesAreThoseOfTheGeneratorsVersion) {
  const auto digest_of = [](bool with_vines, bool with_weeds = false) {
    ParameterSet parameters = test::world_parameters("vineyard");
    parameters.set("row_count", std::int64_t{1}).set("row_length_m", 8.0).set("relief_m", 1.0);
    parameters.set("leaf_cards_per_m", 10.0);
    if (with_vines) {
      ParameterSet vines = parameters.make_group("vines");
      vines.set("bbch", 85.0).set("berries", std::int64_t{5});
      parameters.set("vines", std::vector<ParameterSet>{vines});
    }
    if (with_weeds)
      parameters.set("weeds", std::vector<ParameterSet>{parameters.make_group("weeds")});
    // Not a folder of earlier builds.
    const auto folder = std::filesystem::temp_directory_path() /
                        ("vinerow_generator_" + std::to_string(::getpid()));
    parameters.set("mesh_folder", folder.string());
    const auto world = test::make_world("vineyard", parameters);
    std::filesystem::remove_all(folder);
    Hasher hasher;
    for (const MeshInstance& instance : world->meshes) hasher.add(mesh_digest(*instance.mesh));
    return hasher.hex();
  };
  EXPECT_EQ(digest_of(false), "829fd372833625a7c5b524d6912ba179");
  EXPECT_EQ(digest_of(true), "0ca75a25671ba8b8c36a658732aa1672");
  EXPECT_EQ(digest_of(false, true), "4387d10d2dff0e5a5c7b6bd1aaa78bbd");
}

}  // namespace
}  // namespace vinerow::worlds::vineyard_test
