#include "worlds/mapping/photogrammetry/photogrammetry.h"

#include <gtest/gtest.h>

#include <thread>

#include "engine/core/error.h"
#include "engine/math/polygon.h"
#include "tests/worlds/mapping/photogrammetry/cloud_scene.h"

namespace vinerow::mapping::photogrammetry_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHeight_m = 40.0;

/// 5 x 5 pictures, 6 m apart: all show the square of +-8 m.
std::vector<Pose> grid_poses() {
  std::vector<Pose> poses;
  for (int k = 0; k < 25; ++k) {
    poses.push_back(test::looking_down(6.0 * (k % 5 - 2), 6.0 * (k / 5 - 2), kHeight_m));
  }
  return poses;
}

/// Nothing is left out but what is hidden, and nothing has an error.
PhotogrammetryOptions plain(double density_per_m2) {
  PhotogrammetryOptions options;
  options.density_per_m2 = density_per_m2;
  options.match_px = 0.0;
  options.max_incidence_rad = 1.57;
  options.min_baseline_rad = 0.0;
  return options;
}

struct Sampled {
  test::Collected cloud;
  PhotogrammetryReport report;
};

Sampled sample(const WorldModel& world, const std::vector<Pose>& poses, double half_m,
               const PhotogrammetryOptions& options) {
  const physics::WorldScene scene(world);
  Sampled made;
  made.report =
      sample_photogrammetry(scene, world, test::square_camera(), poses,
                            SurveyArea(test::square(half_m), 0.0), options, made.cloud.sink());
  EXPECT_EQ(made.report.tally.points, static_cast<std::int64_t>(made.cloud.points.size()));
  return made;
}

const Vector3d kLow(-2.0, -1.5, 0.0), kHigh(2.0, 1.5, 2.0);

enum class Side { kGround, kTop, kWest, kEast, kSouth, kNorth, kNotFound };

Side side_of(const Vector3d& p) {
  constexpr double kOff_m = 1e-4;
  const bool in_plan = (p.head<2>().array() > kLow.head<2>().array() - kOff_m).all() &&
                       (p.head<2>().array() < kHigh.head<2>().array() + kOff_m).all();
  if (!in_plan) return std::abs(p.z()) < kOff_m ? Side::kGround : Side::kNotFound;
  if (std::abs(p.z() - kHigh.z()) < kOff_m) return Side::kTop;
  if (p.z() < -kOff_m || p.z() > kHigh.z()) return Side::kNotFound;
  if (std::abs(p.x() - kLow.x()) < kOff_m) return Side::kWest;
  if (std::abs(p.x() - kHigh.x()) < kOff_m) return Side::kEast;
  if (std::abs(p.y() - kLow.y()) < kOff_m) return Side::kSouth;
  if (std::abs(p.y() - kHigh.y()) < kOff_m) return Side::kNorth;
  return Side::kNotFound;
}

std::map<Side, int> count_sides(const Sampled& made) {
  std::map<Side, int> count;
  for (const SampledPoint& point : made.cloud.points) ++count[side_of(point.p_W)];
  return count;
}

/// Where the rays through a point meet z = 0.
Vector2d shadow(const Vector3d& eye, const Vector3d& p) {
  return (eye + (p - eye) * (eye.z() / (eye.z() - p.z()))).head<2>();
}

