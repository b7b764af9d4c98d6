/// The camera sensor against closed forms: depth, labels, shutter, blur, bands, noise of depth.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <thread>

#include "engine/api/messages/camera.h"
#include "engine/core/parallel.h"
#include "engine/core/whole_file.h"
#include "engine/imaging/png.h"
#include "engine/math/angles.h"
#include "engine/math/srgb.h"
#include "engine/physics/static_scene.h"
#include "tests/engine/physics/small_worlds.h"
#include "tests/engine/sensors/plate_and_wall.h"
#include "tests/engine/sensors/sensor_bench.h"
#include "tests/engine/sensors/sensor_parts.h"
#include "tests/support/paths.h"

namespace vinerow::sensors::camera_test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
namespace small = physics::test;

/// A camera on a vehicle that is where the test says.
class CameraBench {
 public:
  CameraBench(std::shared_ptr<const WorldModel> world, const test::SensorValues& values,
              std::function<VehicleScene&()> vehicles = {})
      : scene_(world), world_(world) {
    SensorContext context = bench_.context(10.0);
    context.vehicles = std::move(vehicles);
    context.scene = &scene_.queries();
    context.light = [this]() -> const RayScene& { return scene_.light(); };
    context.world = world_.get();
    const ParameterSet parameters = test::sensor_parameters("camera", values);
    sensor_ = test::sensor_registry().make_sensor("camera", parameters, context);
    bench_.connect(*sensor_);
  }

  void step(const Odometry& state) {
    bench_.truth.write(now_, state);
    sensor_->step(now_);
    now_ = now_ + Duration{100'000'000};
  }
  void step(const Pose& X_WB) {
    Odometry state;
    state.X_WB = X_WB;
    step(state);
  }

  template <class T>
  const T& value(const std::string& name) {
    return static_cast<const Signal<T>&>(*bench_.bus.find(name)).value();
  }
  const Picture& picture(const char* layer = "") {
    return value<Picture>(std::string("rover/s") + layer);
  }
  const RayScene& light() const { return scene_.light(); }
  const WorldModel& world() const { return *world_; }
  SignalBus& bus() { return bench_.bus; }

 private:
  physics::StaticScene scene_;
  std::shared_ptr<const WorldModel> world_;
  test::SensorBench bench_;
  std::unique_ptr<Sensor> sensor_;
  Time now_{0};
};

std::uint32_t number(const Picture& picture, int x, int y) {
  const std::size_t bytes = Picture::bytes_per_pixel(picture.format);
  const std::size_t at = bytes * (static_cast<std::size_t>(y) * picture.width + x);
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < bytes; ++k) value |= std::uint32_t{picture.data[at + k]} << (8 * k);
  return value;
}

/// 120 x 90 pixels, 60 degrees wide, without noise.
const test::SensorValues kSmall = {{"width_px", std::int64_t{120}},
                                   {"height_px", std::int64_t{90}},
                                   {"horizontal_fov_deg", 60.0},
                                   {"noise", false}};

test::SensorValues with(test::SensorValues values, const test::SensorValues& more) {
  values.insert(values.end(), more.begin(), more.end());
  return values;
}

Pose at(double x, double y, double z, double pitch_deg = 0.0) {
  return {quaternion_from_rpy({0.0, rad_from_deg(pitch_deg), 0.0}), {x, y, z}};
}

/// Level ground at z = 0, 40 m wide.
std::shared_ptr<WorldModel> flat_world() {
  auto world = std::make_shared<WorldModel>();
  world->terrain = small::make_flat(0.0, 81, 0.5);
  return world;
}

MeshInstance box(const char* name, const Vector3d& middle, const Vector3f& half,
                 SurfaceClass surface, const Vector3f& colour = {0.5f, 0.5f, 0.5f}) {
  MeshInstance instance = small::make_instance(name, small::make_box_mesh(half), middle, surface);
  instance.material.colour = colour;
  return instance;
}

/// Direction of a pixel's middle in W, by the pinhole's formula.
Vector3d direction_W(const CameraInfo& info, const Pose& X_WS, double u, double v) {
  const Vector3d C((u - info.cx_px) / info.fx_px, (v - info.cy_px) / info.fy_px, 1.0);
  return (X_WS.q * Vector3d(C.z(), -C.x(), -C.y())).normalized();
}

