/// Neighbouring fields in pictures: where they lie on the ground, what they are made of, and that
/// their rows are seen.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/render/grass_tufts.h"
#include "engine/render/land_use.h"
#include "engine/render/scenery_meshes.h"
#include "tests/engine/render/test_scenes.h"

namespace vinerow::render::scenery_test {
namespace {

const Eigen::Vector3d kSun = Eigen::Vector3d(0.0, 1.0, 1.0).normalized();

std::vector<Eigen::Vector2d> square(const Eigen::Vector2d& middle, double half_m) {
  const Eigen::Vector2d x(half_m, 0.0), y(0.0, half_m);
  return {middle - x - y, middle + x - y, middle + x + y, middle - x + y};
}

/// Rows along x, 2.5 m apart, in a square of 60 m around the origin; a track and a tree beside it.
Scenery make_scenery() {
  Scenery scenery;
  SceneryField field;
  field.corners_W = square({0, 0}, 35.0);
  field.planted_W = square({0, 0}, 30.0);
  field.pitch_m = 2.5;
  scenery.fields.push_back(field);
  scenery.tracks.push_back({{-80, -45}, {80, -45}});
  scenery.trees.push_back({{60, 60}, 1});
  return scenery;
}

const std::uint8_t* land_at(const LandUse& land, const Eigen::Vector2d& p) {
  const Eigen::Array2d share = (p - land.corner_W).array() / land.size_m.array();
  return land.pixels.at(static_cast<int>(share.x() * land.pixels.width),
                        static_cast<int>(share.y() * land.pixels.height));
}

TEST(LandUse, KnowsFieldsRowsTracksAndShadeByPlace) {
  const LandUse land = make_land_use(make_scenery(), test::make_level_ground(100.0), kSun);
  EXPECT_EQ(land_at(land, {0, 0})[0], 1);
  EXPECT_EQ(land_at(land, {0, 0})[2], 255);
  EXPECT_EQ(land_at(land, {0, 33})[2], 128);  // headland
  EXPECT_EQ(land_at(land, {0, 40})[0], 0);
  EXPECT_EQ(land_at(land, {0, 37})[2], 0);
  EXPECT_NEAR(land_at(land, {10.2, -45})[1] / 255.0 * LandUse::kReach_m, 0.0, 0.3);
  EXPECT_NEAR(land_at(land, {10.2, -42})[1] / 255.0 * LandUse::kReach_m, 3.0, 0.3);
  EXPECT_EQ(land_at(land, {10.2, -39})[1], 255);
  // The sun stands in the north, 45 deg high: the shadow's middle lies south by the crown's.
  EXPECT_EQ(land_at(land, {60, 60 - 0.55 * kSceneryTrees[1].height_m})[3], 255);
  // Between crown and foot lies the trunk's.
  EXPECT_GT(land_at(land, {60, 60 - 0.5})[3], 128);
  EXPECT_EQ(land_at(land, {61.5, 60 - 0.2})[3], 0);
  EXPECT_EQ(land_at(land, {60, 60 + kSceneryTrees[1].height_m})[3], 0);
}

TEST(SceneryMeshes, RowsStandOnTheGroundWithinTheField) {
  HeightField slope = test::make_level_ground(100.0);
  for (int j = 0; j < slope.rows; ++j) {
    for (int i = 0; i < slope.columns; ++i) {
      slope.heights_m[static_cast<std::size_t>(j * slope.columns + i)] =
          static_cast<float>(0.2 * i * slope.cell_m);
    }
  }
  const SceneryField field = make_scenery().fields[0];
  const PreparedMesh mesh = make_hedges(field, slope);
  // 60 m at 2.5 m from the corner's -35 m: rows at -30, -27.5, ... 30; few triangles a metre.
  double triangles_per_m = static_cast<double>(mesh.indices.size()) / 3.0 / (25 * 60.0);
  EXPECT_GT(triangles_per_m, 0.3);
  EXPECT_LT(triangles_per_m, 1.0);
  for (const GpuVertex& vertex : mesh.vertices) {
    const Eigen::Vector3d p(vertex.position[0], vertex.position[1], vertex.position[2]);
    EXPECT_LE(std::abs(p.x()), 30.0 + 1e-3);
    EXPECT_LE(std::abs(p.y()), 30.0 + field.row_width_m);
    const double above = p.z() - slope.height_m(p.x(), p.y());
    EXPECT_GE(above, field.row_base_m - 1e-3);
    EXPECT_LE(above, 1.1 * field.row_top_m);
  }
  SceneryField meadow = field;
  meadow.pitch_m = 0.0;
  EXPECT_TRUE(make_hedges(meadow, slope).indices.empty());
}

TEST(SceneryMeshes, StemsReachFromTheGroundIntoTheLeaves) {
  const SceneryField field = make_scenery().fields[0];
  const HeightField ground = test::make_level_ground(100.0);
  const PreparedMesh mesh = make_stems(field, ground);
  EXPECT_EQ(mesh.indices.size() / 3, 25 * 2 * 5u);  // a quad for each 12 m of 25 rows of 60 m
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    float low = 1e9f, high = -1e9f;
    for (std::size_t k = 0; k < 3; ++k) {
      const float z = mesh.vertices[mesh.indices[i + k]].position[2];
      low = std::min(low, z);
      high = std::max(high, z);
    }
    EXPECT_LT(low, 0.0f);
    EXPECT_GT(high, field.row_base_m);
    EXPECT_LT(high, field.row_top_m);
  }
  for (const SceneryTreeSize& size : kSceneryTrees) {
    const auto trunk = make_scenery_trunk(size);
    float low = 1e9f, high = -1e9f;
    for (const Eigen::Vector3f& p : trunk->vertices) {
      low = std::min(low, p.z());
      high = std::max(high, p.z());
    }
    EXPECT_LT(low, 0.0f);
    EXPECT_GT(high, scenery_crown_base_m(size) + 0.2);
  }
}

TEST(Scenery, TrunksOfTreesAreSeenFromAfar) {
  WorldModel world;
  world.terrain = test::make_level_ground(200.0);
  world.scenery.trees.push_back({{0, 0}, 1});
  const auto renderer = test::renderer_of(world, {});
  ASSERT_TRUE(renderer);
  Frame frame;
  // 12 cm a pixel, halfway between the ground and the lowest leaves.
  frame.camera = look_at({0, -150, 20}, {0, 0, 1.1}, 2.0 * std::atan(0.12 * 160 / 150.0));
  frame.width = 320;
  frame.height = 320;
  const Image image = renderer->draw(frame);
  // Bark is brown, grass green.
  const auto redness = [&](int x) {
    double sum = 0.0;
    for (int y = 157; y < 163; ++y) {
      const Eigen::Vector3i p = test::pixel(image, x, y);
      sum += (p[0] - p[1]) / 6.0;
    }
    return sum;
  };
  EXPECT_GT(redness(160), redness(145) + 5.0);
  EXPECT_GT(redness(160), redness(175) + 5.0);
}

TEST(GrassTufts, GrowNeitherOnTracksNorOnBareGround) {
  const HeightField field = test::make_level_ground(100.0);
  const imaging::GroundMask mask = imaging::make_ground_mask({});
  const SceneryTrack track{{-50, 3}, {50, 3}};
  const Camera camera = look_at({0, 0, 2}, {10, 3, 0}, 1.0);
  const Frustum frustum(calc_clip_from_world(camera, 1.6, 0.1, 100.0));
  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
  make_grass_tufts({field, mask, {}, 0.0}, camera, frustum, 1.0, vertices, indices);
  const std::size_t without_track = vertices.size();
  make_grass_tufts({field, mask, {&track, 1}, 0.0}, camera, frustum, 1.0, vertices, indices);
  ASSERT_GT(vertices.size(), 1000u);
  EXPECT_LT(vertices.size(), without_track);
  for (const GpuVertex& vertex : vertices) {
    EXPECT_GT(std::abs(vertex.position[1] - 3.0f), 1.3f);  // roots at 1.6 m, blades lean over
  }
  make_grass_tufts({field, mask, {}, 1.0}, camera, frustum, 1.0, vertices, indices);
  EXPECT_TRUE(vertices.empty());
}

/// Mean colour of level ground from above.
Eigen::Vector3d ground_colour(const std::string& soil) {
  WorldModel world;
  world.terrain = test::make_level_ground(100.0);
  world.soil.name = soil;
  Frame frame;
  frame.camera = look_at({0, 0, 30}, {0, 0, 0}, 1.0);
  frame.width = frame.height = 96;
  const auto renderer = test::renderer_of(world, {});
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  if (!renderer) return mean;
  const Image image = renderer->draw(frame);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) mean[c] += test::pixel(image, x, y)[c];
    }
  }
  return mean / (image.width * image.height);
}