TEST(Photogrammetry, ABoxHasPointsWhereRaysMeetItAndNowhereElse) {
  const WorldModel world = test::level_world(50.0, {test::box(kLow, kHigh)});
  const double density = 1500.0;
  const Sampled made = sample(world, grid_poses(), 8.0, plain(density));
  const std::map<Side, int> count = count_sides(made);
  EXPECT_EQ(count.count(Side::kNotFound), 0u) << "on no surface, or below the box";

  // Every picture aims at the same density of the ground, and each ray within the box's shadow
  // meets the box: the top where it goes through the top's shadow, which is the top enlarged.
  const double enlarged = kHeight_m / (kHeight_m - kHigh.z());
  const double top = density * 4.0 * 3.0 * enlarged * enlarged;
  EXPECT_NEAR(count.at(Side::kTop), top, 0.01 * top);
  double all = 0.0;
  for (const Pose& pose : grid_poses()) {
    Polygon corners;
    for (int k = 0; k < 8; ++k) {
      corners.push_back(
          shadow(pose.p, {(k & 1) != 0 ? kLow.x() : kHigh.x(), (k & 2) != 0 ? kLow.y() : kHigh.y(),
                          (k & 4) != 0 ? kLow.z() : kHigh.z()}));
    }
    all += density * signed_area_m2(convex_hull(corners)) / 25.0;
  }
  const double sides = all - top;
  const int counted = count.at(Side::kWest) + count.at(Side::kEast) + count.at(Side::kSouth) +
                      count.at(Side::kNorth);
  EXPECT_NEAR(counted, sides, 0.05 * sides);  // 2000 points: five times 1 / sqrt(2000) is 11 %
  EXPECT_NEAR(count.at(Side::kWest), count.at(Side::kEast), 0.2 * count.at(Side::kEast));
  for (const SampledPoint& point : made.cloud.points) {
    EXPECT_EQ(point.truth,
              side_of(point.p_W) == Side::kGround ? PointClass::kGround : PointClass::kCanopy);
  }
}

TEST(Photogrammetry, WhatIsHiddenFromAllPicturesIsMissing) {
  const WorldModel world = test::level_world(50.0, {test::box(kLow, kHigh)});
  // Three pictures east of the box, along a line from south to north.
  const std::vector<Pose> poses = {test::looking_down(12.0, -3.0, kHeight_m),
                                   test::looking_down(12.0, 0.0, kHeight_m),
                                   test::looking_down(12.0, 3.0, kHeight_m)};
  const Sampled made = sample(world, poses, 7.5, plain(1500.0));
  const std::map<Side, int> count = count_sides(made);
  EXPECT_EQ(count.count(Side::kWest), 0u);
  EXPECT_EQ(count.count(Side::kSouth), 0u) << "only the southern picture sees it";
  EXPECT_EQ(count.count(Side::kNorth), 0u);
  EXPECT_GT(count.at(Side::kEast), 500);
  // On y = 0 the box hides the ground up to where the middle picture's ray over its far edge lands.
  const double end = shadow(poses[1].p, {kLow.x(), 0.0, kHigh.z()}).x();
  double nearest = -100.0;
  for (const SampledPoint& point : made.cloud.points) {
    const Vector3d& p = point.p_W;
    if (std::abs(p.y()) > 0.5 || p.x() > -1.9) continue;
    EXPECT_TRUE(p.x() < end + 1e-3 || p.z() > 1e-3) << p.transpose();
    if (p.z() < 1e-3) nearest = std::max(nearest, p.x());
  }
  EXPECT_NEAR(nearest, end, 0.05);
}

TEST(Photogrammetry, ThreePicturesMakeAPointAndTwoDoNot) {
  const WorldModel world = test::level_world(50.0, {});
  // Pictures 20 m long at x = -12, -4, 4, 12: three see [-6, -2] and [2, 6], two what is between.
  std::vector<Pose> poses;
  for (const double x : {-12.0, -4.0, 4.0, 12.0}) poses.push_back(test::looking_down(x, 0.0, 20.0));
  const auto views_at = [](double x) {
    int views = 0;
    for (const double c : {-12.0, -4.0, 4.0, 12.0}) views += std::abs(x - c) < 10.0 ? 1 : 0;
    return views;
  };
  const Sampled made = sample(world, poses, 9.0, plain(400.0));
  int inside = 0;
  for (const SampledPoint& point : made.cloud.points) {
    EXPECT_GE(views_at(point.p_W.x()), 3) << point.p_W.x();
    ++inside;
  }
  const double expected = 400.0 * 8.0 * 18.0;
  EXPECT_NEAR(inside, expected, 0.01 * expected);
  EXPECT_DOUBLE_EQ(made.report.tally.mean_views(), 3.0);

  PhotogrammetryOptions two = plain(400.0);
  two.min_views = 2;
  const Sampled more = sample(world, poses, 9.0, two);
  EXPECT_NEAR(static_cast<double>(more.cloud.points.size()), 400.0 * 18.0 * 18.0,
              0.01 * 400.0 * 18.0 * 18.0);
}

