#include "engine/sensors/lidar_3d.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <thread>
#include <tuple>
#include <vector>

#include "engine/api/mesh.h"
#include "engine/api/messages/sensors.h"
#include "engine/core/constants.h"
#include "engine/core/parallel.h"
#include "engine/math/angles.h"
#include "engine/physics/static_scene.h"
#include "tests/engine/physics/small_worlds.h"
#include "tests/engine/sensors/plate_and_wall.h"
#include "tests/engine/sensors/scan_bench.h"
#include "tests/support/no_alloc.h"
#include "tests/support/plain_scene.h"

namespace vinerow::sensors::lidar_3d_test {
namespace {

using test::PlainScene;
using test::SensorValues;
using Bench = test::ScanBench<PointCloud>;

Eigen::Vector3d point(const PointCloud& cloud, std::size_t i) {
  return {cloud.x[i], cloud.y[i], cloud.z[i]};
}

/// Ideal readings of the default scanner.
SensorValues ideal(SensorValues more = {}) {
  SensorValues values = {{"noise_std_m", 0.0}, {"dark_range_m", 1e6}};
  values.insert(values.end(), more.begin(), more.end());
  return values;
}

/// A single beam ahead, of a ray in the middle and four about it.
SensorValues one_wide_beam(SensorValues more) {
  SensorValues values = {{"elevations_deg", std::vector<double>{0.0}},
                         {"columns", std::int64_t{2}},
                         {"field_of_view_deg", 10.0},
                         {"divergence_deg", 0.2},
                         {"sub_rays", std::int64_t{5}}};
  values.insert(values.end(), more.begin(), more.end());
  return ideal(values);
}

Bench make(const SensorValues& values, const PlainScene& scene, std::uint64_t seed = 1) {
  return Bench("lidar_3d", test::sensor_parameters("lidar_3d", values), scene, 10.0, seed);
}

TEST(Lidar3d, EveryPointLiesOnTheWallsOfARoom) {
  // Walls x = +-8, y = +-5, ground z = -1 in S: closed form for each direction.
  PlainScene room{test::GroundPlane{}};
  for (const double side : {-1.0, 1.0}) {
    room.panels.push_back({{8.0 * side, 0, 0}, {-side, 0, 0}, SurfaceClass::kObstacle});
    room.panels.push_back({{0, 5.0 * side, 0}, {0, -side, 0}, SurfaceClass::kObstacle});
  }
  Bench bench = make(ideal(), room);
  bench.move([](double) {
    Pose pose;
    pose.p.z() = 1.0;
    return pose;
  });
  bench.step();
  const PointCloud& cloud = bench.step();
  ASSERT_EQ(cloud.x.size(), 28'800u);
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const Eigen::Vector3d p = point(cloud, i);
    const double gap = std::min({8.0 - std::abs(p.x()), 5.0 - std::abs(p.y()), p.z() + 1.0});
    ASSERT_NEAR(gap, 0.0, 1e-5) << p.transpose();
    EXPECT_GE(cloud.time_s[i], 0.0F);
    EXPECT_LT(cloud.time_s[i], 0.1F);
    EXPECT_EQ(cloud.return_number[i], 1);
  }
  EXPECT_EQ(bench.truth().x, cloud.x);
  // The stamp is the start of the frame, as drivers have it for LIO: points are not before it.
  EXPECT_NEAR(bench.reading().stamp().s(), bench.last().s() - 0.1, 1e-12);
}

TEST(Lidar3d, PointsHaveTheLabelsOfWhatTheyAreOn) {
  WorldModel world;
  world.terrain = physics::test::make_flat(-1.0);
  world.meshes = {
      physics::test::make_instance("wall", physics::test::make_box_mesh({0.5f, 3.0f, 2.0f}),
                                   {5.0, 0.0, 1.0}, SurfaceClass::kObstacle),
      physics::test::make_instance("worker", physics::test::make_box_mesh({0.3f, 0.3f, 0.9f}),
                                   {0.0, 4.0, -0.1}, SurfaceClass::kObstacle)};
  world.meshes[1].label = Label::kPerson;
  const physics::StaticScene scene(std::make_shared<const WorldModel>(world));
  for (const bool is_organised : {false, true}) {
    const ParameterSet parameters =
        test::sensor_parameters("lidar_3d", ideal({{"labels", true},
                                                   {"organised", is_organised},
                                                   {"sub_rays", std::int64_t{3}},
                                                   {"divergence_deg", 0.01}}));
    Bench bench("lidar_3d", parameters, scene.queries(), 10.0, 1, {}, &world);
    bench.step();
    bench.step();
    for (const PointCloud* cloud : {&bench.reading().value(), &bench.truth()}) {
      ASSERT_EQ(cloud->label.size(), cloud->x.size());
      ASSERT_EQ(cloud->instance.size(), cloud->x.size());
      std::map<std::pair<Label, std::uint32_t>, int> count;
      for (std::size_t i = 0; i < cloud->x.size(); ++i) {
        const Eigen::Vector3d p = point(*cloud, i);
        // Numbers: 1 is the terrain, then the meshes. In S the ground is at z = -1.
        std::pair expected(Label::kSky, 0u);
        if (cloud->return_number[i] > 0) {
          const double to_worker =
              std::max(std::abs(p.x()), std::abs(p.y() - 4.0));  // horizontally, 0.3 m on it
          if (std::abs(p.z() + 1.0) < 1e-3) {
            expected = {Label::kGround, 1u};
          } else if (to_worker < 0.301) {
            expected = {Label::kPerson, 3u};
          } else {
            expected = {Label::kObstacle, 2u};
          }
        }
        const std::pair found(static_cast<Label>(cloud->label[i]), cloud->instance[i]);
        ASSERT_EQ(found, expected) << p.transpose();
        ++count[found];
      }
      EXPECT_GT((count[{Label::kGround, 1u}]), 5000);
      EXPECT_GT((count[{Label::kObstacle, 2u}]), 1000);
      EXPECT_GT((count[{Label::kPerson, 3u}]), 100);
    }
  }
  const PlainScene ground{test::GroundPlane{}};
  Bench plain = make(ideal(), ground);
  EXPECT_TRUE(plain.step().label.empty());
}

TEST(Lidar3d, AMovingScannerSkewsTheWallByItsTimes) {
  // Towards a wall at 30 m with 10 m/s while it turns left at 1 rad/s: with the pose at each
  // point's own instant, every point is back on the wall.
  PlainScene scene;
  scene.panels.push_back({{30, 0, 0}, {-1, 0, 0}, SurfaceClass::kObstacle});
  Bench bench = make(ideal({{"slices", std::int64_t{50}}}), scene);
  const auto way = [](double time_s) {
    Pose pose;
    pose.p.x() = 10.0 * time_s;
    pose.q = Eigen::AngleAxisd(time_s, Eigen::Vector3d::UnitZ());
    return pose;
  };
  bench.move(way);
  bench.step();
  const PointCloud& cloud = bench.step();
  ASSERT_GT(cloud.x.size(), 10'000u);
  double skew_m = 0.0;
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const double time_s = bench.reading().stamp().s() + cloud.time_s[i];
    EXPECT_NEAR((way(time_s) * point(cloud, i)).x(), 30.0, 1e-3);
    // Taken as one instant, the wall would be bent.
    skew_m = std::max(skew_m, std::abs((way(bench.last().s()) * point(cloud, i)).x() - 30.0));
  }
  EXPECT_GT(skew_m, 1.0);
}

TEST(Lidar3d, FramesAreTheSameOnOneCoreAndOnAll) {
  PlainScene room{test::GroundPlane{}};
  room.panels.push_back({{9.0, 0, 0}, {-1, 0, 0}, SurfaceClass::kObstacle});
  const auto frame = [&] {
    Pose now;
    test::PlateAndWall vehicles([&] { return now; });
    // 14,400 rays a slice.
    const SensorValues values = ideal(
        {{"slices", std::int64_t{10}}, {"divergence_deg", 0.2}, {"sub_rays", std::int64_t{5}}});
    Bench bench("lidar_3d", test::sensor_parameters("lidar_3d", values), room, 10.0, 1,
                [&]() -> VehicleScene& { return vehicles; });
    bench.move([&](double time_s) {
      now.p = {time_s, 0.0, 1.0};
      return now;
    });
    bench.step();
    const PointCloud& cloud = bench.step();
    return std::tuple(cloud.x, cloud.y, cloud.z, cloud.intensity, cloud.time_s);
  };
  const auto on_all = frame();
  ASSERT_GT(std::get<0>(on_all).size(), 10'000u);
  const ShareOfCores one(std::max(1u, std::thread::hardware_concurrency()));
  EXPECT_EQ(frame(), on_all);
}

TEST(Lidar3d, ReportsTheStrongestAndTheLastEcho) {
  // A leaf covers the beam's middle and one of four rays about it, a post stands 3 m behind.
  PlainScene scene;
  scene.panels.push_back({{5, 0.25, 0}, {-1, 0, 0}, SurfaceClass::kCanopy, 0.2503, 0.0001});
  scene.panels.push_back({{8, 0, 0}, {-1, 0, 0}, SurfaceClass::kPost});
  // One pulse straight ahead in a frame.
  const auto beam = [&](const char* returns) {
    return one_wide_beam({{"returns", std::string(returns)}});
  };
  Bench dual = make(beam("dual"), scene);
  dual.step();
  const PointCloud& both = dual.step();
  ASSERT_EQ(both.x.size(), 2u);
  const bool leaf_first = both.x[0] < 6.0F;
  EXPECT_NEAR(both.x[leaf_first ? 0 : 1], 5.0, 1e-4);
  EXPECT_NEAR(both.x[leaf_first ? 1 : 0], 8.0, 1e-4);
  EXPECT_EQ(both.return_number[0], 1);
  EXPECT_EQ(both.return_number[1], 2);
  Bench last = make(beam("last"), scene);
  last.step();
  EXPECT_NEAR(last.step().x.at(0), 8.0, 1e-4);
}

TEST(Lidar3d, ReportsTheSecondStrongestEchoIfTheStrongestIsTheLast) {
  // Manual of the VLP-16, 63-9243, p. 57. A twig before a wall covers the one ray to the left.
  PlainScene scene;
  scene.panels.push_back({{5, 0.253, 0}, {-1, 0, 0}, SurfaceClass::kCanopy, 0.25, 0.0001});
  scene.panels.push_back({{8, 0, 0}, {-1, 0, 0}, SurfaceClass::kPost});
  Bench dual = make(one_wide_beam({{"returns", std::string("dual")}}), scene);
  const PointCloud& both = dual.step();
  ASSERT_EQ(both.x.size(), 2u);
  // By power: 0.8 x 0.35 / 8^2 > 0.2 x 0.45 / 5^2.
  EXPECT_NEAR(both.x[0], 8.0, 1e-4);
  EXPECT_NEAR(both.x[1], 5.0, 1e-4);
  EXPECT_EQ(both.return_number[0], 1);
  EXPECT_EQ(both.return_number[1], 2);
}

TEST(Lidar3d, AnEchoFromTwoThingsHasTheLabelOfTheStronger) {
  // As above, but the wall is near enough to make one echo with the twig. By power, of five rays:
  // 4 x 0.35 / 5.5^2 > 1 x 0.45 / 5^2; each ray alone the other way about.
  const auto label = [](double twig_half_m) {
    PlainScene scene;
    scene.panels.push_back({{5, 0.253, 0}, {-1, 0, 0}, SurfaceClass::kCanopy, twig_half_m, 1e-4});
    scene.panels.push_back({{5.5, 0, 0}, {-1, 0, 0}, SurfaceClass::kPost});
    Bench bench = make(one_wide_beam({{"labels", true}}), scene);
    const PointCloud& cloud = bench.step();
    EXPECT_EQ(cloud.x.size(), 1u);
    EXPECT_EQ(bench.truth().label.size(), 1u);
    return static_cast<Label>(cloud.label.at(0));
  };
  EXPECT_EQ(label(0.25), Label::kPost);
  EXPECT_EQ(label(0.26), Label::kLeaf);  // over the middle and two more
}

TEST(Lidar3d, TheOwnVehicleStandsStillInItsClouds) {
  const PlainScene scene;
  const auto frame = [&](double speed_mps, double rate_radps) {
    const auto way = [=](double time_s) {
      Pose pose;
      pose.p.x() = speed_mps * time_s;
      pose.q = Eigen::AngleAxisd(rate_radps * time_s, Eigen::Vector3d::UnitZ());
      return pose;
    };
    Pose now;
    test::PlateAndWall vehicles([&] { return now; });
    Bench bench("lidar_3d",
                test::sensor_parameters("lidar_3d", ideal({{"slices", std::int64_t{1}}})), scene,
                10.0, 1, [&]() -> VehicleScene& { return vehicles; });
    bench.move([&](double time_s) { return now = way(time_s); });
    const PointCloud& cloud = bench.step();
    std::vector<std::tuple<float, float, float, float, float>> plate;
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      const double time_s = bench.reading().stamp().s() + cloud.time_s[i];
      if (std::abs(cloud.x[i] - 1.0F) < 1e-5F) {
        plate.emplace_back(cloud.x[i], cloud.y[i], cloud.z[i], cloud.intensity[i], cloud.time_s[i]);
      } else {
        EXPECT_NEAR((way(time_s) * point(cloud, i)).x(), 8.0, 2e-3);
      }
    }
    // Pulses that pass the plate go on to the wall, if they fly towards it.
    EXPECT_GT(cloud.x.size(), plate.size() + 10'000u);
    return plate;
  };
  // Within 11.3 deg: 12 lasers and 113 columns.
  const auto at_rest = frame(0.0, 0.0), on_the_way = frame(10.0, 1.0);
  ASSERT_GT(at_rest.size(), 1000u);
  ASSERT_EQ(on_the_way.size(), at_rest.size());
  for (std::size_t i = 0; i < at_rest.size(); ++i) {
    EXPECT_NEAR(std::get<1>(on_the_way[i]), std::get<1>(at_rest[i]), 1e-5);
    EXPECT_NEAR(std::get<2>(on_the_way[i]), std::get<2>(at_rest[i]), 1e-5);
    EXPECT_NEAR(std::get<3>(on_the_way[i]), std::get<3>(at_rest[i]), 1e-3);
    EXPECT_EQ(std::get<4>(on_the_way[i]), std::get<4>(at_rest[i]));
  }
}

TEST(Lidar3d, LosesThePulsesOfAnOutageAndNoOthers) {
  PlainScene room;
  for (const double side : {-1.0, 1.0}) {
    room.panels.push_back({{4.0 * side, 0, 0}, {-side, 0, 0}, SurfaceClass::kObstacle});
    room.panels.push_back({{0, 4.0 * side, 0}, {0, -side, 0}, SurfaceClass::kObstacle});
  }
  // From the middle of the second frame to a quarter of the fourth.
  Bench bench("lidar_3d",
              test::with_outage(test::sensor_parameters("lidar_3d", ideal()), 0.15, 0.325), room);
  Bench whole = make(ideal(), room);
  std::size_t lost = 0;
  for (int frame = 0; frame < 6; ++frame) {
    const PointCloud& all = whole.step();
    const PointCloud& cloud = bench.step();
    std::vector<float> expected;
    for (std::size_t i = 0; i < all.x.size(); ++i) {
      const double time_s = whole.reading().stamp().s() + all.time_s[i];
      if (time_s > 0.15 - 1e-6 && time_s < 0.325 - 1e-6) {
        ++lost;
      } else {
        expected.push_back(all.x[i]);
      }
    }
    EXPECT_EQ(cloud.x, expected) << frame;
    EXPECT_EQ(bench.truth().x, whole.truth().x);
  }
  EXPECT_EQ(lost, 14'400u + 28'800u + 7'200u);
}

TEST(Lidar3d, ReportsNothingBeforeItsFirstFrame) {
  const PlainScene room{test::GroundPlane{.z_m = -1.0}};
  Bench bench = make(ideal(), room);
  EXPECT_EQ(bench.reading().sequence(), 0u);
  EXPECT_GT(bench.step().x.size(), 0u);
  EXPECT_EQ(bench.reading().sequence(), 1u);
}

TEST(Lidar3d, IntensityIsTheReflectanceInPercent) {
  PlainScene scene;
  scene.panels.push_back({{10, 0, 0}, {-1, 0, 0}, SurfaceClass::kPost});
  Bench bench = make({{"noise_std_m", 0.0}, {"stem_reflectance", 0.35}}, scene);
  bench.step();
  const PointCloud& cloud = bench.step();
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const Eigen::Vector3d p = point(cloud, i);
    EXPECT_NEAR(cloud.intensity[i], 35.0 * p.x() / p.norm(), 0.01);
  }
}

TEST(Lidar3d, LosesDarkSurfacesWhereItsDataSheetDoes) {
  // 10 % at the dark range: nine in ten are detected.
  PlainScene scene;
  scene.panels.push_back({{40, 0, 0}, {-1, 0, 0}, SurfaceClass::kPost});
  Bench bench = make({{"stem_reflectance", 0.1},
                      {"elevations_deg", std::vector<double>{0.0}},
                      {"columns", std::int64_t{100'000}},
                      {"field_of_view_deg", 5.0}},
                     scene);
  bench.step();
  std::size_t seen = 0, sent = 0;
  for (int frame = 0; frame < 15; ++frame) {
    seen += bench.step().x.size();
    sent += bench.truth().x.size();
  }
  const double share = static_cast<double>(seen) / static_cast<double>(sent);
  EXPECT_NEAR(share, 0.9, 5.0 * 0.3 / std::sqrt(static_cast<double>(sent)) + 0.002);
}

TEST(Lidar3d, NoiseIsThatOfItsDataSheet) {
  PlainScene scene;
  scene.panels.push_back({{20, 0, 0}, {-1, 0, 0}, SurfaceClass::kPost});
  Bench bench(test::data_sheet("os1_64", {{"field_of_view_deg", 20.0}}), scene);
  bench.step();
  double squares = 0.0;
  std::size_t count = 0;
  for (int frame = 0; frame < 4; ++frame) {
    const PointCloud& cloud = bench.step();
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      if (cloud.return_number[i] == 0) continue;
      const Eigen::Vector3d p = point(cloud, i);
      const double error = p.norm() - 20.0 * p.norm() / p.x();
      squares += error * error;
      ++count;
    }
  }
  ASSERT_GT(count, 5000u);
  // 1.5 cm and 0.5 mm a metre at a little more than 20 m.
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count)), 0.0252, 0.002);
}

TEST(Lidar3d, DataSheetsHaveTheirPoints) {
  PlainScene room;
  for (const double side : {-1.0, 1.0}) {
    room.panels.push_back({{4.0 * side, 0, 0}, {-side, 0, 0}, SurfaceClass::kObstacle});
    room.panels.push_back({{0, 4.0 * side, 0}, {0, -side, 0}, SurfaceClass::kObstacle});
  }
  const auto points_in_a_second = [&](const char* sheet, double rate_Hz = 10.0) {
    scenario::PartConfig part = test::data_sheet(sheet, {{"beam_dropout_share", 0.0}});
    part.rate_Hz = rate_Hz;
    Bench bench(part, room);
    std::size_t count = 0;
    for (int frame = 0; frame < rate_Hz; ++frame) {
      const std::vector<std::uint8_t>& numbers = bench.step().return_number;
      count +=
          numbers.size() - static_cast<std::size_t>(std::count(numbers.begin(), numbers.end(), 0));
    }
    return static_cast<double>(count);
  };
  // 16 every 55.296 us, of the 300,000 that the maker states.
  EXPECT_NEAR(points_in_a_second("vlp16", 5.0), 289'352.0, 16.0);
  EXPECT_NEAR(points_in_a_second("vlp16"), 289'352.0, 16.0);
  EXPECT_NEAR(points_in_a_second("vlp16", 20.0), 289'352.0, 16.0);
  EXPECT_EQ(points_in_a_second("os1_64"), 655'360.0);
  EXPECT_EQ(points_in_a_second("os1_64", 20.0), 1'310'720.0);
  EXPECT_EQ(points_in_a_second("mid360"), 200'000.0);
}

TEST(Lidar3d, AnOrganisedCloudIsThatOfTheMakersFormula) {
  // OS1 user guide, "Lidar Range to XYZ": of measurement id m of 1024 and the beam with the angles
  // azimuth and altitude, theta = 2 pi (1 - m / 1024) - azimuth in the lidar frame, whose x axis
  // points back. Angles: design values of the maker's client (gen1_azimuth_angles).
  const double azimuths_deg[] = {3.164, 1.055, -1.055, -3.164};
  PlainScene room;
  for (const double side : {-1.0, 1.0}) {
    room.panels.push_back({{6.0 * side, 0, 0}, {-side, 0, 0}, SurfaceClass::kObstacle});
    room.panels.push_back({{0, 6.0 * side, 0}, {0, -side, 0}, SurfaceClass::kObstacle});
  }
  Bench bench(test::data_sheet("os1_64", {{"beam_dropout_share", 0.0}}), room);
  const PointCloud& cloud = bench.step();
  ASSERT_EQ(cloud.rows, 64u);
  ASSERT_EQ(cloud.x.size(), 64u * 1024u);
  for (std::size_t row = 0; row < 64; ++row) {
    for (std::size_t column = 0; column < 1024; ++column) {
      const std::size_t i = 1024 * row + column;
      EXPECT_EQ(cloud.ring[i], row);
      ASSERT_NE(cloud.return_number[i], 0);
      const double id = std::round(cloud.time_s[i] / 0.1 * 1024.0);
      const double theta = 2.0 * kPi * (1.0 - id / 1024.0) - rad_from_deg(azimuths_deg[row % 4]);
      const Eigen::Vector3d p = point(cloud, i);
      const double azimuth = std::atan2(p.y(), p.x());
      EXPECT_NEAR(wrap_angle(azimuth - (theta + kPi)), 0.0, 1e-6) << row << " " << column;
      // Columns have one azimuth, to half of 360 / 1024 degrees, and begin behind.
      EXPECT_LT(
          std::abs(wrap_angle(azimuth - kPi + 2.0 * kPi * static_cast<double>(column) / 1024.0)),
          kPi / 1024.0);
      const double altitude_deg = deg_from_rad(std::asin(p.z() / p.norm()));
      // Data sheet: 64 even beams. The maker's table rounds its ends and its values to 0.001 deg.
      EXPECT_NEAR(altitude_deg, 16.611 - 33.222 / 63.0 * static_cast<double>(row), 0.001);
      // The packets have whole millimetres.
      EXPECT_NEAR(1e3 * p.norm(), std::round(1e3 * p.norm()), 2e-3);
    }
  }
}

TEST(Lidar3d, AnOrganisedCloudHasAPlaceForWhatIsNotSeen) {
  PlainScene scene;
  scene.panels.push_back({{5, 0, 0}, {-1, 0, 0}, SurfaceClass::kObstacle});
  const SensorValues values = ideal({{"columns", std::int64_t{360}}});
  Bench list = make(values, scene), grid = [&] {
    SensorValues organised = values;
    organised.emplace_back("organised", true);
    return make(organised, scene);
  }();
  for (int frame = 0; frame < 2; ++frame) {
    const PointCloud& seen = list.step();
    const PointCloud& cloud = grid.step();
    EXPECT_EQ(seen.rows, 0u);
    ASSERT_EQ(cloud.rows, 16u);
    ASSERT_EQ(cloud.x.size(), 16u * 360u);
    // The same points: in the list by their times, in the grid by rows.
    std::vector<std::tuple<float, float, float, float, float>> listed, placed;
    for (std::size_t i = 0; i < seen.x.size(); ++i) {
      listed.emplace_back(seen.time_s[i], seen.x[i], seen.y[i], seen.z[i], seen.intensity[i]);
    }
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      EXPECT_EQ(cloud.ring[i], i / 360);
      EXPECT_NEAR(cloud.time_s[i], 0.1 / 360.0 * static_cast<double>(i % 360), 1e-8);
      if (cloud.return_number[i] == 0) {
        EXPECT_EQ(std::tuple(cloud.x[i], cloud.y[i], cloud.z[i], cloud.intensity[i]),
                  std::tuple(0.0F, 0.0F, 0.0F, 0.0F));
      } else {
        placed.emplace_back(cloud.time_s[i], cloud.x[i], cloud.y[i], cloud.z[i],
                            cloud.intensity[i]);
      }
    }
    std::sort(listed.begin(), listed.end());
    std::sort(placed.begin(), placed.end());
    EXPECT_EQ(placed, listed);
    EXPECT_GT(placed.size(), 2000u);
    EXPECT_LT(placed.size(), 3000u);
  }
}

TEST(Lidar3d, RangesHaveTheStepOfTheirPackets) {
  // VLP-16: 2 mm.
  PlainScene room;
  for (const double side : {-1.0, 1.0}) {
    room.panels.push_back({{4.0 * side, 0, 0}, {-side, 0, 0}, SurfaceClass::kObstacle});
    room.panels.push_back({{0, 4.0 * side, 0}, {0, -side, 0}, SurfaceClass::kObstacle});
  }
  Bench bench(test::data_sheet("vlp16"), room);
  const PointCloud& cloud = bench.step();
  ASSERT_GT(cloud.x.size(), 10'000u);
  bool is_odd = false;
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    const double steps = point(cloud, i).norm() / 0.002;
    EXPECT_NEAR(steps, std::round(steps), 1e-3);
    is_odd = is_odd || std::lround(steps) % 2 == 1;
  }
  EXPECT_TRUE(is_odd);
}

TEST(Lidar3d, WhatIsSeenShiftsNoRandomNumber) {
  PlainScene first, second;
  first.panels.push_back({{10, 0, 0}, {-1, 0, 0}, SurfaceClass::kPost});
  const SensorValues values = {{"beam_dropout_share", 0.1}};
  Bench a = make(values, first), b = make(values, second);
  for (int i = 0; i < 5; ++i) a.step(), b.step();
  second = first;
  b.step(), a.step();
  EXPECT_EQ(a.step().x, b.step().x);
  Bench other = make(values, first, 2);
  for (int i = 0; i < 6; ++i) other.step();
  EXPECT_NE(other.step().x, a.step().x);
}

TEST(Lidar3d, AFrameAllocatesNothing) {
  PlainScene scene;
  scene.panels.push_back({{10, 0, 0}, {-1, 0, 0}, SurfaceClass::kPost});
  for (const bool organised : {false, true}) {
    Bench bench = make({{"organised", organised}}, scene);
    bench.step(), bench.step();
    const test::AllocationCounter counter;
    bench.step();
    EXPECT_EQ(counter.count(), 0u);
  }
}

TEST(Lidar3d, RunsAtTheRatesOfItsDataSheet) {
  // 200, 100 and 50 ms in whole steps of 1 ms.
  const PlainScene scene;
  const auto sampling_ms = [&](double rate_Hz) {
    const Bench bench("lidar_3d", test::sensor_parameters("lidar_3d"), scene, rate_Hz);
    return bench.sampling().s() * 1e3;
  };
  EXPECT_NEAR(sampling_ms(5.0), 10.0, 1e-9);
  EXPECT_NEAR(sampling_ms(10.0), 5.0, 1e-9);
  EXPECT_NEAR(sampling_ms(20.0), 5.0, 1e-9);
}

TEST(Lidar3d, RefusesBadInputInOneSentence) {
  const PlainScene scene;
  const auto error_of = [&](const SensorValues& values) {
    return test::refusal_of([&] { make(values, scene); });
  };
  EXPECT_EQ(error_of({{"elevations_deg", std::vector<double>{}}}),
            "rover.sensors.s: elevations_deg has no laser");
  EXPECT_EQ(error_of({{"azimuth_offsets_deg", std::vector<double>{1.0}}}),
            "rover.sensors.s: azimuth_offsets_deg has 1 numbers, elevations_deg 16: one for each "
            "laser");
  EXPECT_EQ(error_of({{"columns", std::int64_t{100'000}},
                      {"elevations_deg", std::vector<double>(64, 0.0)}}),
            "rover.sensors.s: 64 lasers and columns = 100000 make 6400000 pulses a turn, must be "
            "at most 2000000");
  // 100 ms / 1800 = 55.6 us; the last lasers of the last columns would fire after the turn.
  EXPECT_EQ(error_of({{"firing_s", 0.001}}),
            "rover.sensors.s: firing_s = 0.001 s, must be at most the time from a column to the "
            "next, 5.55556e-05 s");
  EXPECT_EQ(error_of({{"columns", std::int64_t{900}}, {"column_s", 1e-4}}),
            "rover.sensors.s: columns = 900 and column_s = 0.0001 s are both given, must be one of "
            "them; column_s = 0 is none");
  EXPECT_EQ(error_of({{"column_s", 0.2}}),
            "rover.sensors.s: column_s = 0.2 s, must be at most the time of a turn, 0.1 s");
  EXPECT_EQ(error_of({{"column_s", 1e-8}}),
            "rover.sensors.s: 16 lasers and column_s = 1e-08 s make 160000000 pulses a turn, must "
            "be at most 2000000");
  const std::string rosette = "rosette";
  EXPECT_EQ(
      test::refusal_of([&] {
        Bench("lidar_3d",
              test::sensor_parameters("lidar_3d", {{"pattern", rosette}, {"pulses_per_s", 1e7}}),
              scene, 0.1);
      }),
      "rover.sensors.s: pulses_per_s = 1e+07 make 1e+08 pulses a period of 10 s, must be 1 "
      "to 2000000");
  EXPECT_EQ(error_of({{"pattern", rosette}, {"pulses_per_s", 4.0}}),
            "rover.sensors.s: pulses_per_s = 4 make 0.4 pulses a period of 0.1 s, must be 1 to "
            "2000000");
  EXPECT_EQ(
      error_of({{"slices", std::int64_t{7}}}),
      "rover.sensors.s: slices = 7 cut its period of 0.1 s into 0.0142857 s, must be a multiple of "
      "the physics step of 0.001 s");
  EXPECT_EQ(error_of({{"organised", true}, {"column_s", 1e-4}}),
            "rover.sensors.s: organised = true, which only a spinning pattern with columns can "
            "have; set it to false");
  EXPECT_EQ(error_of({{"organised", true}, {"pattern", rosette}}),
            "rover.sensors.s: organised = true, which only a spinning pattern with columns can "
            "have; set it to false");
  EXPECT_EQ(error_of({{"organised", true}, {"returns", std::string("dual")}}),
            "rover.sensors.s: organised = true, which has one point of each pulse; set returns to "
            "strongest or last");
  EXPECT_EQ(error_of({{"min_range_m", 120.0}}),
            "rover.sensors.s: min_range_m = 120 m, must be < max_range_m = 100 m");
}

}  // namespace
}  // namespace vinerow::sensors::lidar_3d_test
