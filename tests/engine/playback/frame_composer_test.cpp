#include "engine/playback/frame_composer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/api/mesh.h"
#include "engine/math/angles.h"
#include "engine/render/cameras.h"
#include "tests/engine/sim/small_parts.h"

namespace vinerow::playback::frame_composer_test {
namespace {

/// One vehicle without links on level ground at 7 m, with a plan and its tree written at 1 s.
class ComposedFrame : public ::testing::Test {
 protected:
  ComposedFrame() {
    scenario::VehicleConfig rover;
    rover.name = "rover";
    scenario_.vehicles.push_back(rover);
    vehicles_.push_back(std::make_unique<test::Statue>());
    scenario_.pictures.width = 200;
    scenario_.pictures.height = 100;
    HeightField ground;
    ground.columns = ground.rows = 2;
    ground.cell_m = 100.0;
    ground.corner_W = {-50, -50};
    ground.heights_m.assign(4, 7.0f);
    world_.terrain = ground;
    VehicleTrace& trace = trace_.vehicles["rover"];
    PlannedPath plan;
    plan.points.resize(2);
    plan.points[1].p_W = {3, 0, 0};
    trace.plan.times = {Time{1'000'000'000}};
    trace.plan.values = {plan};
    LineList tree;
    tree.points_W = {{0, 0, 0}, {1, 0, 0}, {1, 0, 9}, {2, 1, 9}};
    trace.plan_tree.times = trace.plan.times;
    trace.plan_tree.values = {tree};
  }
  render::Frame compose(const scenario::CameraConfig& camera, double t_s = 2.0) {
    const FrameComposer composer(scenario_, world_, vehicles_, trace_, {phases_, false});
    return composer.compose(camera, Time{} + duration_from_s(t_s));
  }
  static OccupancyGrid grid_of(double cell_m) {
    OccupancyGrid grid;
    grid.columns = grid.rows = 1;
    grid.cell_m = cell_m;
    grid.cells = {1};
    return grid;
  }

  scenario::Scenario scenario_;
  WorldModel world_;
  std::vector<std::unique_ptr<Vehicle>> vehicles_;
  LogTrace trace_;
  std::map<std::string, PhaseSpan> phases_;

  /// Drives 1 m/s to the east from the origin at 8 m, a pose a second until then.
  void drive_until(int last_s, const std::string& vehicle = "rover") {
    Trace<Odometry>& truth = trace_.vehicles[vehicle].truth;
    truth = {};
    for (int k = 0; k <= last_s; ++k) {
      Odometry odometry;
      odometry.X_WB.p = {1.0 * k, 0, 8};
      odometry.v_WB_B = {1, 0, 0};
      truth.times.push_back(Time{} + duration_from_s(k));
      truth.values.push_back(odometry);
    }
  }
  void add_phase(const std::string& name, const std::string& vehicle, PhaseSpan span) {
    scenario::PhaseConfig phase;
    phase.name = name;
    phase.vehicles = {vehicle};
    scenario_.phases.push_back(phase);
    phases_[name] = span;
  }
  void add_vehicle(const std::string& name, std::unique_ptr<Vehicle> vehicle) {
    scenario::VehicleConfig config;
    config.name = name;
    scenario_.vehicles.push_back(config);
    vehicles_.push_back(std::move(vehicle));
    trace_.vehicles[name];
  }
};

scenario::CameraConfig top_camera() {
  scenario::CameraConfig camera;
  camera.kind = scenario::CameraKind::kTop;
  return camera;
}

TEST_F(ComposedFrame, ATopCameraLooksAtTheGivenPlace) {
  scenario::CameraConfig camera = top_camera();
  camera.centre_W = Eigen::Vector2d(12, -5);
  camera.height_m = 8.0;
  const render::Camera placed = compose(camera).camera;
  EXPECT_TRUE(placed.orthographic);
  EXPECT_DOUBLE_EQ(placed.ortho_height_m, 8.0);
  Eigen::Vector2d pixel;
  ASSERT_TRUE(render::project(placed, 200, 100, {12, -5, 7}, pixel));
  EXPECT_LT((pixel - Eigen::Vector2d(100, 50)).norm(), 1e-9);
  // 100 pixels are 8 m: 2 m north are 25 pixels up.
  ASSERT_TRUE(render::project(placed, 200, 100, {12, -3, 7}, pixel));
  EXPECT_LT((pixel - Eigen::Vector2d(100, 25)).norm(), 1e-9);
}

TEST_F(ComposedFrame, ATopCameraShowsTheWholeOfAWorldOfMeshes) {
  world_.terrain.reset();
  MeshInstance hill;
  hill.mesh = std::make_shared<TriangleMesh>(
      TriangleMesh{{{0, 0, -30}, {100, 0, -20}, {100, 40, -20}, {0, 40, -30}},
                   {{0, 1, 2}, {0, 2, 3}},
                   {},
                   {},
                   {},
                   {}});
  hill.surface = SurfaceClass::kTerrain;
  world_.meshes.push_back(hill);
  const render::Camera placed = compose(top_camera()).camera;
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(0, 0, -30), Eigen::Vector3d(100, 40, -20), Eigen::Vector3d(0, 40, -30)}) {
    Eigen::Vector2d pixel;
    ASSERT_TRUE(render::project(placed, 200, 100, corner, pixel));
    EXPECT_TRUE((pixel.array() >= 0.0).all() && pixel.x() <= 200.0 && pixel.y() <= 100.0) << pixel;
  }
}

TEST_F(ComposedFrame, AScansEchoesStandWhereTheBeamsEnd) {
  LaserScan scan;
  scan.first_angle_rad = -0.5 * kPi;
  scan.angle_step_rad = 0.5 * kPi;
  scan.ranges_m = {2.0, std::numeric_limits<double>::infinity(), 3.0};
  scan.X_WS.p = {10, 0, 8};
  Trace<LaserScan>& trace = trace_.vehicles["rover"].scans["lidar"];
  trace.times = {Time{1'000'000'000}};
  trace.values = {scan};
  scenario::CameraConfig camera = top_camera();
  camera.show_plan = camera.show_trail = false;
  EXPECT_TRUE(compose(camera).lines.empty());
  camera.show_sensor_rays = true;
  EXPECT_TRUE(compose(camera, 0.5).lines.empty()) << "the scan comes later";
  const render::Frame frame = compose(camera);
  ASSERT_EQ(frame.lines.size(), 2u);
  for (const render::Polyline& line : frame.lines) EXPECT_TRUE(line.pairs);
  // Beams from the sensor to the right and to the left; nothing ahead.
  ASSERT_EQ(frame.lines[0].points_W.size(), 4u);
  EXPECT_NEAR((frame.lines[0].points_W[0] - Eigen::Vector3d(10, 0, 8)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((frame.lines[0].points_W[1] - Eigen::Vector3d(10, -2, 8)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((frame.lines[0].points_W[3] - Eigen::Vector3d(10, 3, 8)).norm(), 0.0, 1e-12);
  // Upright marks at the echoes.
  ASSERT_EQ(frame.lines[1].points_W.size(), 4u);
  const Eigen::Vector3d mark = frame.lines[1].points_W[1] - frame.lines[1].points_W[0];
  EXPECT_NEAR(mark.head<2>().norm(), 0.0, 1e-12);
  EXPECT_GT(mark.z(), 0.0);
}

TEST_F(ComposedFrame, AShotIsDrawnFromWhereItWasTakenWithItsAngles) {
  // 20 m above the ground, straight down, upper edge to the north: 30 m by 20 m.
  CameraShot shot;
  shot.index = 4;
  shot.X_WS.p = {5, 6, 27};
  shot.X_WS.q = quaternion_from_rpy({0, std::acos(-1.0) / 2, 0});  // upper edge to the east
  shot.X_WS.q = quaternion_from_rpy({0, 0, std::acos(-1.0) / 2}) * shot.X_WS.q;
  shot.corners_W = {Eigen::Vector3d(-10, 16, 7), Eigen::Vector3d(20, 16, 7),
                    Eigen::Vector3d(20, -4, 7), Eigen::Vector3d(-10, -4, 7)};
  shot.on_ground = true;
  Trace<CameraShot>& shots = trace_.vehicles["rover"].shots["camera"];
  CameraShot in_the_sky;
  shots.times = {Time{500'000'000}, Time{1'000'000'000}};
  shots.values = {in_the_sky, shot};
  const auto view = view_of(shots);
  ASSERT_TRUE(view);
  EXPECT_NEAR(view->across, 0.75, 1e-12);
  EXPECT_NEAR(view->along, 0.5, 1e-12);
  EXPECT_FALSE(view_of({{Time{}}, {in_the_sky}}));

  scenario::CameraConfig camera;
  camera.kind = scenario::CameraKind::kShots;
  camera.vehicle = "rover";
  camera.show_plan = camera.show_trail = false;
  const render::Frame frame = compose(camera);
  EXPECT_EQ(frame.height, 100);
  EXPECT_EQ(frame.width, 150);
  EXPECT_TRUE(frame.vehicles.empty());
  // Its corners are the picture's corners.
  const Eigen::Vector2d pixels[] = {{0, 0}, {150, 0}, {150, 100}, {0, 100}};
  for (std::size_t i = 0; i < 4; ++i) {
    Eigen::Vector2d pixel;
    ASSERT_TRUE(render::project(frame.camera, 150, 100, shot.corners_W[i], pixel));
    EXPECT_LT((pixel - pixels[i]).norm(), 1e-9) << i;
  }
  EXPECT_EQ(frame.caption.back(), "picture 4 · 0.0 m to the ground, 0.0 mm per pixel");
}

TEST_F(ComposedFrame, LinesOfAFlightAreDrawnAtItsHeight) {
  VehicleTrace& trace = trace_.vehicles["rover"];
  PlannedPath& plan = trace.plan.values[0];
  plan.points[0].p_W = {0, 0, 8.5};
  plan.points[1].p_W = {3, 0, 10.0};
  for (int i = 0; i < 3; ++i) {
    Odometry truth;
    truth.X_WB.p = {1.0 * i, 0, 8.5 + 0.5 * i};
    trace.truth.times.push_back(Time{} + duration_from_s(i));
    trace.truth.values.push_back(truth);
  }
  const render::Frame frame = compose(top_camera());
  ASSERT_EQ(frame.lines.size(), 2u);
  EXPECT_NEAR(frame.lines[0].points_W[0].z(), 8.5, 0.1);
  EXPECT_NEAR(frame.lines[0].points_W[1].z(), 10.0, 0.1);
  ASSERT_EQ(frame.lines[1].points_W.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(frame.lines[1].points_W[i].z(), 8.5 + 0.5 * i, 0.1) << "the trail";
  }
}

// A rotorcraft pitches to gain speed; who chases it would nod with it, and dive into the ground.
TEST_F(ComposedFrame, AChaseOfAFlyerDoesNotNodAndStaysAboveTheGround) {
  scenario::CameraConfig camera;
  camera.kind = scenario::CameraKind::kChase;
  camera.vehicle = "rover";
  camera.distance_m = 5.0;
  camera.height_m = 1.0;
  Trace<Odometry>& truth = trace_.vehicles["rover"].truth;
  truth.times = {Time{}};
  truth.values.resize(1);
  const auto eye_at = [&](double pitch_rad, double z) {
    truth.values[0].X_WB = {quaternion_from_rpy({0, pitch_rad, 0}), {1, 2, z}};
    return Eigen::Vector3d(compose(camera).camera.X_WC.p);
  };
  // What drives: the eye goes down behind a vehicle that looks up, 5 tan(0.3).
  EXPECT_NEAR(eye_at(-0.3, 20).z(), 21.0 - 5 * std::tan(0.3), 1e-9);
  vehicles_[0] = std::make_unique<test::Statue>(0.0, true);
  EXPECT_LT((eye_at(-0.3, 20) - Eigen::Vector3d(-4, 2, 21)).norm(), 1e-9);
  EXPECT_LT((eye_at(0.3, 20) - Eigen::Vector3d(-4, 2, 21)).norm(), 1e-9);
  camera.height_m = -3.0;
  EXPECT_NEAR(eye_at(0, 20).z(), 17.0, 1e-9);
  EXPECT_NEAR(eye_at(0, 8.5).z(), 7.5, 1e-9) << "half a metre above the ground at 7 m";
}

TEST_F(ComposedFrame, TheTreeIsDrawnOnTheGroundFromWhenItIsThere) {
  scenario::CameraConfig camera = top_camera();
  camera.show_plan = false;
  EXPECT_TRUE(compose(camera).lines.empty());
  camera.show_tree = true;
  EXPECT_TRUE(compose(camera, 0.5).lines.empty());
  const render::Frame frame = compose(camera);
  ASSERT_EQ(frame.lines.size(), 1u);
  EXPECT_TRUE(frame.lines[0].pairs);
  ASSERT_EQ(frame.lines[0].points_W.size(), 4u);
  EXPECT_NEAR(frame.lines[0].points_W[0].z(), 7.0, 0.1);
  EXPECT_NEAR(frame.lines[0].points_W[3].z(), 9.0, 0.1);
  // The plan is drawn over it.
  camera.show_plan = true;
  ASSERT_EQ(compose(camera).lines.size(), 2u);
  EXPECT_TRUE(compose(camera).lines[1].dashed);
}

TEST_F(ComposedFrame, TheGridIsTheLogsOrElseTheWorlds) {
  scenario::CameraConfig camera = top_camera();
  camera.show_grid = true;
  EXPECT_EQ(compose(camera).grid, nullptr) << "there is none";
  world_.rows->occupancy = grid_of(0.1);
  ASSERT_NE(compose(camera).grid, nullptr);
  EXPECT_EQ(compose(camera).grid->cell_m, 0.1);
  trace_.map = grid_of(0.2);
  EXPECT_EQ(compose(camera).grid->cell_m, 0.2);
  camera.show_grid = false;
  EXPECT_EQ(compose(camera).grid, nullptr);
}

TEST_F(ComposedFrame, AViewOfTheWholeGridShowsTheParcelsBoundary) {
  world_.rows->boundary_W = {{-40, -30}, {40, -30}, {40, 30}, {-40, 30}};
  scenario::CameraConfig camera = top_camera();
  const double without_m = compose(camera).camera.ortho_height_m;
  camera.show_grid = true;
  const double with_m = compose(camera).camera.ortho_height_m;
  EXPECT_LT(without_m, 20.0);
  EXPECT_GE(with_m, 60.0);
  EXPECT_LT(with_m, 70.0);
}

scenario::CameraConfig fixed_camera() {
  scenario::CameraConfig camera;
  camera.kind = scenario::CameraKind::kFixed;
  camera.p_W = {-20, 0, 5};
  camera.show_plan = false;
  return camera;
}

TEST_F(ComposedFrame, AnOldTrailIsGoneFromAViewAslant) {
  drive_until(100);
  const render::Frame frame = compose(fixed_camera(), 100.0);
  ASSERT_EQ(frame.lines.size(), 1u);
  const render::Polyline& trail = frame.lines[0];
  ASSERT_EQ(trail.fade.size(), trail.points_W.size());
  for (std::size_t i = 0; i < trail.fade.size(); ++i) {
    const double age_s = 100.0 - trail.points_W[i].x();
    EXPECT_LE(age_s, 40.0);
    // Whole for 8 s, then evenly to nothing at 40 s.
    EXPECT_NEAR(trail.fade[i], std::clamp((40.0 - age_s) / 32.0, 0.0, 1.0), 1e-6);
  }
  EXPECT_DOUBLE_EQ(trail.points_W.front().x(), 100.0) << "the latest is drawn first";
  EXPECT_DOUBLE_EQ(trail.points_W.back().x(), 60.0);
  // From above the whole way is seen.
  scenario::CameraConfig above = top_camera();
  above.show_plan = false;
  const render::Polyline whole = compose(above, 100.0).lines.at(0);
  EXPECT_TRUE(whole.fade.empty());
  EXPECT_DOUBLE_EQ(whole.points_W.front().x(), 0.0);
}

TEST_F(ComposedFrame, ATrailBesideAnEstimatesIsAsLongAsThat) {
  drive_until(100);
  scenario::CameraConfig camera = fixed_camera();
  camera.show_estimate = true;
  const render::Frame frame = compose(camera, 100.0);
  ASSERT_EQ(frame.lines.size(), 1u);
  EXPECT_TRUE(frame.lines[0].fade.empty());
  EXPECT_EQ(frame.lines[0].points_W.size(), 101u);
}

TEST_F(ComposedFrame, WhoStandsParkedHasNoTrailNoPlanAndNoSpeed) {
  drive_until(100);
  add_phase("spray_rows", "rover", {Time{} + duration_from_s(20), Time{} + duration_from_s(60)});
  const render::Frame working = compose(top_camera(), 50.0);
  ASSERT_EQ(working.lines.size(), 2u);
  EXPECT_DOUBLE_EQ(working.lines[1].points_W.front().x(), 20.0) << "since the phase began";
  ASSERT_EQ(working.caption.size(), 2u);
  EXPECT_EQ(working.caption[1], "00:50.0 · spray rows");
  ASSERT_EQ(working.legend.size(), 2u);
  EXPECT_EQ(working.legend[0].text, "rover 1.0 m/s");
  EXPECT_EQ(working.legend[0].colour, working.lines[1].colour);
  EXPECT_EQ(working.legend[1].text, "plan");
  EXPECT_EQ(working.legend[1].colour, working.lines[0].colour);

  const render::Frame parked = compose(top_camera(), 70.0);
  EXPECT_TRUE(parked.lines.empty());
  EXPECT_TRUE(parked.legend.empty());
  EXPECT_EQ(parked.caption[1], "01:10.0");
}

TEST_F(ComposedFrame, SpeedsStandInTheTextWhereNoLineHasTheVehiclesColour) {
  drive_until(10);
  scenario::CameraConfig camera = fixed_camera();
  camera.kind = scenario::CameraKind::kChase;
  camera.vehicle = "rover";
  camera.show_trail = false;
  const render::Frame frame = compose(camera, 5.0);
  EXPECT_EQ(frame.caption[1], "00:05.0 · rover 1.0 m/s");
  EXPECT_TRUE(frame.legend.empty());
}

TEST_F(ComposedFrame, AMapMarksVehiclesAndHasAScale) {
  drive_until(10);
  add_vehicle("plane", std::make_unique<test::Statue>(0.0, true));
  drive_until(10, "plane");
  for (Odometry& truth : trace_.vehicles["plane"].truth.values) truth.X_WB.p.y() = 1.0;
  add_phase("spray", "rover", {Time{}, std::nullopt});
  const render::Frame frame = compose(top_camera(), 5.0);
  EXPECT_TRUE(frame.show_scale);
  ASSERT_EQ(frame.markers.size(), 2u);
  EXPECT_EQ(frame.markers[0].text, "rover");
  EXPECT_EQ(frame.markers[0].p_W, Eigen::Vector3d(5, 0, 8));
  EXPECT_EQ(frame.markers[1].text, "plane (parked)");
  EXPECT_FALSE(compose(fixed_camera(), 5.0).show_scale);
  // Seen from a fixed place those in the picture have their names too, those behind it none.
  scenario::CameraConfig fixed = fixed_camera();
  fixed.target_W = {5, 0, 0};
  EXPECT_EQ(compose(fixed, 5.0).markers.size(), 2u);
  fixed.target_W = {-50, 0, 0};
  EXPECT_TRUE(compose(fixed, 5.0).markers.empty());
  scenario::CameraConfig chase;
  chase.vehicle = "rover";
  EXPECT_TRUE(compose(chase, 5.0).markers.empty());
  // Parked outside the picture it needs no arrow; at work it does.
  scenario::CameraConfig small = top_camera();
  small.centre_W = Eigen::Vector2d(5, -4);
  small.height_m = 9.0;
  EXPECT_EQ(compose(small, 5.0).markers.size(), 1u);
  add_phase("survey", "plane", {Time{}, std::nullopt});
  EXPECT_EQ(compose(small, 5.0).markers.size(), 2u);
}

/// Wings without anything else.
class Glider final : public Vehicle {
 public:
  Glider() { description_.fixed_wing.emplace(); }
  const VehicleDescription& description() const override { return description_; }
  const std::vector<VehicleLink>& links() const override { return links_; }
  void spawn(physics::PhysicsWorld&, const Pose&) override {}
  void connect(Ports&) override {}
  void actuate(std::span<const double>) override {}
  void before_physics(Time, Duration) override {}
  void after_physics(Time, Duration) override {}
  std::string_view crash() const override { return {}; }
  void read_truth(Odometry&) const override {}
  Eigen::Vector3d specific_force_B() const override { return {0, 0, 0}; }
  void read_links(std::vector<Pose>&) const override {}
  void publish(Time) override {}

 private:
  VehicleDescription description_;
  std::vector<VehicleLink> links_;
};

TEST_F(ComposedFrame, AMapIsNotMadeForTheWaysOfWhatHasWings) {
  drive_until(10);
  add_vehicle("plane", std::make_unique<Glider>());
  drive_until(900, "plane");
  EXPECT_LT(compose(top_camera(), 5.0).camera.ortho_height_m, 20.0);
  // Alone it is what the picture is about: 900 m in a picture twice as wide as it is high.
  vehicles_[0] = std::make_unique<Glider>();
  EXPECT_GE(compose(top_camera(), 5.0).camera.ortho_height_m, 450.0);
}

// A wall between the asked place and the vehicle: stills look over it, films stay.
TEST_F(ComposedFrame, AChaseSeeksAClearViewOnlyWhereThatIsAskedFor) {
  drive_until(10);
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, -10, 0}, {0, 10, 0}, {0, 10, 2}, {0, -10, 2}};
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  MeshInstance wall;
  wall.name = "wall";
  wall.mesh = mesh;
  wall.surface = SurfaceClass::kCanopy;
  wall.X_WM.p = {2, 0, 7};
  world_.meshes.push_back(wall);
  scenario::CameraConfig camera;
  camera.kind = scenario::CameraKind::kChase;
  camera.vehicle = "rover";
  camera.distance_m = 6.0;
  camera.height_m = 0.5;
  const auto eye = [&](bool seeks) {
    const FrameComposer composer(scenario_, world_, vehicles_, trace_, {phases_, seeks});
    return Eigen::Vector3d(composer.compose(camera, Time{} + duration_from_s(5)).camera.X_WC.p);
  };
  EXPECT_EQ(eye(false), Eigen::Vector3d(-1, 0, 8.5));
  EXPECT_GT(eye(true).z(), 9.0);
  camera.show_estimate = true;
  EXPECT_EQ(eye(true), Eigen::Vector3d(-1, 0, 8.5)) << "a comparison keeps its place";
}

}  // namespace
}  // namespace vinerow::playback::frame_composer_test