TEST(Photogrammetry, PicturesFromNearlyOnePlaceGiveNoPoint) {
  const WorldModel world = test::level_world(50.0, {});
  std::vector<Pose> poses;
  for (const double x : {-1.0, 0.0, 1.0}) poses.push_back(test::looking_down(x, 0.0, 40.0));
  PhotogrammetryOptions options = plain(100.0);
  options.min_baseline_rad = 0.06;  // 2 m at 40 m are 0.05
  EXPECT_EQ(sample(world, poses, 5.0, options).report.tally.points, 0);
  options.min_baseline_rad = 0.02;
  EXPECT_GT(sample(world, poses, 5.0, options).report.tally.points, 9000);
}

TEST(Photogrammetry, GrazingViewsSeeNothing) {
  const WorldModel world = test::level_world(50.0, {test::box(kLow, kHigh)});
  PhotogrammetryOptions options = plain(400.0);
  options.max_incidence_rad = 1.2;  // 69 deg: walls are seen 80 deg off their normal at best
  const std::map<Side, int> count = count_sides(sample(world, grid_poses(), 8.0, options));
  for (const Side side : {Side::kWest, Side::kEast, Side::kSouth, Side::kNorth}) {
    EXPECT_EQ(count.count(side), 0u);
  }
  EXPECT_GT(count.at(Side::kTop), 4000);
}

TEST(Photogrammetry, LevelGroundHasTheWantedDensity) {
  const WorldModel world = test::level_world(50.0, {});
  for (const double density : {3.0, 250.0, 1500.0}) {
    const Sampled made = sample(world, grid_poses(), 7.0, plain(density));
    EXPECT_NEAR(static_cast<double>(made.cloud.points.size()), density * 196.0,
                0.02 * density * 196.0 + 3.0);
  }
  // One pixel of 40 m / 1000 is 1 / 625 m2.
  PhotogrammetryOptions options = plain(1.0);
  options.density_per_m2.reset();
  const Sampled made = sample(world, grid_poses(), 7.0, options);
  EXPECT_NEAR(made.report.gsd_m, 0.04, 1e-12);
  EXPECT_NEAR(static_cast<double>(made.cloud.points.size()), 625.0 * 196.0, 0.01 * 625.0 * 196.0);
}

TEST(Photogrammetry, ErrorsAreThoseOfForwardIntersection) {
  const WorldModel world = test::level_world(50.0, {});
  const std::vector<Pose> poses = {test::looking_down(-8.0, 0.0, 40.0),
                                   test::looking_down(0.0, 0.0, 40.0),
                                   test::looking_down(8.0, 0.0, 40.0)};
  PhotogrammetryOptions options = plain(20000.0);
  options.match_px = 0.5;
  const Sampled made = sample(world, poses, 1.0, options);
  // GSD 40 mm; as in the normal case of stereo with a third picture between. Off the middle by up
  // to 1 m in 40 m, which changes less than 1 %.
  const double across = 0.5 * 0.04 / std::sqrt(3.0),
               height = 0.5 * 0.04 * 40.0 / (8.0 * std::sqrt(2.0));
  EXPECT_NEAR(made.report.tally.height_rms_m(), height, 0.02 * height);
  EXPECT_NEAR(made.report.tally.horizontal_rms_m(), across * std::sqrt(2.0), 0.02 * across);
  double sum = 0.0;
  for (const SampledPoint& point : made.cloud.points) sum += point.p_W.z() * point.p_W.z();
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(made.cloud.points.size())),
              made.report.tally.height_rms_m(), 1e-6);
}

TEST(Photogrammetry, TheSameSeedGivesTheSameBitsHoweverItIsScheduled) {
  const WorldModel world = test::level_world(50.0, {test::box(kLow, kHigh)});
  PhotogrammetryOptions options = plain(700.0);
  options.match_px = 0.5;
  const Sampled alone = sample(world, grid_poses(), 8.0, options);
  Sampled crowded[3];
  {
    std::vector<std::jthread> threads;
    for (Sampled& made : crowded) {
      threads.emplace_back([&] { made = sample(world, grid_poses(), 8.0, options); });
    }
  }
  for (const Sampled& made : crowded) {
    EXPECT_TRUE(made.cloud == alone.cloud);
    EXPECT_EQ(made.report.tally.height_error2_m2, alone.report.tally.height_error2_m2);
  }
  options.seed = 2;
  EXPECT_FALSE(sample(world, grid_poses(), 8.0, options).cloud == alone.cloud);
}

