/// What light the camera sensor sees: shadows, bands, textures, exposure.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "engine/core/whole_file.h"
#include "engine/imaging/png.h"
#include "engine/math/srgb.h"
#include "tests/engine/sensors/camera_bench.h"
#include "tests/support/paths.h"

namespace vinerow::sensors::camera_test {
namespace {

TEST(Camera, ShadowsLieWhereTheSunDoesNotReach) {
  const auto world = flat_world();
  world->daylight = {rad_from_deg(180.0), rad_from_deg(45.0)};  // from the south
  world->meshes = {box("block", {3.0, 0.0, 1.0}, {1.0f, 1.0f, 1.0f}, SurfaceClass::kObstacle)};
  CameraBench bench(world, with(kSmall, {{"picture", std::string("mono")},
                                         {"rotation_deg", std::vector<double>{0.0, 90.0, 0.0}}}));
  bench.step(at(3.0, 0.0, 20.0));
  const auto& info = bench.value<CameraInfo>("rover/s_info");
  // Seen from above, x is up in the picture: y = 2 north of the block is in shadow, y = -2 in
  // light.
  const auto column_of = [&](double y) {
    return static_cast<int>(std::lround(info.cx_px - y * info.fx_px / 20.0));
  };
  const int row = static_cast<int>(std::lround(info.cy_px));
  double shaded = 0.0, lit = 0.0;
  for (int i = -1; i <= 1; ++i) {
    shaded += number(bench.picture(), column_of(2.0) + i, row);
    lit += number(bench.picture(), column_of(-2.0) + i, row);
  }
  EXPECT_LT(shaded, 0.4 * lit);
  EXPECT_GT(shaded, 0.05 * lit);
}

/// Grey of the ground 1 m around (0, y) seen from 30 m above it, the sun in the south.
double grey_of_ground(const std::shared_ptr<WorldModel>& world, double sun_deg, double y) {
  world->daylight = {rad_from_deg(180.0), rad_from_deg(sun_deg)};
  CameraBench bench(world, with(kSmall, {{"picture", std::string("mono")},
                                         {"exposure_s", 1e-4},
                                         {"rotation_deg", std::vector<double>{0.0, 90.0, 0.0}}}));
  bench.step(at(0.0, y, 30.0));
  double sum = 0.0;
  for (int k = -1; k <= 1; ++k) sum += number(bench.picture(), 60 + k, 45);
  return sum;
}

/// Share of the light in the open that reaches the ground around (0, y).
double share_of_light(const std::shared_ptr<WorldModel>& world, double sun_deg, double y) {
  auto open = std::make_shared<WorldModel>();
  open->terrain = small::make_flat(0.0, 401, 1.0);
  return grey_of_ground(world, sun_deg, y) / grey_of_ground(open, sun_deg, y);
}

TEST(Camera, ATallThingsShadowEndsWhereTheSunPassesItsTop) {
  auto world = std::make_shared<WorldModel>();
  world->terrain = small::make_flat(0.0, 401, 1.0);
  world->meshes = {box("tower", {0.0, 0.0, 15.0}, {4.0f, 4.0f, 15.0f}, SurfaceClass::kObstacle)};
  const double end_m = 4.0 + 30.0 / std::tan(rad_from_deg(15.0));
  EXPECT_GT(end_m, 115.0);
  EXPECT_LT(share_of_light(world, 15.0, 30.0), 0.6);
  EXPECT_LT(share_of_light(world, 15.0, end_m - 1.5), 0.6);
  EXPECT_NEAR(share_of_light(world, 15.0, end_m + 1.5), 1.0, 1e-9);
}

TEST(Camera, AHillCastsAShadow) {
  auto world = std::make_shared<WorldModel>();
  // A dam of 8 m, 2 m wide on top.
  world->terrain = small::make_terrain(
      401, 401, 1.0, [](double, double y) { return std::clamp(9.0 - std::abs(y), 0.0, 8.0); });
  const double end_m = 1.0 + 8.0 / std::tan(rad_from_deg(20.0));
  EXPECT_LT(share_of_light(world, 20.0, 0.5 * end_m), 0.6);
  EXPECT_LT(share_of_light(world, 20.0, end_m - 1.5), 0.6);
  EXPECT_NEAR(share_of_light(world, 20.0, end_m + 1.5), 1.0, 1e-9);
}

/// Mean number of a window of a band's picture, 5 x 5 pixels.
double level(const Picture& picture, int x, int y) {
  double sum = 0.0;
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) sum += number(picture, x + i, y + j) / 25.0;
  }
  return sum;
}

