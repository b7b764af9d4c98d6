/// Ellipses, trails and markers of estimates against closed forms, in numbers and in pixels.

#include "engine/playback/estimate_drawing.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "engine/math/angles.h"
#include "engine/playback/frame_composer.h"
#include "tests/engine/sim/small_parts.h"

namespace vinerow::playback::estimate_drawing_test {
namespace {

constexpr double kGround_m = 7.0;
const double kSigmas = std::sqrt(-2.0 * std::log(0.05));  // 2.4477

double level(double, double) {
  return kGround_m;
}

/// Standard deviations along and across a direction.
Odometry estimate_at(const Eigen::Vector3d& p, double along_m, double across_m,
                     double direction_rad) {
  Odometry estimate;
  estimate.X_WB.p = p;
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(direction_rad).toRotationMatrix();
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  P.topLeftCorner<2, 2>() =
      R * Eigen::Vector2d(along_m * along_m, across_m * across_m).asDiagonal() * R.transpose();
  P(2, 2) = 1.0;
  estimate.set_position_covariance(P);
  return estimate;
}

TEST(EstimateDrawing, TheEllipseIsWhereTheNormalizedErrorIs5991) {
  const Odometry estimate = estimate_at({3, -2, 9}, 0.8, 0.1, 0.4);
  const std::vector<Eigen::Vector2d> points = ellipse_95(estimate, 64);
  ASSERT_EQ(points.size(), 64u);
  double longest = 0.0, shortest = 1e9;
  Eigen::Vector2d farthest;
  for (const Eigen::Vector2d& p : points) {
    // Along and across, each over its standard deviation.
    const Eigen::Vector2d e = p - Eigen::Vector2d(3, -2);
    const double along = e.dot(Eigen::Vector2d(std::cos(0.4), std::sin(0.4))) / 0.8;
    const double across = e.dot(Eigen::Vector2d(-std::sin(0.4), std::cos(0.4))) / 0.1;
    EXPECT_NEAR(along * along + across * across, 5.991, 1e-3);
    if (e.norm() > longest) farthest = e;
    longest = std::max(longest, e.norm());
    shortest = std::min(shortest, e.norm());
  }
  EXPECT_NEAR(longest, kSigmas * 0.8, 1e-9);
  EXPECT_NEAR(shortest, kSigmas * 0.1, 1e-9);
  EXPECT_NEAR(std::remainder(std::atan2(farthest.y(), farthest.x()) - 0.4, kPi), 0.0, 1e-9);
}

TEST(EstimateDrawing, WhatIsNoCovarianceHasNoEllipse) {
  EXPECT_TRUE(ellipse_95(Odometry{}, 16).empty()) << "zero: the truth";
  Odometry estimate = estimate_at({0, 0, 0}, 1, 1, 0);
  estimate.position_variance_m2.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(ellipse_95(estimate, 16).empty());
  estimate = estimate_at({0, 0, 0}, 1, 1, 0);
  estimate.position_covariance_m2.x() = 1.5;  // more than both variances allow
  EXPECT_TRUE(ellipse_95(estimate, 16).empty());
  // Known exactly in one direction it is a stroke.
  for (const Eigen::Vector2d& p : ellipse_95(estimate_at({0, 0, 0}, 1, 0, 0), 16)) {
    EXPECT_NEAR(p.y(), 0.0, 1e-7);
  }
}

/// 1 m/s along x at a height of 2 m above the ground, with an estimate every half second.
Trace<Odometry> straight_flight(double std_m, int count = 9) {
  Trace<Odometry> trace;
  for (int i = 0; i < count; ++i) {
    trace.times.push_back(Time{} + duration_from_s(0.5 * i));
    trace.values.push_back(estimate_at({0.5 * i, 0, kGround_m + 2.0}, std_m, std_m, 0));
  }
  return trace;
}

TEST(EstimateDrawing, TrailMarkerPlumbLineAndEllipseAreBetweenTheSamples) {
  EstimateLook look;
  look.down_m = 0.5;
  look.marker_m = 0.3;
  const Trace<Odometry> trace = straight_flight(0.2);
  const auto lines = draw_estimate(trace, Time{} + duration_from_s(0.75), look, level);
  // No earlier ellipse within 1 m; trail, rim and ellipse, plumb line, rim and cross.
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_LT((lines[0].points_W.back() - Eigen::Vector3d(0.75, 0, kGround_m + 1.5)).norm(), 1e-9);
  EXPECT_LT((lines[0].points_W.front() - Eigen::Vector3d(0, 0, kGround_m + 1.5)).norm(), 1e-9);
  for (const Eigen::Vector3d& p : lines[2].points_W) {
    EXPECT_NEAR((p.head<2>() - Eigen::Vector2d(0.75, 0)).norm(), 0.2 * kSigmas, 1e-9);
    EXPECT_NEAR(p.z(), kGround_m, 0.1);
  }
  EXPECT_EQ(lines[2].points_W.front(), lines[2].points_W.back()) << "closed";
  EXPECT_LT((lines[3].points_W[0] - Eigen::Vector3d(0.75, 0, kGround_m + 2)).norm(), 1e-9);
  EXPECT_NEAR(lines[3].points_W[1].z(), kGround_m, 0.1);
  ASSERT_EQ(lines[5].points_W.size(), 8u);
  const Eigen::Vector3d middle(0.75, 0, kGround_m + 2);
  EXPECT_LT((lines[5].points_W[1] - middle - Eigen::Vector3d(0.3, 0, 0)).norm(), 1e-9);
  EXPECT_LT((lines[5].points_W[7] - middle - Eigen::Vector3d(0, -0.3, 0)).norm(), 1e-9);
  EXPECT_TRUE(draw_estimate({}, Time{}, look, level).empty());
  look.inside = true;
  EXPECT_EQ(draw_estimate(trace, Time{} + duration_from_s(0.75), look, level).size(), 2u)
      << "rim and ellipse";
}

TEST(EstimateDrawing, EarlierEllipsesTouchButDoNotOverlap) {
  // Radius 0.2 * 2.45 = 0.49: nearer than 1 m would do, so they are 1 m apart: at 3, 2, 1 and 0 m.
  const auto count_at = [](double std_m) {
    const auto lines =
        draw_estimate(straight_flight(std_m), Time{} + duration_from_s(4.0), EstimateLook{}, level);
    return lines[0].pairs ? lines[0].points_W.size() / 96 : 0;
  };
  EXPECT_EQ(count_at(0.2), 4u);
  // Diameter 1.96: at 2 and 0 m.
  EXPECT_EQ(count_at(0.4), 2u);
  EXPECT_EQ(count_at(1.0), 0u) << "one of 4.9 m is longer than the way";
}

/// A statue at (0, 0) whose estimator says (1, 0.5), with one observer, on level ground.
class EstimatePicture : public ::testing::Test {
 protected:
  EstimatePicture() {
    scenario::VehicleConfig rover;
    rover.name = "rover";
    rover.estimator.emplace();
    rover.observers.push_back({"no_map", {}});
    scenario_.vehicles.push_back(rover);
    vehicles_.push_back(std::make_unique<test::Statue>());
    scenario_.pictures.width = 400;
    scenario_.pictures.height = 300;
    HeightField ground;
    ground.columns = ground.rows = 33;
    ground.cell_m = 2.0;
    ground.corner_W = {-32, -32};
    ground.heights_m.assign(33 * 33, static_cast<float>(kGround_m));
    world_.terrain = ground;
    VehicleTrace& trace = trace_.vehicles["rover"];
    Odometry truth;
    truth.X_WB.p = {0, 0, kGround_m};
    trace.truth = {{Time{}}, {truth}};
    trace.estimates["estimate"] = {{Time{}},
                                   {estimate_at({1, 0.5, kGround_m}, 0.5, 0.25, 0.5 * kPi)}};
    trace.estimates["no_map"] = {{Time{}}, {estimate_at({-1, 0, kGround_m}, 1.0, 1.0, 0)}};
    camera_.kind = scenario::CameraKind::kTop;
    camera_.centre_W = Eigen::Vector2d(0, 0);
    camera_.height_m = 10.0;
    camera_.show_plan = false;
    camera_.show_estimate = true;
  }
  render::Frame compose() {
    render::Frame frame =
        FrameComposer(scenario_, world_, vehicles_, trace_).compose(camera_, Time{});
    return frame;
  }
  render::Image draw() {
    auto renderer = render::make_renderer(world_);
    EXPECT_TRUE(renderer.ok());
    render::Frame frame = compose();
    frame.caption.clear();
    frame.legend.clear();
    return (*renderer)->draw(frame);
  }
  /// 30 pixels a metre, north up, (0, 0) in the middle.
  static Eigen::Vector3i pixel(const render::Image& image, const Eigen::Vector2d& p) {
    const int x = static_cast<int>(200 + 30 * p.x()), y = static_cast<int>(150 - 30 * p.y());
    const std::uint8_t* rgb = &image.rgb[(static_cast<std::size_t>(y) * image.width + x) * 3];
    return {rgb[0], rgb[1], rgb[2]};
  }

