/// The camera sensor's shutter and samples against closed forms: what moves while a picture is
/// taken.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/engine/sensors/camera_bench.h"
#include "tests/engine/sensors/plate_and_wall.h"

namespace vinerow::sensors::camera_test {
namespace {

/// First column of a row whose label is that of a post.
int first_post_column(const Picture& semantic, int row) {
  for (int x = 0; x < static_cast<int>(semantic.width); ++x) {
    if (number(semantic, x, row) == 6u) return x;
  }
  return -1000;
}

TEST(Camera, RollingShutterLeansWhatItPasses) {
  const auto world = flat_world();
  world->meshes = {box("post", {4.0, 0.0, 0.0}, {0.1f, 0.1f, 20.0f}, SurfaceClass::kPost)};
  const test::SensorValues shutter = {{"width_px", std::int64_t{640}},
                                      {"height_px", std::int64_t{480}},
                                      {"horizontal_fov_deg", 60.0},
                                      {"semantic", true},
                                      {"readout_s", 0.03}};
  CameraBench bench(world, shutter);
  Odometry state;
  state.X_WB = at(0.0, 0.0, 10.0);
  state.v_WB_B = {0.0, 5.0, 0.0};
  bench.step(state);
  const auto& info = bench.value<CameraInfo>("rover/s_info");
  const Picture& semantic = bench.picture("_semantic");
  // Moving to the left, the camera sees the post wander to the right from row to row.
  const double lean_px = 5.0 * 0.03 * info.fx_px / 3.9;
  EXPECT_GT(lean_px, 20.0);
  EXPECT_NEAR(first_post_column(semantic, 479) - first_post_column(semantic, 0), lean_px, 1.01);
  // The same by turning: all at one angular speed, whatever the distance.
  Odometry turning;
  turning.X_WB = at(0.0, 0.0, 10.0);
  turning.w_WB_B = {0.0, 0.0, 1.0};
  bench.step(turning);
  const double turn_px = info.fx_px * 0.03;
  EXPECT_NEAR(first_post_column(bench.picture("_semantic"), 479) -
                  first_post_column(bench.picture("_semantic"), 0),
              turn_px, 1.2);
}

TEST(Camera, NormalsAndDepthOfARowAreInTheRowsOwnFrame) {
  const auto world = flat_world();
  world->meshes = {box("wall", {5.0, 0.0, 0.0}, {0.1f, 30.0f, 20.0f}, SurfaceClass::kObstacle)};
  CameraBench bench(world, with(kSmall, {{"readout_s", 0.09}, {"normals", true}, {"depth", true}}));
  Odometry state;
  state.X_WB = at(0.0, 0.0, 10.0);
  state.w_WB_B = {0.0, 0.0, 1.0};
  bench.step(state);
  const auto& info = bench.value<CameraInfo>("rover/s_info");
  for (const int row : {0, 20, 45, 89}) {
    // Turned to the left, the camera sees the wall's normal turned to the right: towards -x of the
    // optical frame.
    const double angle = (row / 89.0 - 0.5) * 0.09;
    const Vector3d normal_C(-std::sin(angle), 0.0, -std::cos(angle));
    for (const int column : {10, 60, 110}) {
      for (int k = 0; k < 3; ++k) {
        const std::size_t at = 3 * (static_cast<std::size_t>(row) * info.width + column) + k;
        EXPECT_EQ(bench.picture("_normals").data[at], std::lround(127.5 * (normal_C[k] + 1.0)));
      }
      // The plane at 4.9 m along the same normal.
      const Vector3d ray_C((column - info.cx_px) / info.fx_px, (row - info.cy_px) / info.fy_px, 1);
      EXPECT_NEAR(number(bench.picture("_depth"), column, row), 4900.0 / -normal_C.dot(ray_C), 1.0);
    }
  }
}

TEST(Camera, TheOwnBodyKeepsItsPlaceInPicturesOnTheWay) {
  const auto world = flat_world();
  Odometry state;
  state.X_WB = at(0.0, 0.0, 10.0);
  test::PlateAndWall vehicles([&] { return state.X_WB; });
  CameraBench bench(world,
                    with(kSmall, {{"readout_s", 0.06},
                                  {"exposure_s", 0.03},
                                  {"samples", std::int64_t{4}},
                                  {"instance", true},
                                  {"depth", true},
                                  {"normals", true}}),
                    [&]() -> VehicleScene& { return vehicles; });
  struct Seen {
    std::vector<std::uint32_t> things, depth_mm, normal;
  };
  const auto look = [&] {
    bench.step(state);
    Seen seen;
    for (int row = 0; row < 90; ++row) {
      for (int x = 0; x < 120; ++x) {
        seen.things.push_back(number(bench.picture("_instance"), x, row));
        seen.depth_mm.push_back(number(bench.picture("_depth"), x, row));
        seen.normal.push_back(number(bench.picture("_normals"), x, row));
      }
    }
    return seen;
  };
  const Seen still = look();
  const std::uint32_t own = still.things[45 * 120 + 60];
  state.v_WB_B = {6.0, 0.0, 0.0};
  state.w_WB_B = {0.0, 0.0, 0.5};
  const Seen moving = look();
  const auto& info = bench.value<CameraInfo>("rover/s_info");
  int plate = 0, wall = 0;
  for (std::size_t i = 0; i < still.things.size(); ++i) {
    ASSERT_EQ(moving.things[i] == own, still.things[i] == own) << i;
    if (still.things[i] == own) {
      EXPECT_EQ(moving.depth_mm[i], still.depth_mm[i]);
      EXPECT_EQ(moving.normal[i], still.normal[i]);
      ++plate;
    } else {
      // The other's wall, x = 8 m, from where the camera is at the row's time.
      const double time_s = (static_cast<double>(i / 120) / 89.0 - 0.5) * 0.06;
      const double angle = 0.5 * time_s;
      const double left = (info.cx_px - static_cast<double>(i % 120)) / info.fx_px;
      const double depth_m = (8.0 - 6.0 * time_s) / (std::cos(angle) - left * std::sin(angle));
      EXPECT_NEAR(moving.depth_mm[i], 1000.0 * depth_m, 1.0);
      ++wall;
    }
  }
  EXPECT_GT(plate, 300);
  EXPECT_GT(wall, 300);
  EXPECT_NE(moving.depth_mm, still.depth_mm);
}

TEST(Camera, MotionBlurIsAsWideAsTheWayInTheExposure) {
  const auto world = flat_world();
  world->meshes = {box("wall", {4.0, 10.0, 10.0}, {0.1f, 10.0f, 20.0f}, SurfaceClass::kObstacle,
                       {0.9f, 0.9f, 0.9f}),
                   box("dark", {6.0, 0.0, 10.0}, {0.1f, 30.0f, 20.0f}, SurfaceClass::kObstacle,
                       {0.02f, 0.02f, 0.02f})};
  const test::SensorValues blur = {{"picture", std::string("mono")},
                                   {"width_px", std::int64_t{640}},
                                   {"height_px", std::int64_t{16}},
                                   {"horizontal_fov_deg", 60.0},
                                   {"noise", false},
                                   {"shadows", false},
                                   {"samples", std::int64_t{64}},
                                   {"exposure_s", 0.02},
                                   {"f_number", 60.0}};
  CameraBench bench(world, blur);
  Odometry state;
  state.X_WB = at(0.0, 0.0, 10.0);
  state.v_WB_B = {0.0, 2.0, 0.0};
  bench.step(state);
  const auto& info = bench.value<CameraInfo>("rover/s_info");
  const Picture& picture = bench.picture();
  const double bright = number(picture, 5, 8), dark = number(picture, 634, 8);
  ASSERT_GT(bright, 20.0 * dark);
  int between = 0;
  for (int x = 0; x < 640; ++x) {
    const double share = (number(picture, x, 8) - dark) / (bright - dark);
    if (share > 0.05 && share < 0.95) ++between;
  }
  // 40 mm at 3.9 m; the 90 % in the middle of the way.
  const double width_px = 2.0 * 0.02 * info.fx_px / 3.9;
  EXPECT_NEAR(between, 0.9 * width_px, 1.5);
}

TEST(Camera, SamplesOfAPixelLieAboutItsMiddle) {
  // A symmetric panel whose slanted sides cross one pixel in 80 rows: the middle of what it covers
  // is the middle of the picture, if the samples' is that of the pixel.
  auto world = panel_world("");
  auto mesh = std::make_shared<TriangleMesh>(*world->meshes[0].mesh);
  mesh->vertices = {{0, 1, -1}, {0, -1, -1}, {0, -0.975f, 1}, {0, 0.975f, 1}};
  world->meshes[0].mesh = mesh;
  const auto behind_it = flat_world();
  // From the west, so that the panel is brighter than the sky.
  for (const auto& each : {world, behind_it}) each->daylight = {-0.5 * kPi, 0.6};
  const test::SensorValues values = with(kSmall, {{"picture", std::string("red")},
                                                  {"exposure_s", 0.00005},
                                                  {"bits", std::int64_t{16}},
                                                  {"shadows", false},
                                                  {"samples", std::int64_t{4}}});
  CameraBench bench(world, values), empty(behind_it, values);
  bench.step(at(0.0, 0.0, 3.0));
  empty.step(at(0.0, 0.0, 3.0));
  const auto& info = bench.value<CameraInfo>("rover/s_info");
  double middle = 0.0;
  const int first = 5, last = 85;
  for (int y = first; y < last; ++y) {
    const double panel = number(bench.picture(), 60, y);
    double sum = 0.0, moment = 0.0;
    for (int x = 0; x < 120; ++x) {
      const double behind = number(empty.picture(), x, y);
      const double share = (number(bench.picture(), x, y) - behind) / (panel - behind);
      sum += share;
      moment += share * x;
    }
    middle += moment / sum / (last - first);
  }
  EXPECT_NEAR(middle, info.cx_px, 0.01);
}

}  // namespace
}  // namespace vinerow::sensors::camera_test
