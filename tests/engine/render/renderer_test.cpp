#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "engine/render/cameras.h"
#include "engine/render/scene.h"
#include "tests/engine/render/test_scenes.h"
#include "tests/support/paths.h"

namespace vinerow::render::renderer_test {
namespace {

using test::is_red;
using test::make_box;
using test::make_instance;
using test::renderer_of;

const Eigen::Vector3f kRed(0.8f, 0.01f, 0.01f);
const Eigen::Vector3f kBlue(0.02f, 0.05f, 0.9f);

bool is_blue(const Eigen::Vector3i& p) {
  return p[2] > 80 && p[2] > 2 * p[0] && p[2] > 3 * p[1] / 2;
}

/// Sun in the west, so that what faces -x is lit.
WorldModel western_light() {
  WorldModel world;
  world.daylight.sun_azimuth_rad = 1.5 * kPi;
  world.daylight.sun_elevation_rad = 0.6;
  return world;
}

Frame small_frame(const Camera& camera, int width = 320, int height = 240) {
  Frame frame;
  frame.camera = camera;
  frame.width = width;
  frame.height = height;
  return frame;
}

TEST(Renderer, WithoutItsLibrarySaysSo) {
  setenv("VINEROW_OSMESA", "/nonexistent/libOSMesa.so", 1);
  const Result<std::unique_ptr<Renderer>> made = make_renderer(WorldModel{});
  unsetenv("VINEROW_OSMESA");
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.reason().find("/nonexistent/libOSMesa.so cannot be loaded: "), 0u)
      << made.reason();
}

TEST(Renderer, AnEmptyWorldShowsTheSky) {
  const auto renderer = renderer_of(WorldModel{});
  ASSERT_TRUE(renderer);
  const Image image = renderer->draw(small_frame(look_at({0, 0, 2}, {0, 10, 4})));
  ASSERT_EQ(image.rgb.size(), 320u * 240u * 3u);
  const Eigen::Vector3i zenith = test::pixel(image, 160, 5);
  EXPECT_GT(zenith[2], zenith[0]);  // blue
}

/// Colours of the sky are computed at few pixels, the sun's disc at each: both are where the
/// pinhole model puts the sun, with every pattern of samples.
TEST(Renderer, TheSunAndItsGlowAreInTheSunsDirection) {
  WorldModel world = western_light();
  world.daylight.cloud_cover = 0.0;
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  const Eigen::Vector3d eye_W(0, 0, 2);
  const double up = world.daylight.sun_elevation_rad;
  const Eigen::Vector3d sun_W(-std::cos(up), 0.0, std::sin(up));
  for (const int samples : {1, 2, 4}) {
    // The sun in the left upper quarter.
    const Eigen::Vector3d ahead_W = sun_W + Eigen::Vector3d(0.0, 0.12, -0.12);
    Frame frame = small_frame(look_at(eye_W, eye_W + ahead_W, 0.6), 401, 302);
    frame.samples = samples;
    const Image image = renderer->draw(frame);
    Eigen::Vector2d sun_px;
    ASSERT_TRUE(project(frame.camera, 401, 302, eye_W + 1e6 * sun_W, sun_px));
    double weight = 0.0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int y = 0; y < 302; ++y) {
      for (int x = 0; x < 401; ++x) {
        const double bright = std::max(0, test::pixel(image, x, y)[0] - 200);
        weight += bright;
        sum += bright * Eigen::Vector2d(x + 0.5, y + 0.5);
      }
    }
    ASSERT_GT(weight, 0.0);
    EXPECT_LT((sum / weight - sun_px).norm(), 0.6) << samples;
    EXPECT_GE(test::pixel(image, static_cast<int>(sun_px.x()), static_cast<int>(sun_px.y()))[2],
              250)
        << samples;
  }
}

TEST(Renderer, RefusesSizesThatNoPictureHas) {
  const auto renderer = renderer_of(WorldModel{});
  ASSERT_TRUE(renderer);
  try {
    renderer->draw(small_frame(look_at({0, 0, 2}, {0, 10, 2}), 0, 100));
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "a picture of 0 x 100 pixels cannot be drawn: each side is 1 to 8192");
  }
}