/// NDVI and NDRE of places beneath a camera 4 m above the ground, beside a panel of known
/// reflectance, as field campaigns use it.
struct PlantIndices {
  double ndvi, ndre;
};

std::vector<PlantIndices> plant_indices(const std::shared_ptr<WorldModel>& world,
                                        const std::vector<std::pair<double, double>>& y_depth_m) {
  std::map<std::string, std::vector<double>> reflectance;
  for (const char* band : {"red", "red_edge", "nir"}) {
    CameraBench bench(world, with(kSmall, {{"picture", std::string(band)},
                                           {"horizontal_fov_deg", 120.0},
                                           {"rotation_deg", std::vector<double>{0.0, 90.0, 0.0}}}));
    bench.step(at(2.0, 0.0, 4.0));
    const auto& info = bench.value<CameraInfo>("rover/s_info");
    const auto level_at = [&](double y, double depth_m) {
      const auto column = static_cast<int>(std::lround(info.cx_px - y * info.fx_px / depth_m));
      return level(bench.picture(), column, 45);
    };
    const double panel = level_at(-1.0, 3.49) / 0.5;
    for (const auto& [y, depth_m] : y_depth_m) {
      reflectance[band].push_back(level_at(y, depth_m) / panel);
    }
  }
  std::vector<PlantIndices> indices;
  for (std::size_t i = 0; i < y_depth_m.size(); ++i) {
    const double red = reflectance["red"][i], edge = reflectance["red_edge"][i];
    const double nir = reflectance["nir"][i];
    indices.push_back({(nir - red) / (nir + red), (nir - edge) / (nir + edge)});
  }
  return indices;
}

TEST(Camera, NdviIsThatOfLeavesBarkAndSoil) {
  const auto world = flat_world();
  world->soil.name = "tilled_soil";
  // The leaves' and the trunks' own colours (vine_organs.cpp, trellis.cpp).
  const auto plate = [](const char* name, double y, SurfaceClass surface, const Vector3f& colour) {
    return box(name, {2.0, y, 0.5}, {0.4f, 0.4f, 0.01f}, surface, colour);
  };
  world->meshes = {box("panel", {2.0, -1.0, 0.5}, {0.4f, 0.4f, 0.01f}, SurfaceClass::kObstacle),
                   plate("leaf", 1.0, SurfaceClass::kCanopy, {0.055f, 0.135f, 0.032f}),
                   plate("red_leaf", 2.2, SurfaceClass::kCanopy, {0.3f, 0.045f, 0.03f}),
                   plate("yellow_leaf", 3.4, SurfaceClass::kCanopy, {0.55f, 0.38f, 0.042f}),
                   plate("trunk", 4.6, SurfaceClass::kTrunk, {0.075f, 0.052f, 0.036f})};
  const auto found =
      plant_indices(world, {{1.0, 3.49}, {0.0, 4.0}, {2.2, 3.49}, {3.4, 3.49}, {4.6, 3.49}});
  const PlantIndices &leaf = found[0], &soil = found[1], &red_leaf = found[2];
  const PlantIndices &yellow_leaf = found[3], &bark = found[4];
  std::printf(
      "NDVI: leaf %.2f, red leaf %.2f, yellow leaf %.2f, bark %.2f, bare soil %.2f; NDRE of "
      "the leaf %.2f\n",
      leaf.ndvi, red_leaf.ndvi, yellow_leaf.ndvi, bark.ndvi, soil.ndvi, leaf.ndre);
  EXPECT_NEAR(leaf.ndvi, 0.80, 0.10);
  EXPECT_NEAR(leaf.ndre, 0.35, 0.15);
  EXPECT_NEAR(soil.ndvi, 0.15, 0.10);
  // The leaf alone: (0.48 - 0.30) / (0.48 + 0.30) = 0.23 and 0.04; bright grass shines through it.
  EXPECT_NEAR(red_leaf.ndvi, 0.28, 0.08);
  EXPECT_NEAR(yellow_leaf.ndvi, 0.12, 0.05);
  EXPECT_NEAR(bark.ndvi, 0.25, 0.07);
}

