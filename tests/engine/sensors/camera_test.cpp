/// The camera sensor against closed forms: depth, labels, layers, and what it refuses.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <thread>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/core/parallel.h"
#include "tests/engine/sensors/camera_bench.h"

namespace vinerow::sensors::camera_test {
namespace {

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

TEST(Camera, APictureIsLostTogetherWithItsLayersAndFacts) {
  CameraBench bench(flat_world(), with(kSmall, {{"depth", true},
                                                {"normals", true},
                                                {"semantic", true},
                                                {"instance", true},
                                                {"dropout_share", 0.5}}));
  int lost = 0;
  std::int64_t last_ns = -1;
  for (int i = 0; i < 40; ++i) {
    bench.step(at(0.0, 0.0, 1.0, 30.0));
    const SignalBase& picture = *bench.bus().find("rover/s");
    if (picture.sequence() == 0) {
      ++lost;
      continue;
    }
    lost += picture.stamp().ns == last_ns ? 1 : 0;
    last_ns = picture.stamp().ns;
    for (const char* other :
         {"_depth", "_normals", "_semantic", "_instance", "_info", "_exposure"}) {
      const SignalBase& signal = *bench.bus().find(std::string("rover/s") + other);
      EXPECT_EQ(signal.stamp().ns, last_ns) << other;
      EXPECT_EQ(signal.sequence(), picture.sequence()) << other;
    }
  }
  // 20 of 40, with a standard deviation of 3.2.
  EXPECT_NEAR(lost, 20, 13);
}

TEST(Camera, AFixedExposureAsReportedTakesTheSamePicture) {
  const auto world = flat_world();
  world->meshes = {box("wall", {4.0, 0.5, 0.5}, {0.1f, 0.5f, 0.5f}, SurfaceClass::kObstacle)};
  const auto mono = with(kSmall, {{"picture", std::string("mono")}});
  const auto step = [&](const test::SensorValues& more) {
    auto bench = std::make_unique<CameraBench>(world, with(mono, more));
    // The first picture is taken with the longest exposure; only a moving camera would show that.
    bench->step(at(0.0, 0.0, 1.0, 10.0));
    return bench;
  };
  const auto exposure = [](CameraBench& bench) {
    const auto& values = bench.value<NamedValues>("rover/s_exposure");
    EXPECT_EQ(values.names, (std::vector<std::string>{"exposure_s", "gain"}));
    return values.values;
  };
  // In daylight the exposure is short enough for a gain of 1.
  const auto automatic = step({});
  const std::vector<double> chosen = exposure(*automatic);
  EXPECT_EQ(chosen[1], 1.0);
  EXPECT_LT(chosen[0], 0.01);
  const auto fixed = step({{"exposure_s", chosen[0]}});
  EXPECT_EQ(exposure(*fixed), chosen);
  EXPECT_EQ(fixed->picture().data, automatic->picture().data);

  // A quarter of it is the most: four times the gain, and each number four times that of the fixed
  // exposure, within the steps of 12 bits.
  const double most_s = 0.25 * chosen[0];
  const auto amplified = step({{"exposure_min_s", 1e-6}, {"exposure_max_s", most_s}});
  const std::vector<double> short_one = exposure(*amplified);
  EXPECT_EQ(short_one[0], most_s);
  EXPECT_NEAR(short_one[1], 4.0, 1e-9);
  const auto plain = step({{"exposure_s", most_s}});
  int compared = 0;
  constexpr double kStep = 65535.0 / 4095.0;
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 120; ++x) {
      const double high = number(amplified->picture(), x, y);
      if (high > 65000.0) continue;
      EXPECT_NEAR(high, 4.0 * number(plain->picture(), x, y), 2.5 * kStep + 3.0) << x << " " << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(Camera, DepthAloneHasNoExposure) {
  CameraBench bench(flat_world(), with(kSmall, {{"picture", std::string("depth")}}));
  EXPECT_EQ(bench.bus().find("rover/s_exposure"), nullptr);
  EXPECT_NE(bench.bus().find("rover/s_info"), nullptr);
}

TEST(Camera, RefusesPicturesThatTakeLongerThanThePeriod) {
  EXPECT_EQ(test::refusal_of([] {
              CameraBench(flat_world(), with(kSmall, {{"readout_s", 0.09}, {"exposure_s", 0.02}}));
            }),
            "rover.sensors.s: readout_s + exposure_s = 0.11 s, must be <= its period of 0.1 s");
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

/// A mesh of the walls of a room of 1 m x 1 m x 1 m about the origin, each 1 cm thick and 2 mm
/// from the next: rays enter and leave each of them. @param walls  of six, x first
std::shared_ptr<TriangleMesh> make_crate(std::size_t walls = 6) {
  auto crate = std::make_shared<TriangleMesh>();
  for (std::size_t wall = 0; wall < walls; ++wall) {
    const auto axis = static_cast<int>(wall / 2);
    Vector3f half = Vector3f::Constant(0.493f), middle = Vector3f::Zero();
    half[axis] = 0.005f;
    middle[axis] = wall % 2 == 0 ? 0.5f : -0.5f;
    const auto board = small::make_box_mesh(half);
    const auto first = static_cast<std::uint32_t>(crate->vertices.size());
    for (const Vector3f& v : board->vertices) crate->vertices.push_back(v + middle);
    for (const auto& [a, b, c] : board->triangles) {
      crate->triangles.push_back({first + a, first + b, first + c});
    }
  }
  return crate;
}

TEST(Camera, ACrateOfBoardsLeavesNoSight) {
  const auto world = flat_world();
  const auto refusal = [&](std::shared_ptr<TriangleMesh> mesh, const Pose& X_WS) {
    world->meshes = {
        small::make_instance("crate", std::move(mesh), {3.0, 0.0, 0.6}, SurfaceClass::kObstacle)};
    CameraBench bench(world, kSmall);
    return test::refusal_of([&] { bench.step(X_WS); });
  };
  for (const double x : {2.7, 3.0, 3.4}) {
    for (const double z : {0.3, 0.9}) {
      EXPECT_EQ(refusal(make_crate(), at(x, 0.2, z)),
                "the camera is inside of crate: change its position_m");
    }
  }
  // Looked at from outside, and out of one that lacks all but two walls.
  EXPECT_EQ(refusal(make_crate(), at(2.3, 0.0, 0.6)), "no error");
  EXPECT_EQ(refusal(make_crate(2), at(3.0, 0.2, 0.6)), "no error");
}

TEST(Camera, AWallThatFillsTheViewHasNoInside) {
  // Of the directions all around, five of seven meet a wall that stands like this.
  const Vector3d towards_W = Vector3d(0.556, 0.810, 0.184).normalized();
  Pose X_WS;
  X_WS.q.setFromTwoVectors(Vector3d::UnitX(), towards_W);
  X_WS.p = {0.0, 0.0, 15.0};
  const auto world = flat_world();
  world->meshes = {small::make_instance("wall", small::make_box_mesh({0.05f, 12.0f, 12.0f}),
                                        X_WS.p + 0.25 * towards_W, SurfaceClass::kObstacle)};
  world->meshes[0].X_WM.q = X_WS.q;
  CameraBench bench(world, kSmall);
  EXPECT_EQ(test::refusal_of([&] { bench.step(X_WS); }), "no error");
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