TEST(Renderer, ACubeIsWhereThePinholeModelPutsIt) {
  WorldModel world = western_light();
  world.meshes.push_back(make_instance("cube", make_box({0.5f, 0.5f, 0.5f}), {10, 0.7, 1}, kRed));
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  // From the origin along x the near face, 9.5 m away, covers the whole cube.
  Frame frame = small_frame(look_at({0, 0, 1}, {10, 0, 1}, 0.3), 400, 300);
  const double focal_px = 150.0 / std::tan(0.15);
  const double middle_x = 200.0 - focal_px * 0.7 / 9.5;
  const double half = focal_px * 0.5 / 9.5;
  for (const int samples : {1, 2, 4}) {
    frame.samples = samples;
    const Eigen::AlignedBox2i box = test::box_of(renderer->draw(frame), is_red);
    ASSERT_FALSE(box.isEmpty());
    // One pixel: edges lie anywhere inside a pixel.
    EXPECT_NEAR(box.min().x(), middle_x - half, 1.0);
    EXPECT_NEAR(box.max().x() + 1, middle_x + half + focal_px * 0.2 * (1 / 9.5 - 1 / 10.5), 1.2);
    EXPECT_NEAR(box.min().y(), 150.0 - half, 1.0);
    EXPECT_NEAR(box.max().y() + 1, 150.0 + half, 1.0);
  }
}

TEST(Renderer, OrthographicViewFromAboveIsToScale) {
  WorldModel world = western_light();
  world.terrain = test::make_level_ground(30.0);
  world.meshes.push_back(make_instance("cube", make_box({1, 2, 0.5f}), {6, -4, 0.5}, kRed));
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  Camera camera = look_at({0, 0, 50}, {0, 0, 0});
  camera.orthographic = true;
  camera.ortho_height_m = 30.0;  // 10 px a metre
  const Eigen::AlignedBox2i box =
      test::box_of(renderer->draw(small_frame(camera, 400, 300)), is_red);
  EXPECT_NEAR(box.min().x(), 200 + 50, 1);
  EXPECT_NEAR(box.max().x() + 1, 200 + 70, 1);
  EXPECT_NEAR(box.min().y(), 150 + 20, 1);  // north is up
  EXPECT_NEAR(box.max().y() + 1, 150 + 60, 1);
}

TEST(Renderer, NearThingsHideFarOnesInEitherOrder) {
  for (const bool near_first : {false, true}) {
    WorldModel world = western_light();
    MeshInstance near = make_instance("near", make_box({0.1f, 2, 2}), {5, 0, 1}, kBlue);
    MeshInstance far = make_instance("far", make_box({0.1f, 1, 1}), {8, 0, 1}, kRed);
    world.meshes = near_first ? std::vector{near, far} : std::vector{far, near};
    const auto renderer = renderer_of(world);
    ASSERT_TRUE(renderer);
    const Image image = renderer->draw(small_frame(look_at({0, 0, 1}, {10, 0, 1})));
    EXPECT_TRUE(test::box_of(image, is_red).isEmpty());
    EXPECT_TRUE(is_blue(test::pixel(image, 160, 120)));
  }
}

WorldModel busy_world() {
  WorldModel world = western_light();
  world.terrain = test::make_level_ground(60.0);
  for (int i = 0; i < 12; ++i) {
    for (int k = 0; k < 12; ++k) {
      MeshInstance cube =
          make_instance("c", make_box({0.3f, 0.4f, 1.0f}), {-30.0 + 5 * i, -30.0 + 5 * k, 1}, kRed);
      if ((i + k) % 3 == 0) cube.surface = SurfaceClass::kPost;
      world.meshes.push_back(cube);
    }
  }
  return world;
}