TEST(Camera, NdviOfGrassIsBetweenSoilAndLeaves) {
  const auto world = flat_world();
  world->meshes = {box("panel", {2.0, -1.0, 0.5}, {0.4f, 0.4f, 0.01f}, SurfaceClass::kObstacle)};
  double mean[2];
  for (int i = 0; i < 2; ++i) {
    world->soil.name = i == 0 ? "dry_grass" : "wet_grass";
    mean[i] = 0.0;
    std::vector<std::pair<double, double>> places;
    for (double y = 0.5; y < 5.0; y += 0.25) places.emplace_back(y, 4.0);
    for (const PlantIndices& place : plant_indices(world, places)) {
      EXPECT_GT(place.ndvi, 0.05);
      EXPECT_LT(place.ndvi, 0.85);
      mean[i] += place.ndvi / static_cast<double>(places.size());
    }
  }
  std::printf("NDVI: dry grass %.2f, wet grass %.2f\n", mean[0], mean[1]);
  EXPECT_GT(mean[1], 0.35);
  EXPECT_LT(mean[0], mean[1]);
}

/// A panel of 2 m x 2 m seen from 2 m ahead, with a texture.
std::shared_ptr<WorldModel> panel_world(const std::string& texture) {
  auto mesh = std::make_shared<TriangleMesh>();
  // Seen along +x: the left edge is at +y.
  mesh->vertices = {{0, 1, -1}, {0, -1, -1}, {0, -1, 1}, {0, 1, 1}};
  mesh->uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  auto world = flat_world();
  MeshInstance panel =
      small::make_instance("panel", mesh, {2.0, 0.0, 3.0}, SurfaceClass::kObstacle);
  panel.material.colour = {1.0f, 1.0f, 1.0f};
  panel.material.texture = texture;
  world->meshes = {panel};
  return world;
}

TEST(Camera, SeesTexturesTheRightWayUp) {
  const std::filesystem::path file =
      std::filesystem::path(VINEROW_BINARY_DIR) / "test_output" / "camera_texture.png";
  std::filesystem::create_directories(file.parent_path());
  // Quarters of 2 x 2 pixels; sRGB of their red channel, from the top: 60 120 / 180 240.
  imaging::Pixels pixels(4, 4);
  const std::uint8_t reds[] = {60, 120, 180, 240};
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      pixels.at(x, y)[0] = reds[2 * (y / 2) + x / 2];
      pixels.at(x, y)[3] = 255;
    }
  }
  write_whole_file(file, imaging::encode_png(pixels));
  CameraBench textured(panel_world(file.string()),
                       with(kSmall, {{"picture", std::string("red")}, {"exposure_s", 0.0002}}));
  CameraBench plain(panel_world(""),
                    with(kSmall, {{"picture", std::string("red")}, {"exposure_s", 0.0002}}));
  textured.step(at(0.0, 0.0, 3.0));
  plain.step(at(0.0, 0.0, 3.0));
  // Middles of the quarters are 0.5 m from the panel's middle, at a depth of 2 m.
  const auto& info = textured.value<CameraInfo>("rover/s_info");
  const int off = static_cast<int>(std::lround(info.fx_px * 0.5 / 2.0));
  for (std::size_t i = 0; i < 4; ++i) {
    const int x = 60 + (i % 2 == 0 ? -off : off), y = 45 + (i < 2 ? -off : off);
    const double share = level(textured.picture(), x, y) / level(plain.picture(), x, y);
    EXPECT_NEAR(share, linear_from_srgb(reds[i] / 255.0), 0.003) << i;
  }
}

TEST(Camera, RefusesATextureThatItCannotRead) {
  const std::string file = (std::filesystem::path(VINEROW_BINARY_DIR) / "absent.png").string();
  EXPECT_EQ(test::refusal_of([&] { CameraBench(panel_world(file), kSmall); }),
            "texture " + file + ": No such file or directory");
}

TEST(Camera, AnExposureOfItsOwnEndsBeforeTheNextPicture) {
  const auto picture_with = [](double longest_s) {
    const auto world = flat_world();
    world->daylight = {0.0, rad_from_deg(5.0)};
    CameraBench bench(world, with(kSmall, {{"picture", std::string("mono")},
                                           {"readout_s", 0.04},
                                           {"f_number", 32.0},
                                           {"full_well_e", 1e5},
                                           {"exposure_max_s", longest_s}}));
    for (int k = 0; k < 4; ++k) bench.step(at(0.0, 0.0, 1.0));
    return bench.picture().data;
  };
  EXPECT_EQ(picture_with(5.0), picture_with(0.06));
  EXPECT_NE(picture_with(0.03), picture_with(0.06)) << "it is dark enough for the longest";
}

}  // namespace
}  // namespace vinerow::sensors::camera_test