TEST(GroundLook, FollowsTheSoil) {
  const Eigen::Vector3d dry = ground_colour("dry_grass"), wet = ground_colour("wet_soil");
  ASSERT_GT(dry.sum(), 0.0);
  EXPECT_GT(dry[1], dry[0]);        // green
  EXPECT_GT(wet[0], wet[1] + 5.0);  // brown
  EXPECT_LT(wet.sum(), 0.85 * dry.sum());
  const Eigen::Vector3d lush = ground_colour("wet_grass");
  EXPECT_GT(lush[1] / lush[0], dry[1] / dry[0]);
  const Eigen::Vector3d asphalt = ground_colour("asphalt");
  EXPECT_LT(asphalt.maxCoeff() - asphalt.minCoeff(), 20.0);  // grey
  EXPECT_EQ(ground_colour("a_soil_of_a_plug_in"), dry);
}

/// How much brightness varies with the rows' pitch over a line of the picture along y:
/// the share of its variance in that one frequency.
double calc_rows_share(const Image& image, double metres_per_pixel, double pitch_m) {
  double share = 0.0;
  constexpr int kLines = 20;
  for (int line = 0; line < kLines; ++line) {
    const int x = image.width / 2 - 50 + 5 * line;
    double mean = 0.0, square = 0.0, real = 0.0, imaginary = 0.0;
    for (int y = 0; y < image.height; ++y) {
      const double v = test::pixel(image, x, y)[1];
      const double phase = 2.0 * 3.14159265358979 * y * metres_per_pixel / pitch_m;
      mean += v / image.height;
      square += v * v / image.height;
      real += v * std::cos(phase) / image.height;
      imaginary += v * std::sin(phase) / image.height;
    }
    share += 2.0 * (real * real + imaginary * imaginary) / (square - mean * mean) / kLines;
  }
  return share;
}