TEST(Renderer, CullingChangesNoPixel) {
  const WorldModel world = busy_world();
  RendererSettings all;
  all.cull = false;
  const auto culled = renderer_of(world);
  const auto whole = renderer_of(world, all);
  ASSERT_TRUE(culled && whole);
  const Camera cameras[] = {
      look_at({-35, -35, 3}, {0, 0, 0}), look_at({2, 3, 1.2}, {12, 9, 1}),
      look_at({0, 0, 40}, {1, 1, 0}),
      top_camera({Eigen::Vector3d(-9, -9, 0), Eigen::Vector3d(9, 9, 2)}, 4.0 / 3)};
  for (const Camera& camera : cameras) {
    const Frame frame = small_frame(camera);
    EXPECT_EQ(image_digest(culled->draw(frame)), image_digest(whole->draw(frame)));
    EXPECT_LT(culled->statistics().triangles, whole->statistics().triangles);
  }
}

TEST(Renderer, DrawsTheLevelOfDetailThatSuitsTheDistance) {
  WorldModel world = western_light();
  // Listed in odd order on purpose.
  world.meshes.push_back(make_instance("wall#lod1", make_box({0.1f, 1, 1}), {0, 0, 1}, kBlue));
  world.meshes.push_back(make_instance("wall#lod0", make_box({0.1f, 1, 1}), {0, 0, 1}, kRed));
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  EXPECT_TRUE(is_red(
      test::pixel(renderer->draw(small_frame(look_at({-3, 0, 1}, {0, 0, 1}, 0.5))), 160, 120)));
  const Image far = renderer->draw(small_frame(look_at({-60, 0, 1}, {0, 0, 1}, 0.2)));
  EXPECT_TRUE(is_blue(test::pixel(far, 160, 120)));
  EXPECT_TRUE(test::box_of(far, is_red).isEmpty());  // never both
}

/// 20 px a metre from above, north up, (0, 0) in the middle.
Frame overhead_frame() {
  Camera camera = look_at({0, 0, 50}, {0, 0, 0});
  camera.orthographic = true;
  camera.ortho_height_m = 15.0;
  return small_frame(camera, 400, 300);
}

Eigen::Vector2d overhead_pixel(double x, double y) {
  return {200 + 20 * x, 150 - 20 * y};
}

TEST(Renderer, ShadowsFallWhereTheSunSaysSo) {
  WorldModel world;
  world.terrain = test::make_level_ground(30.0);
  // A plate 3 m above the ground; sun in the south-west at 40 deg: the shadow lies in the
  // north-east.
  world.daylight.sun_azimuth_rad = rad_from_deg(225);
  world.daylight.sun_elevation_rad = rad_from_deg(40);
  world.meshes.push_back(
      make_instance("plate", make_box({0.7f, 0.7f, 0.02f}), {-2, -1, 3}, {0.7f, 0.7f, 0.7f}));
  const auto renderer = renderer_of(world);
  RendererSettings no_shadows;
  no_shadows.shadows = false;
  const auto bare = renderer_of(world, no_shadows);
  ASSERT_TRUE(renderer && bare);
  const Image image = renderer->draw(overhead_frame());
  const Image lit = bare->draw(overhead_frame());
  const double reach = 3.0 / std::tan(rad_from_deg(40)) / std::sqrt(2.0);
  const Eigen::Vector2d inside = overhead_pixel(-2 + reach, -1 + reach);
  EXPECT_LT(test::brightness(image, inside), 0.75 * test::brightness(lit, inside));
  // Its edges are where they should be: 10 cm inside is dark, 10 cm outside is light.
  for (const auto& [dx, dy] : {std::pair{0.7, 0.0}, {-0.7, 0.0}, {0.0, 0.7}, {0.0, -0.7}}) {
    const double s = 0.15 / 0.7;
    const Eigen::Vector2d in = overhead_pixel(-2 + reach + dx * (1 - s), -1 + reach + dy * (1 - s));
    const Eigen::Vector2d out =
        overhead_pixel(-2 + reach + dx * (1 + s), -1 + reach + dy * (1 + s));
    EXPECT_LT(test::brightness(image, in), 0.8 * test::brightness(lit, in));
    EXPECT_NEAR(test::brightness(image, out), test::brightness(lit, out), 6.0);
  }
}