TEST(Camera, DepthIsThatOfPlanesInClosedForm) {
  const auto world = flat_world();
  world->meshes = {box("wall", {8.0, 0.0, 5.0}, {0.5f, 10.0f, 10.0f}, SurfaceClass::kObstacle)};
  CameraBench bench(world, with(kSmall, {{"picture", std::string("depth")}}));
  const Pose X_WS = at(0.0, 0.0, 1.2, 15.0);
  bench.step(X_WS);
  const auto& info = bench.value<CameraInfo>("rover/s_info");
  const Vector3d axis_W = X_WS.q * Vector3d::UnitX();
  int grounds = 0, walls = 0;
  double worst_mm = 0.0;
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 120; ++x) {
      const Vector3d dir_W = direction_W(info, X_WS, x, y);
      const double to_wall = 7.5 / dir_W.x();
      const double to_ground = dir_W.z() < 0.0 ? -1.2 / dir_W.z() : 1e9;
      (to_ground < to_wall ? grounds : walls) += 1;
      const double depth_m = std::min(to_wall, to_ground) * dir_W.dot(axis_W);
      worst_mm = std::max(worst_mm, std::abs(1000.0 * depth_m - number(bench.picture(), x, y)));
    }
  }
  EXPECT_GT(grounds, 2000);
  EXPECT_GT(walls, 2000);
  // Half a millimetre is the picture's step.
  EXPECT_LE(worst_mm, 0.501);
  std::printf("largest error of depth: %.4f mm\n", worst_mm);
}

TEST(Camera, MasksAreThoseOfRaysCastAlone) {
  const auto world = flat_world();
  auto posts = small::make_box_mesh({0.05f, 0.05f, 1.0f});
  // A second post, 1 m to the left, in the same mesh.
  const auto corners = static_cast<std::uint32_t>(posts->vertices.size());
  posts->things = {0, static_cast<std::uint32_t>(posts->triangles.size())};
  for (std::uint32_t i = 0; i < corners; ++i) {
    posts->vertices.push_back(posts->vertices[i] + Vector3f(0, 1, 0));
  }
  for (std::size_t i = 0, count = posts->triangles.size(); i < count; ++i) {
    // From the side towards the camera on, so that its first triangle is seen.
    constexpr std::size_t kFront = 8;
    auto triangle = posts->triangles[(i + kFront) % count];
    for (std::uint32_t& corner : triangle) corner += corners;
    posts->triangles.push_back(triangle);
  }
  world->meshes = {small::make_instance("posts", posts, {3.0, -0.5, 1.0}, SurfaceClass::kPost),
                   box("leaf", {4.0, 0.0, 1.6}, {0.1f, 1.5f, 0.3f}, SurfaceClass::kCanopy),
                   box("grapes", {3.5, 0.0, 1.0}, {0.1f, 0.1f, 0.1f}, SurfaceClass::kCanopy)};
  world->meshes[2].label = Label::kBunch;
  CameraBench bench(world, with(kSmall, {{"semantic", true}, {"instance", true}}));
  const Pose X_WS = at(0.0, 0.0, 1.2);
  bench.step(X_WS);
  const auto& info = bench.value<CameraInfo>("rover/s_info");
  std::map<std::uint32_t, int> labels;
  std::map<std::uint32_t, std::pair<int, int>> things;  // and their mesh and triangle's half
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 120; ++x) {
      const Vector3d dir_W = direction_W(info, X_WS, x, y);
      const auto hit = bench.light().cast_ray(X_WS.p, dir_W, 1000.0);
      const std::uint32_t label = number(bench.picture("_semantic"), x, y);
      const std::uint32_t thing = number(bench.picture("_instance"), x, y);
      ++labels[label];
      if (!hit) {
        EXPECT_EQ(thing, 0u);
        EXPECT_EQ(label, dir_W.z() < 0.0 ? 1u : 0u);
        continue;
      }
      const std::uint32_t expected[] = {6, 2, 4};  // post, leaf, bunch
      EXPECT_EQ(label, hit->mesh < 0 ? 1u : expected[hit->mesh]);
      const std::pair<int, int> key(hit->mesh, hit->mesh == 0 && hit->triangle >= 12 ? 1 : 0);
      const auto known = things.emplace(thing, key).first;
      EXPECT_EQ(known->second, key) << x << " " << y;
    }
  }
  for (const std::uint32_t label : {0u, 1u, 2u, 4u, 6u}) EXPECT_GT(labels[label], 20) << label;
  // Ground, two posts, leaf, bunch: each one number.
  EXPECT_EQ(things.size(), 5u);
}

/// First column of a row whose label is that of a post.
int first_post_column(const Picture& semantic, int row) {
  for (int x = 0; x < static_cast<int>(semantic.width); ++x) {
    if (number(semantic, x, row) == 6u) return x;
  }
  return -1000;
}