TEST(Scenery, RowsAreSeenFromAboveAndOnlyWhereTheyAre) {
  WorldModel world;
  world.terrain = test::make_level_ground(100.0);
  RendererSettings settings;
  settings.distant_hills = false;
  Frame frame;
  frame.camera = look_at({0, 0, 150}, {0, 0, 0}, 2.0 * std::atan(20.0 / 150.0));  // 40 m high
  frame.width = 320;
  frame.height = 320;
  const double metres_per_pixel = 40.0 / 320;
  const auto bare = test::renderer_of(world, settings);
  ASSERT_TRUE(bare);
  const Image without = bare->draw(frame);
  world.scenery = make_scenery();
  const auto renderer = test::renderer_of(world, settings);
  ASSERT_TRUE(renderer);
  const Image with = renderer->draw(frame);
  EXPECT_GT(calc_rows_share(with, metres_per_pixel, 2.5), 0.25);
  EXPECT_LT(calc_rows_share(without, metres_per_pixel, 2.5), 0.02);
  // The same picture again, and from another renderer.
  EXPECT_EQ(image_digest(renderer->draw(frame)), image_digest(with));
  const auto another = test::renderer_of(world, settings);
  EXPECT_EQ(image_digest(another->draw(frame)), image_digest(with));
}

}  // namespace
}  // namespace vinerow::render::scenery_test