struct Cart {
  std::vector<VehicleLink> links;
  Cart() {
    VehicleLink body;
    body.name = "body";
    body.mesh = make_box({0.5f, 0.3f, 0.2f});
    body.material.colour = kRed;
    links.push_back(body);
  }
  VehicleDrawing at(double x, double y) const {
    return {&links, {Pose{Eigen::Quaterniond::Identity(), {x, y, 0.6}}}};
  }
};

TEST(Renderer, APictureDoesNotDependOnThePicturesBefore) {
  const WorldModel world = busy_world();
  const Cart cart;
  const auto first = renderer_of(world);
  const auto second = renderer_of(world);
  ASSERT_TRUE(first && second);
  Frame here = small_frame(look_at({-8, -6, 3}, {0, 0, 0}));
  here.vehicles = {cart.at(0, 0)};
  Frame there = small_frame(look_at({25, 20, 3}, {12, 9, 0}), 200, 100);
  there.vehicles = {cart.at(12, 9), cart.at(3, 1)};
  there.samples = 1;
  const std::string expected = image_digest(second->draw(here));
  EXPECT_EQ(image_digest(first->draw(here)), expected);
  EXPECT_EQ(image_digest(first->draw(here)), expected);
  const std::string other = image_digest(first->draw(there));
  EXPECT_NE(other, expected);
  // Shadows of vehicles that have left are gone.
  EXPECT_EQ(image_digest(first->draw(here)), expected);
  EXPECT_EQ(image_digest(second->draw(there)), other);
}

TEST(Renderer, VehiclesCastShadows) {
  WorldModel world;
  world.terrain = test::make_level_ground(30.0);
  world.daylight.sun_azimuth_rad = kPi;  // south
  world.daylight.sun_elevation_rad = rad_from_deg(30);
  const Cart cart;
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  Frame frame = overhead_frame();
  const Image empty = renderer->draw(frame);
  frame.vehicles = {cart.at(1, -2)};
  const Image image = renderer->draw(frame);
  const Eigen::Vector2d shadow = overhead_pixel(1, -2 + 0.6 / std::tan(rad_from_deg(30)));
  EXPECT_LT(test::brightness(image, shadow), 0.75 * test::brightness(empty, shadow));
}

TEST(Renderer, LinesHaveTheirColourWidthAndTransparency) {
  WorldModel world;
  world.terrain = test::make_level_ground(30.0);
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  Frame frame = overhead_frame();
  const Image before = renderer->draw(frame);
  Polyline line;
  line.colour = {1, 0, 1};
  line.width_px = 8;
  line.points_W = {{-4, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}, {0, -3, 0}};
  frame.lines = {line};
  const Image opaque = renderer->draw(frame);
  const Eigen::Vector2i inside = overhead_pixel(-2, 0).cast<int>();
  EXPECT_EQ(test::pixel(opaque, inside.x(), inside.y()), Eigen::Vector3i(255, 0, 255));
  const auto magenta = [](const Eigen::Vector3i& p) { return p == Eigen::Vector3i(255, 0, 255); };
  EXPECT_EQ(test::pixel(opaque, inside.x(), inside.y() + 6),
            test::pixel(before, inside.x(), inside.y() + 6));
  EXPECT_NEAR(test::box_of(opaque, magenta).min().x(), 120, 1);

  frame.lines[0].alpha = 0.5f;
  const Image half = renderer->draw(frame);
  // Where the line crosses itself it is as transparent as elsewhere. 4 units: means of four pixels
  // are taken of squares.
  for (const Eigen::Vector2i& place : {inside, Eigen::Vector2i(overhead_pixel(0, 0).cast<int>())}) {
    const Eigen::Vector3i below = test::pixel(before, place.x(), place.y());
    const Eigen::Vector3i seen = test::pixel(half, place.x(), place.y());
    EXPECT_NEAR(seen[0], 0.5 * (below[0] + 255), 4);
    EXPECT_NEAR(seen[1], 0.5 * below[1], 4);
  }

  frame.lines[0].alpha = 1.0f;
  frame.lines[0].dashed = true;
  const Image dashed = renderer->draw(frame);
  int gaps = 0;
  for (int x = 130; x < 270; ++x) gaps += magenta(test::pixel(dashed, x, inside.y())) ? 0 : 1;
  EXPECT_GT(gaps, 35);
  EXPECT_LT(gaps, 80);
}