TEST(Camera, PicturesAreTheSameOnOneCoreAndOnAll) {
  auto world = flat_world();
  for (int i = 0; i < 6; ++i) {
    world->meshes.push_back(box("box", {3.0 + i, 1.5 - 0.6 * i, 0.4 + 0.1 * i}, {0.3f, 0.2f, 0.5f},
                                SurfaceClass::kObstacle, {0.6f, 0.3f, 0.1f}));
  }
  const test::SensorValues values = {{"width_px", std::int64_t{120}},
                                     {"height_px", std::int64_t{91}},
                                     {"samples", std::int64_t{3}},
                                     {"depth", true},
                                     {"normals", true},
                                     {"semantic", true},
                                     {"instance", true}};
  const auto pictures = [&] {
    CameraBench bench(world, values);
    std::vector<std::vector<std::uint8_t>> bytes;
    for (int i = 0; i < 3; ++i) {
      bench.step(at(0.1 * i, 0.0, 1.2, 10.0));
      for (const char* layer : {"", "_truth", "_depth", "_normals", "_semantic", "_instance"}) {
        bytes.push_back(bench.picture(layer).data);
      }
    }
    return bytes;
  };
  const auto on_all = pictures();
  const ShareOfCores one(std::max(1u, std::thread::hardware_concurrency()));
  EXPECT_EQ(pictures(), on_all);
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

TEST(Camera, NdviIsThatOfLeavesAndOfSoil) {
  const auto world = flat_world();
  world->soil.name = "tilled_soil";
  // A leaf in the open, and a panel of known reflectance, as field campaigns use it.
  world->meshes = {box("leaf", {2.0, 1.0, 0.5}, {0.4f, 0.4f, 0.01f}, SurfaceClass::kCanopy,
                       {0.05f, 0.12f, 0.03f}),
                   box("panel", {2.0, -1.0, 0.5}, {0.4f, 0.4f, 0.01f}, SurfaceClass::kObstacle),
                   box("red_leaf", {2.0, 2.2, 0.5}, {0.4f, 0.4f, 0.01f}, SurfaceClass::kCanopy,
                       {0.35f, 0.10f, 0.04f})};
  std::map<std::string, std::array<double, 3>> reflectance;  // leaf, soil, autumn leaf
  for (const char* band : {"red", "red_edge", "nir"}) {
    CameraBench bench(world, with(kSmall, {{"picture", std::string(band)},
                                           {"horizontal_fov_deg", 90.0},
                                           {"rotation_deg", std::vector<double>{0.0, 90.0, 0.0}}}));
    bench.step(at(2.0, 0.0, 4.0));
    const auto& info = bench.value<CameraInfo>("rover/s_info");
    const int row = 45;
    const auto column = [&](double y, double depth_m) {
      return static_cast<int>(std::lround(info.cx_px - y * info.fx_px / depth_m));
    };
    const double panel = level(bench.picture(), column(-1.0, 3.49), row) / 0.5;
    reflectance[band] = {level(bench.picture(), column(1.0, 3.49), row) / panel,
                         level(bench.picture(), column(0.0, 4.0), row) / panel,
                         level(bench.picture(), column(2.2, 3.49), row) / panel};
  }
  const auto index = [&](std::size_t what, const char* low) {
    const double nir = reflectance["nir"][what], other = reflectance[low][what];
    return (nir - other) / (nir + other);
  };
  std::printf("NDVI: leaf %.2f, autumn leaf %.2f, bare soil %.2f; NDRE of the leaf %.2f\n",
              index(0, "red"), index(2, "red"), index(1, "red"), index(0, "red_edge"));
  EXPECT_GT(index(0, "red"), 0.70);
  EXPECT_LT(index(0, "red"), 0.95);
  EXPECT_GT(index(1, "red"), 0.05);
  EXPECT_LT(index(1, "red"), 0.25);
  EXPECT_LT(index(2, "red"), 0.3);
  EXPECT_GT(index(0, "red_edge"), 0.2);
  EXPECT_LT(index(0, "red_edge"), 0.5);
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

TEST(Camera, RefusesATextureThatItCannotRead) {
  const std::string file = (std::filesystem::path(VINEROW_BINARY_DIR) / "absent.png").string();
  EXPECT_EQ(test::refusal_of([&] { CameraBench(panel_world(file), kSmall); }),
            "texture " + file + ": No such file or directory");
}

TEST(Camera, DepthErrorsGrowWithTheSquareOfTheDepth) {
  for (const double wall_m : {2.0, 6.0}) {
    const auto world = flat_world();
    world->meshes = {
        box("wall", {wall_m + 0.5, 0.0, 10.0}, {0.5f, 19.0f, 9.0f}, SurfaceClass::kObstacle)};
    CameraBench bench(world, with(kSmall, {{"picture", std::string("depth")},
                                           {"depth_baseline_m", 0.05},
                                           {"depth_disparity_std_px", 0.1},
                                           {"depth_dropout_share", 0.1}}));
    bench.step(at(0.0, 0.0, 10.0));
    const auto& info = bench.value<CameraInfo>("rover/s_info");
    double squares = 0.0;
    int count = 0, lost = 0;
    for (int y = 0; y < 90; ++y) {
      for (int x = 0; x < 120; ++x) {
        EXPECT_EQ(number(bench.picture("_truth"), x, y), std::lround(1000.0 * wall_m));
        const double mm = number(bench.picture(), x, y);
        if (mm == 0.0) {
          ++lost;
          continue;
        }
        squares += (mm / 1000.0 - wall_m) * (mm / 1000.0 - wall_m);
        ++count;
      }
    }
    const double expected = wall_m * wall_m * 0.1 / (info.fx_px * 0.05);
    EXPECT_NEAR(std::sqrt(squares / count) / expected, 1.0, 0.04) << wall_m;
    EXPECT_NEAR(lost / 10800.0, 0.1, 0.015);
  }
}

TEST(Camera, AllLayersHaveTheSameStampAndTheInfoTheBaseline) {
  CameraBench bench(flat_world(), with(kSmall, {{"depth", true},
                                                {"normals", true},
                                                {"semantic", true},
                                                {"instance", true},
                                                {"stereo_baseline_m", 0.12}}));
  bench.step(at(0.0, 0.0, 1.0, 30.0));
  bench.step(at(0.0, 0.0, 1.0, 30.0));
  for (const char* layer :
       {"", "_depth", "_normals", "_semantic", "_instance", "_info", "_truth"}) {
    const SignalBase* signal = bench.bus().find(std::string("rover/s") + layer);
    ASSERT_NE(signal, nullptr) << layer;
    EXPECT_EQ(signal->stamp().ns, 100'000'000) << layer;
  }
  const auto& info = bench.value<CameraInfo>("rover/s_info");
  EXPECT_NEAR(info.tx_px_m, -0.12 * info.fx_px, 1e-12);
  // The ground's normal in the optical frame of a camera that looks down by 30 degrees.
  const double n[] = {0.0, -std::cos(rad_from_deg(30.0)), -std::sin(rad_from_deg(30.0))};
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t byte = number(bench.picture("_normals"), 60, 80) >> (8 * k) & 0xffu;
    EXPECT_EQ(byte, std::lround(127.5 * (n[k] + 1.0))) << k;
  }
}

TEST(Camera, RefusesPicturesThatTakeLongerThanThePeriod) {
  EXPECT_EQ(test::refusal_of([] {
              CameraBench(flat_world(), with(kSmall, {{"readout_s", 0.09}, {"exposure_s", 0.02}}));
            }),
            "rover.sensors.s: readout_s + exposure_s = 0.11 s, must be <= its period of 0.1 s");
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

TEST(Camera, SaysWhyItWouldSeeNothing) {
  const auto world = flat_world();
  world->meshes = {box("tank", {3.0, 0.0, 1.0}, {1.0f, 1.0f, 1.0f}, SurfaceClass::kObstacle)};
  CameraBench below(world, kSmall);
  EXPECT_EQ(test::refusal_of([&] { below.step(at(0.0, 0.0, -0.3)); }),
            "the camera is below the ground: change its position_m");
  CameraBench inside(world, kSmall);
  EXPECT_EQ(test::refusal_of([&] { inside.step(at(3.0, 0.0, 1.0)); }),
            "the camera is inside of tank: change its position_m");
  CameraBench fine(world, kSmall);
  fine.step(at(0.0, 0.0, 1.0));
  // Of a body whose triangles are turned inside out, too.
  auto inverted = std::make_shared<TriangleMesh>(*world->meshes[0].mesh);
  for (auto& triangle : inverted->triangles) std::swap(triangle[1], triangle[2]);
  world->meshes[0].mesh = inverted;
  CameraBench in_inverted(world, kSmall);
  EXPECT_EQ(test::refusal_of([&] { in_inverted.step(at(3.0, 0.0, 1.0)); }),
            "the camera is inside of tank: change its position_m");
  CameraBench outside(world, kSmall);
  outside.step(at(0.0, 0.0, 1.0));
}

TEST(Camera, ABoardHasNoInside) {
  const auto world = flat_world();
  auto board = std::make_shared<TriangleMesh>();
  board->vertices = {{0, -2, -2}, {0, 2, -2}, {0, 2, 2}, {0, -2, 2}};
  for (const auto& triangles : {std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}},
                                std::vector<std::array<std::uint32_t, 3>>{{0, 2, 1}, {0, 3, 2}}}) {
    board->triangles = triangles;
    world->meshes = {small::make_instance("board", std::make_shared<TriangleMesh>(*board),
                                          {3.0, 0.0, 1.0}, SurfaceClass::kObstacle)};
    CameraBench bench(world, kSmall);
    bench.step(at(0.0, 0.0, 1.0));
  }
}

}  // namespace
}  // namespace vinerow::sensors::camera_test