TEST(Photogrammetry, WhereNoGroundIsAreNoPoints) {
  const WorldModel world = test::level_world(50.0, {});
  const physics::WorldScene scene(world);
  std::vector<Pose> poses;  // that show x up to 65 m
  for (const double y : {-5.0, 0.0, 5.0}) poses.push_back(test::looking_down(45.0, y, kHeight_m));
  test::Collected cloud;
  const SurveyArea area({{40, -5}, {60, -5}, {60, 5}, {40, 5}}, 0.0);
  sample_photogrammetry(scene, world, test::square_camera(), poses, area, plain(100.0),
                        cloud.sink());
  EXPECT_NEAR(static_cast<double>(cloud.points.size()), 10'000.0, 100.0);
  for (const SampledPoint& point : cloud.points) EXPECT_LE(point.p_W.x(), 50.0);
}

std::string refusal(const PhotogrammetryOptions& options, double x_m = 0.0) {
  const WorldModel world = test::level_world(50.0, {});
  const physics::WorldScene scene(world);
  try {
    test::Collected cloud;
    sample_photogrammetry(scene, world, test::square_camera(), {test::looking_down(x_m, 0.0, 10.0)},
                          SurveyArea(test::square(2.0), 0.0), options, cloud.sink());
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(Photogrammetry, RefusesWhatCannotBe) {
  PhotogrammetryOptions options = plain(0.0);
  EXPECT_EQ(refusal(options),
            "the cloud's density is 0 points per square metre, must be above 0 and at most "
            "1000000");
  options = plain(10.0);
  EXPECT_EQ(refusal(options, 40.0), "none of the 1 pictures shows the cloud's area");
  options.min_views = 1;
  EXPECT_EQ(refusal(options),
            "a point is seen by 1 pictures at least, must be two or more: one alone has no depth");
  options = plain(10.0);
  options.max_views = 2;
  EXPECT_EQ(refusal(options), "min_views = 3, must be <= max_views = 2");
  options = plain(10.0);
  options.match_px = -0.5;
  EXPECT_EQ(refusal(options), "the matching error is -0.5 pixels, must be 0 or more");
  options = plain(10.0);
  options.max_incidence_rad = 1.6;
  EXPECT_EQ(refusal(options),
            "the largest angle off a surface's normal is 91.7 deg, must be above 0 and below 90 "
            "deg");
}

TEST(SurveyArea, CirclesInsideReachTheNearestEdge) {
  // An L: 4 m by 4 m without its upper right quarter. Margins do not count.
  const SurveyArea area({{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}, 1.0);
  EXPECT_NEAR(area.inside_m({1.0, 1.2}), 1.0, 1e-5);
  EXPECT_NEAR(area.inside_m({1.5, 1.7}), std::hypot(0.5, 0.3), 1e-5);  // the inner corner
  EXPECT_NEAR(area.inside_m({3.9, 0.5}), 0.1, 1e-5);
  EXPECT_EQ(area.inside_m({3.0, 3.0}), 0.0);
  EXPECT_EQ(area.inside_m({4.5, 1.0}), 0.0);  // in the margin
}

TEST(SurveyArea, RefusesWhatIsNoArea) {
  const auto refused = [](Polygon polygon, double margin_m) -> std::string {
    try {
      SurveyArea area(std::move(polygon), margin_m);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused({{0, 0}, {1, 1}}, 0.0), "area_m has 2 corners, must have at least three");
  EXPECT_NE(refused({{0, 0}, {9, 9}, {9, 0}, {0, 9}}, 0.0).find("crosses itself"),
            std::string::npos);
  EXPECT_EQ(refused(test::square(1.0), -1.0),
            "the margin around the cloud's area is -1 m, must be 0 m or more");
  const SurveyArea area(test::square(1.0), 0.5);
  EXPECT_TRUE(area.contains({1.4, 0.0}));
  EXPECT_FALSE(area.contains({1.6, 0.0}));
  EXPECT_FALSE(area.contains({1.4, 1.4})) << "corners are round";
  EXPECT_TRUE(area.contains({1.6, 0.0}, 0.2));
}

}  // namespace
}  // namespace vinerow::mapping::photogrammetry_test