TEST(Renderer, LinesBehindWallsAreHidden) {
  WorldModel world = western_light();
  world.meshes.push_back(make_instance("wall", make_box({0.1f, 2, 2}), {5, 0, 1}, kBlue));
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  Frame frame = small_frame(look_at({0, 0, 1}, {10, 0, 1}));
  Polyline line;
  line.colour = {1, 0, 0};
  line.points_W = {{8, -1, 1}, {8, 1, 1}};
  frame.lines = {line};
  EXPECT_TRUE(test::box_of(renderer->draw(frame), is_red).isEmpty());
}

TEST(Renderer, LinesBehindWallsShowThroughWhereTheyAreToldTo) {
  WorldModel world = western_light();
  // The wall hides y < 0, the right half of the picture.
  world.meshes.push_back(make_instance("wall", make_box({0.1f, 1, 2}), {5, -1, 1}, kBlue));
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  Frame frame = small_frame(look_at({0, 0, 1}, {10, 0, 1}));
  const Image before = renderer->draw(frame);
  Polyline line;
  line.colour = {1, 0, 1};
  line.width_px = 8;
  line.alpha = 1.0f;
  line.hidden_alpha = 0.5f;
  line.points_W = {{8, 1, 1}, {8, -1, 1}, {8, -0.9, 1}};  // back over itself where it is hidden
  frame.lines = {line};
  const Image image = renderer->draw(frame);
  // 8 m ahead 1 m are 120 / tan(0.48) / 8 = 28.8 pixels.
  EXPECT_EQ(test::pixel(image, 160 - 15, 120), Eigen::Vector3i(255, 0, 255));
  for (const int x : {160 + 15, 160 + 27}) {
    const Eigen::Vector3i below = test::pixel(before, x, 120);
    const Eigen::Vector3i seen = test::pixel(image, x, 120);
    EXPECT_NEAR(seen[0], 0.5 * (below[0] + 255), 4) << x;
    EXPECT_NEAR(seen[1], 0.5 * below[1], 4) << x;
    EXPECT_NEAR(seen[2], 0.5 * (below[2] + 255), 4) << x;
  }
  EXPECT_EQ(test::pixel(image, 160 + 40, 120), test::pixel(before, 160 + 40, 120)) << "its end";
}

TEST(Renderer, CaptionIsPartOfThePicture) {
  const auto renderer = renderer_of(WorldModel{});
  ASSERT_TRUE(renderer);
  Frame frame = small_frame(look_at({0, 0, 2}, {0, 10, 2}));
  const std::string without = image_digest(renderer->draw(frame));
  frame.caption = {"vineyard", "t = 1.0 s"};
  if (!std::filesystem::exists("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")) {
    GTEST_SKIP() << "no DejaVu fonts";
  }
  EXPECT_NE(image_digest(renderer->draw(frame)), without);
}

// From above, 40 m in 240 pixels: a hull of 10 m x 4 m is 60 x 24 of 320 x 240 pixels.
TEST(Renderer, MeasuresHowMuchOfAVehicleIsSeen) {
  WorldModel world = western_light();
  world.terrain = test::make_level_ground(60.0);
  // A roof over its western half.
  world.meshes.push_back(make_instance("roof", make_box({2.5f, 4.0f, 0.1f}), {-2.5, 0, 5}, kRed));
  std::vector<VehicleLink> links(1), others(1);
  links[0].mesh = make_box({5.0f, 2.0f, 0.5f});
  others[0].mesh = make_box({1.0f, 1.0f, 0.5f});
  Frame frame = small_frame(
      top_camera({Eigen::Vector3d(-20, -20, 0), Eigen::Vector3d(20, 20, 2)}, 4.0 / 3, 0.0));
  frame.vehicles = {{&links, {Pose{}}, "hull"}, {&others, {Pose{}}, "far"}};
  frame.vehicles[0].X_WL[0].p = {0, 0, 1};
  frame.vehicles[1].X_WL[0].p = {100, 0, 1};
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  for (const int samples : {1, 2, 4}) {
    frame.samples = samples;
    const Image plain = renderer->draw(frame);
    ASSERT_EQ(renderer->statistics().vehicle_shares.size(), 2u);
    const double whole = 60.0 * 24.0 / (320.0 * 240.0);
    EXPECT_NEAR(renderer->statistics().vehicle_shares[0], 0.5 * whole, 0.03 * whole);
    EXPECT_EQ(renderer->statistics().vehicle_shares[1], 0.0);
    // Lines are not part of what is seen, and are drawn over it as before.
    frame.lines.resize(1);
    frame.lines[0].points_W = {{-15, 0, 9}, {15, 0, 9}};
    frame.lines[0].width_px = 30.0f;
    EXPECT_NE(renderer->draw(frame).rgb, plain.rgb);
    EXPECT_NEAR(renderer->statistics().vehicle_shares[0], 0.5 * whole, 0.03 * whole);
    frame.lines.clear();
  }
}