  scenario::Scenario scenario_;
  WorldModel world_;
  std::vector<std::unique_ptr<Vehicle>> vehicles_;
  LogTrace trace_;
  scenario::CameraConfig camera_;
};

bool is_red(const Eigen::Vector3i& p) {
  return p[0] > 200 && p[1] < 60 && p[2] < 60;
}
bool is_white(const Eigen::Vector3i& p) {
  return p.minCoeff() > 235;
}

TEST_F(EstimatePicture, EllipsesAreSeenWhereTheCovariancesPutThem) {
  const render::Image image = draw();
  // The estimator's: centre (1, 0.5), 0.25 east-west and 0.5 north-south, times 2.4477.
  for (const int k : {-1, 1}) {
    EXPECT_TRUE(is_red(pixel(image, {1 + k * 0.25 * kSigmas, 0.5}))) << k;
    EXPECT_TRUE(is_red(pixel(image, {1, 0.5 + k * 0.5 * kSigmas}))) << k;
    // A circle of 1 m would pass here, one standard deviation here.
    EXPECT_FALSE(is_red(pixel(image, {1 + k * 0.5 * kSigmas, 0.5}))) << k;
    EXPECT_FALSE(is_red(pixel(image, {1, 0.5 + k * 0.5}))) << k;
  }
  // At 45 degrees of the ellipse's parameter.
  const double d = kSigmas * std::sqrt(0.5);
  EXPECT_TRUE(is_red(pixel(image, {1 + 0.25 * d, 0.5 + 0.5 * d})));
  // The observer's: a circle of 2.4477 m about (-1, 0).
  for (const double angle : {1.0, 2.0, 3.0, 4.0, 5.0}) {
    const Eigen::Vector2d out(std::cos(angle), std::sin(angle));
    EXPECT_TRUE(is_white(pixel(image, Eigen::Vector2d(-1, 0) + kSigmas * out))) << angle;
    EXPECT_FALSE(is_white(pixel(image, Eigen::Vector2d(-1, 0) + (kSigmas - 0.2) * out))) << angle;
  }
  // The marker's strokes.
  EXPECT_TRUE(is_red(pixel(image, {1.15, 0.5})));
  camera_.show_estimate = false;
  EXPECT_FALSE(is_red(pixel(draw(), {1.15, 0.5})));
}

TEST_F(EstimatePicture, TheLegendTellsWhoseColourItIsAndHowFarItIsOff) {
  const render::Frame frame = compose();
  ASSERT_EQ(frame.legend.size(), 2u);
  EXPECT_EQ(frame.legend[0].text, "estimate 1.12 m off");  // hypot(1, 0.5)
  EXPECT_EQ(frame.legend[1].text, "no_map 1.00 m off");
  EXPECT_NE(frame.legend[0].colour, frame.legend[1].colour);
  // The more certain one lies above.
  EXPECT_EQ(frame.lines.back().colour, frame.legend[0].colour);
  std::swap(trace_.vehicles["rover"].estimates["estimate"],
            trace_.vehicles["rover"].estimates["no_map"]);
  EXPECT_EQ(compose().lines.back().colour, frame.legend[1].colour);
  std::swap(trace_.vehicles["rover"].estimates["estimate"],
            trace_.vehicles["rover"].estimates["no_map"]);
  camera_.show_estimate = false;
  ASSERT_EQ(compose().legend.size(), 1u);
  EXPECT_EQ(compose().legend[0].text, "rover 0.0 m/s") << "the vehicle's marker";
}

TEST_F(EstimatePicture, WithoutAnEstimatorOnlyObserversAreDrawn) {
  scenario_.vehicles[0].estimator.reset();
  ASSERT_EQ(compose().legend.size(), 1u);
  EXPECT_EQ(compose().legend[0].text, "no_map 1.00 m off");
}

TEST_F(EstimatePicture, TheMapIsSeenThroughWhatHidesIt) {
  camera_.show_estimate = false;
  camera_.show_map = true;
  EXPECT_TRUE(compose().lines.empty()) << "it has none";
  // An edge 3 m long under a plate, through the middle of pixels.
  const double y = 3 - 0.5 / 30;
  trace_.vehicles["rover"].map_edges.points_W = {{-2, y, kGround_m + 1}, {1, y, kGround_m + 1}};
  MeshInstance plate;
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{-1, 2, 9}, {0, 2, 9}, {0, 4, 9}, {-1, 4, 9}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  plate.mesh = mesh;
  plate.material.colour = {0.2f, 0.2f, 0.2f};
  world_.meshes.push_back(plate);
  const render::Frame frame = compose();
  ASSERT_EQ(frame.lines.size(), 1u);
  EXPECT_TRUE(frame.lines[0].pairs);
  ASSERT_EQ(frame.legend.size(), 2u);
  EXPECT_EQ(frame.legend[0].text, "map");
  EXPECT_EQ(frame.legend[1].text, "rover 0.0 m/s");
  const render::Image image = draw();
  const auto is_cyan = [](const Eigen::Vector3i& p) {
    return p[0] < 160 && p[1] > 170 && p[2] > 170;
  };
  for (const double x : {-1.5, -0.5, 0.5}) {
    EXPECT_TRUE(is_cyan(pixel(image, {x, y}))) << x;
    EXPECT_FALSE(is_cyan(pixel(image, {x, y + 0.2}))) << x;
  }
  EXPECT_FALSE(is_cyan(pixel(image, {1.5, y})));
}

TEST_F(EstimatePicture, SeenAslantTheMapFadesBeforeItRunsTogether) {
  camera_.show_map = true;
  camera_.show_estimate = false;
  LineList& edges = trace_.vehicles["rover"].map_edges;
  // The eye of the chase is at (-6, 0, 9.5).
  edges.points_W = {{0, 0, 8}, {0, 1, 8}, {20, 0, 8}, {20, 1, 8}, {500, 0, 8}, {500, 1, 8}};
  ASSERT_EQ(compose().lines.size(), 1u);
  EXPECT_EQ(compose().lines[0].points_W.size(), 6u) << "from above all of it";
  camera_.kind = scenario::CameraKind::kChase;
  camera_.vehicle = "rover";
  const std::vector<render::Polyline> lines = compose().lines;
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].points_W[0].x(), 0.0);
  EXPECT_EQ(lines[1].points_W[0].x(), 20.0);
  EXPECT_LT(lines[1].alpha, lines[0].alpha);
}

}  // namespace
}  // namespace vinerow::playback::estimate_drawing_test