TEST(Renderer, TheCaptionMakesRoomForAVehicle) {
  std::vector<VehicleLink> links(1);
  links[0].mesh = make_box({2.0f, 2.0f, 0.5f});
  WorldModel world = western_light();
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  Frame frame = small_frame(
      top_camera({Eigen::Vector3d(-20, -20, 0), Eigen::Vector3d(20, 20, 2)}, 4.0 / 3, 0.0));
  frame.vehicles = {{&links, {Pose{}}, "hull"}};
  const auto panel_with_hull_at = [&](const Eigen::Vector3d& p_W) {
    frame.vehicles[0].X_WL[0].p = p_W;
    frame.caption.clear();
    const Image plain = renderer->draw(frame);
    frame.caption = {"x"};
    const Image captioned = renderer->draw(frame);
    Eigen::AlignedBox2i box;
    for (int y = 0; y < plain.height; ++y) {
      for (int x = 0; x < plain.width; ++x) {
        if (test::pixel(plain, x, y) != test::pixel(captioned, x, y))
          box.extend(Eigen::Vector2i(x, y));
      }
    }
    return box;
  };
  const Eigen::AlignedBox2i usual = panel_with_hull_at({0, 0, 1});
  if (usual.isEmpty()) GTEST_SKIP() << "no DejaVu fonts";
  EXPECT_LT(usual.max().x(), 160);
  // In the lower left corner of a picture of 53 m x 40 m.
  const Eigen::AlignedBox2i other = panel_with_hull_at({-24, -17, 1});
  EXPECT_GT(other.min().x(), 160);
  EXPECT_GT(other.min().y(), 120);
}

TEST(Renderer, MarkersAreRingsAndOutsideThePictureArrowsWithTheWay) {
  WorldModel world = western_light();
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  Frame frame = small_frame(
      top_camera({Eigen::Vector3d(-20, -20, 0), Eigen::Vector3d(20, 20, 2)}, 4.0 / 3, 0.0));
  const auto is_magenta = [](const Eigen::Vector3i& p) {
    return p[0] > 180 && p[2] > 180 && p[1] < 110;
  };
  EXPECT_TRUE(test::box_of(renderer->draw(frame), is_magenta).isEmpty());
  // 6 pixels are a metre: (10, 5) is 60 right of the middle and 30 above it.
  frame.markers = {{{10, 5, 1}, 0.5, "rover", {1, 0, 1}}};
  const Eigen::AlignedBox2i ring = test::box_of(renderer->draw(frame), is_magenta);
  ASSERT_FALSE(ring.isEmpty());
  EXPECT_NEAR(0.5 * (ring.min() + ring.max() + Eigen::Vector2i(1, 1)).x(), 220.0, 1.0);
  EXPECT_NEAR(0.5 * (ring.min() + ring.max() + Eigen::Vector2i(1, 1)).y(), 90.0, 1.0);
  // What is as large as a quarter of the picture needs no ring, its name stands beside it.
  frame.markers[0].radius_m = 10.0;
  const Image named = renderer->draw(frame);
  EXPECT_TRUE(test::box_of(named, is_magenta).isEmpty());
  frame.markers[0].text.clear();
  EXPECT_NE(named.rgb, renderer->draw(frame).rgb);
  frame.markers[0].radius_m = 0.5;
  // Due west, far outside: at the left edge, half way up.
  frame.markers[0].p_W = {-500, 0, 1};
  const Eigen::AlignedBox2i arrow = test::box_of(renderer->draw(frame), is_magenta);
  ASSERT_FALSE(arrow.isEmpty());
  EXPECT_LT(arrow.max().x(), 40);
  EXPECT_NEAR(arrow.center().y(), 120, 2);
}

// A bar is the longest of 1, 2, 5 times a power of ten that takes no more than 0.16 of the width:
// 53.3 m wide, 8.5 m, so 5 m, which are 30 pixels.
TEST(Renderer, TheScaleBarIsAsLongAsItSays) {
  const auto renderer = renderer_of(western_light());
  ASSERT_TRUE(renderer);
  Frame frame = small_frame(
      top_camera({Eigen::Vector3d(-20, -20, 0), Eigen::Vector3d(20, 20, 2)}, 4.0 / 3, 0.0));
  frame.show_scale = true;
  const Image image = renderer->draw(frame);
  int longest = 0;
  for (int y = 120; y < 240; ++y) {
    int run = 0;
    for (int x = 160; x < 320; ++x) {
      run = test::pixel(image, x, y).minCoeff() > 200 ? run + 1 : 0;
      longest = std::max(longest, run);
    }
  }
  EXPECT_NEAR(longest, 30, 2);
}

TEST(Renderer, ImageTexturesStandUpright) {
  // Upper half of the file red, lower half blue.
  Image picture{4, 4, {}};
  for (int i = 0; i < 16; ++i) {
    const bool upper = i < 8;
    picture.rgb.insert(picture.rgb.end(), {static_cast<std::uint8_t>(upper ? 230 : 5), 5,
                                           static_cast<std::uint8_t>(upper ? 5 : 230)});
  }
  const auto folder = std::filesystem::path(VINEROW_BINARY_DIR) / "test_output";
  std::filesystem::create_directories(folder);
  const std::string file = (folder / "halves.png").string();
  write_png(file, picture);
  auto wall = std::make_shared<TriangleMesh>();
  for (const auto& [u, v] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
    wall->vertices.emplace_back(5.0f, 1.0f - 2.0f * u, 2.0f * v);
    wall->uvs.emplace_back(u, v);
  }
  wall->triangles = {{0, 2, 1}, {0, 3, 2}};
  WorldModel world = western_light();
  world.meshes.push_back(make_instance("wall", wall, {0, 0, 0}, {1, 1, 1}));
  world.meshes[0].material.texture = file;
  for (const bool missing : {false, true}) {
    if (missing) world.meshes[0].material.texture = "/nonexistent/texture.png";
    const auto renderer = renderer_of(world);
    ASSERT_TRUE(renderer);
    const Image image = renderer->draw(small_frame(look_at({0, 0, 1}, {5, 0, 1})));
    EXPECT_EQ(is_red(test::pixel(image, 160, 95)), !missing);
    EXPECT_EQ(is_blue(test::pixel(image, 160, 145)), !missing);
  }
}

/// A card of leaves 1 m away, whose canopy faces along `normal`, before a red wall.
Image draw_leaves(const Eigen::Vector3f& normal) {
  WorldModel world = western_light();
  auto card = std::make_shared<TriangleMesh>();
  for (const auto& [u, v] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
    card->vertices.emplace_back(0.0f, 0.2f - 0.4f * u, 0.4f * v);
    card->normals.push_back(normal);
    card->uvs.emplace_back(u, v);
  }
  card->triangles = {{0, 1, 2}, {0, 2, 3}};
  MeshInstance leaves = make_instance("leaves", card, {1, 0, 0.8}, {1, 1, 1});
  leaves.material.leaf_cards = true;
  leaves.material.texture = "builtin:vine_leaf";
  world.meshes = {leaves, make_instance("wall", make_box({0.1f, 2, 2}), {3, 0, 1}, kRed)};
  const auto renderer = renderer_of(world);
  return renderer ? renderer->draw(small_frame(look_at({0, 0, 1}, {5, 0, 1}, 0.3))) : Image{};
}

/// Of the middle of draw_leaves().
struct SeenLeaves {
  int green = 0, red = 0;    ///< pixels
  double green_level = 0.0;  ///< mean of the green ones
};
SeenLeaves see_leaves(const Eigen::Vector3f& normal) {
  const Image image = draw_leaves(normal);
  SeenLeaves seen;
  for (int y = 60; y < 180 && !image.rgb.empty(); ++y) {
    for (int x = 100; x < 220; ++x) {
      const Eigen::Vector3i p = test::pixel(image, x, y);
      if (is_red(p)) ++seen.red;
      if (p[1] <= p[0] || p[1] <= p[2]) continue;
      ++seen.green;
      seen.green_level += p[1];
    }
  }
  seen.green_level /= seen.green;
  return seen;
}

TEST(Renderer, LeafCardsAreSeenThroughBetweenTheLeaves) {
  const SeenLeaves seen = see_leaves(-Eigen::Vector3f::UnitX());
  EXPECT_GT(seen.green, 5000);  // of 14400
  EXPECT_GT(seen.red, 300);
}

/// Leaves that face the sun reflect its light. Those that face away let about a third through: by
/// leaf_light() 0.86 and 0.37 of it, to which sky and ground add.
TEST(Renderer, LeavesTowardsTheSunAreBrighter) {
  const double towards = see_leaves(-Eigen::Vector3f::UnitX()).green_level;
  EXPECT_GT(towards, 1.15 * see_leaves(Eigen::Vector3f::UnitY()).green_level);
  EXPECT_GT(towards, 1.15 * see_leaves(Eigen::Vector3f::UnitX()).green_level);
}

TEST(Renderer, LeavesAreLitInTheWholePicture) {
  // A wall of cards fills a wide picture: its corners are as bright with every pattern of samples.
  WorldModel world = western_light();
  auto cards = std::make_shared<TriangleMesh>();
  for (int i = 0; i < 60 * 20; ++i) {
    const float y = 0.1f * static_cast<float>(i % 60) - 3.0f;
    const float z = 0.1f * static_cast<float>(i / 60);
    const auto first = static_cast<std::uint32_t>(cards->vertices.size());
    for (const auto& [u, v] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
      cards->vertices.emplace_back(0.0f, y - 0.2f * u, z + 0.2f * v);
      cards->normals.emplace_back(-1.0f, 0.0f, 0.0f);
      cards->uvs.emplace_back(u, v);
    }
    cards->triangles.push_back({first, first + 1, first + 2});
    cards->triangles.push_back({first, first + 2, first + 3});
  }
  MeshInstance leaves = make_instance("leaves", cards, {2, 0, 0}, {1, 1, 1});
  leaves.material.leaf_cards = true;
  leaves.material.texture = "builtin:vine_leaf";
  world.meshes = {leaves};
  const auto renderer = renderer_of(world);
  ASSERT_TRUE(renderer);
  Frame frame = small_frame(look_at({0, 0, 1}, {5, 0, 1}, 0.5), 400, 160);
  const auto corner_mean = [](const Image& image, int x0, int y0) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < 40 * 40; ++i) {
      sum += test::pixel(image, x0 + i % 40, y0 + i / 40).cast<double>();
    }
    return Eigen::Vector3d(sum / 1600.0);
  };
  frame.samples = 9;
  const Image best = renderer->draw(frame);
  for (const int samples : {1, 2, 4}) {
    frame.samples = samples;
    const Image image = renderer->draw(frame);
    for (const int x : {0, 360}) {
      for (const int y : {0, 120}) {
        const Eigen::Vector3d mean = corner_mean(image, x, y);
        EXPECT_GT(mean.y(), 1.3 * mean.z()) << samples << " samples at " << x << ", " << y;
        EXPECT_LT((mean - corner_mean(best, x, y)).norm(), 6.0)
            << samples << " samples at " << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace vinerow::render::renderer_test
