/// Cameras in whole runs: they see the vehicles, and the log has what viewers expect.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/api/messages/camera.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/surface.h"
#include "engine/sim/vehicle_runtime.h"
#include "tests/scenarios/session_support.h"
#include "tests/support/paths.h"
#include "tools/parts/register_all.h"

namespace vinerow::camera_run_test {
namespace {

using test::run_vinerow;
using test::ScratchFolder;

/// Two rovers one behind the other, 4 m apart, on level ground; the last has a sensor `eye`.
std::string two_rovers_with(const std::string& eye) {
  return R"(
vinerow: 1
name: two_rovers
duration_s: 0.6
world: {type: vineyard, row_count: 2, row_length_m: 20, relief_m: 0, waves_m: 0, leaf_cards_per_m: 10, plant_variants: 1}
vehicles:
  watcher:
    type: diff_drive_rover
    spawn: {alley: 0, offset_m: 9}
    sensors: {eye: {rate_Hz: 5, )" +
         eye + R"(}}
  other:
    type: diff_drive_rover
    spawn: {alley: 0, offset_m: 5}
)";
}

std::string two_rovers(const std::string& camera) {
  return two_rovers_with("type: camera, width_px: 160, height_px: 120, horizontal_fov_deg: 60, " +
                         camera);
}

/// How far a sensor at x_m on the last rover is behind the nearest corner of the other one, which
/// is straight ahead.
double calc_gap_m(const Session& session, double x_m) {
  const Vehicle& other = session.simulation().vehicles()[1]->vehicle();
  const Pose X_WB = session.simulation().vehicles()[0]->truth().X_WB;
  std::vector<Pose> X_WL(other.links().size());
  other.read_links(X_WL);
  double gap_m = 1e9;
  for (std::size_t i = 0; i < X_WL.size(); ++i) {
    for (const Eigen::Vector3f& corner : other.links()[i].mesh->vertices) {
      const Eigen::Vector3d p_B = X_WB.inverse() * (X_WL[i] * corner.cast<double>());
      gap_m = std::min(gap_m, p_B.x() - x_m);
    }
  }
  return gap_m;
}

const char* const kLabelled =
    "position_m: [0.6, 0, 0.5], semantic: true, instance: true, depth: true";

TEST(CameraRun, SeesTheOtherVehicleWhereItIs) {
  auto registry = std::make_shared<Registry>();
  register_all(*registry);
  Session session(scenario::parse_scenario(two_rovers(kLabelled), ".", *registry), registry);
  session.advance(Time{500'000'000});
  const auto picture = [&](const char* name) {
    return static_cast<const Signal<Picture>&>(*session.simulation().bus().find(name)).value();
  };
  const Picture semantic = picture("watcher/eye_semantic");
  const Picture instance = picture("watcher/eye_instance"), depth = picture("watcher/eye_depth");
  int seen = 0, first = 160, last = 0;
  std::map<std::uint32_t, int> numbers;
  std::uint32_t nearest_mm = 100'000;
  for (int i = 0; i < 160 * 120; ++i) {
    if (semantic.data[i] != static_cast<std::uint8_t>(Label::kVehicle)) continue;
    ++seen;
    first = std::min(first, i % 160);
    last = std::max(last, i % 160);
    ++numbers[instance.data[3 * i] + 256u * instance.data[3 * i + 1] +
              65536u * instance.data[3 * i + 2]];
    nearest_mm = std::min(nearest_mm, depth.data[2 * i] + 256u * depth.data[2 * i + 1]);
  }
  EXPECT_GT(seen, 100);
  // One vehicle, in the middle of the picture.
  EXPECT_EQ(numbers.size(), 1u);
  EXPECT_NEAR(0.5 * (first + last), 79.5, 4.0);
  EXPECT_NEAR(nearest_mm / 1000.0, calc_gap_m(session, 0.6), 0.02);
}

TEST(CameraRun, AScannerSeesTheOtherVehicleToo) {
  auto registry = std::make_shared<Registry>();
  register_all(*registry);
  // Beams every half degree, 2 cm apart where the other rover is.
  std::string elevations_deg = "-20";
  for (double e = -19.5; e <= 4.0; e += 0.5) elevations_deg += ", " + std::to_string(e);
  const std::string scanner =
      "type: lidar_3d, position_m: [0.6, 0, 0.5], noise_std_m: 0, elevations_deg: [" +
      elevations_deg + "]";
  Session session(scenario::parse_scenario(two_rovers_with(scanner), ".", *registry), registry);
  session.advance(Time{500'000'000});
  const auto& cloud =
      static_cast<const Signal<PointCloud>&>(*session.simulation().bus().find("watcher/eye"))
          .value();
  const Pose X_WB = session.simulation().vehicles()[0]->truth().X_WB;
  double nearest_m = 1e9;
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    // Ahead, between the rows and above the ground, which is level.
    const Eigen::Vector3d p_B(cloud.x[i] + 0.6, cloud.y[i], cloud.z[i] + 0.5);
    if (cloud.x[i] < 0.5F || std::abs(cloud.y[i]) > 0.6F || (X_WB * p_B).z() < 0.04) continue;
    nearest_m = std::min(nearest_m, double{1} * cloud.x[i]);
  }
  EXPECT_NEAR(nearest_m, calc_gap_m(session, 0.6), 0.03);
}

TEST(CameraRun, RefusesCamerasAndScannersInsideOfTheirVehicle) {
  const ScratchFolder folder("camera_inside");
  const std::filesystem::path out = folder.path() / "out";
  std::string file;
  for (const auto& [scenario, refusal] :
       {std::pair(two_rovers_with("type: lidar_3d"), "the scanner is inside of watcher/"),
        std::pair(two_rovers("position_m: [0, 0, 0.02]"), "the camera is inside of watcher/")}) {
    file = folder.file("scenario.yaml", scenario);
    for (const std::string& command :
         {"run " + file + " --out " + out.string(), "validate " + file}) {
      const test::CommandResult result = run_vinerow(command);
      EXPECT_EQ(result.status, 2) << command;
      EXPECT_NE(
          result.output.find(std::string("scenario.yaml:10: watcher.sensors.eye: ") + refusal),
          std::string::npos)
          << result.output;
      EXPECT_FALSE(std::filesystem::exists(out)) << "before its first step a run writes nothing";
    }
  }
  // What an earlier run has written in the folder stays as it was.
  std::filesystem::create_directories(out / "frames");
  const std::string names[] = {"scenario.resolved.yaml", "summary.json", "log.mcap",
                               "frames/chase_000000500.png", "notes.txt"};
  for (const std::string& name : names) folder.file("out/" + name, "earlier " + name);
  EXPECT_EQ(run_vinerow("run " + file + " --out " + out.string()).status, 2);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out)) {
    files += entry.is_regular_file();
  }
  EXPECT_EQ(files, std::size(names));
  for (const std::string& name : names) EXPECT_EQ(test::read_text(out / name), "earlier " + name);
}

/// `vinerow validate` of a vehicle of the assets with a camera. @param camera  its further keys
test::CommandResult validate_camera(const ScratchFolder& folder, const std::string& vehicle,
                                    const std::string& asset, const std::string& camera) {
  return run_vinerow("validate " + folder.file("scenario.yaml", R"(
vinerow: 1
duration_s: 0.1
world: {type: vineyard, row_count: 2, row_length_m: 10, relief_m: 0, leaf_cards_per_m: 10, plant_variants: 1}
vehicles:
  )" + vehicle + ":\n    include: " + VINEROW_SOURCE_DIR + "/assets/vehicles/" +
                                                                    asset + R"(
    spawn: {alley: 0, offset_m: 6}
    sensors:
      eye: {type: camera, width_px: 16, height_px: 16, picture: depth, )" +
                                                                    camera + "}\n"));
}

/// Around and above the fixed wing, looking at it, and in its fuselage.
TEST(CameraRun, IsInsideOfTheFixedWingInItsFuselageAlone) {
  const ScratchFolder folder("camera_plane");
  const auto validate = [&](const std::string& camera) {
    return validate_camera(folder, "plane", "mh900_like.yaml", camera);
  };
  for (const char* place : {"position_m: [-1.5, 0, 0.8], rotation_deg: [0, 28, 0]",
                            "position_m: [0, 0.3, 0.6], rotation_deg: [0, 90, 0]",
                            "position_m: [0, -0.3, 0.6], rotation_deg: [0, 90, 0]",
                            "position_m: [0.2, 1.2, 0.1], rotation_deg: [0, 0, -90]",
                            "position_m: [0.9, -0.6, 0.4], rotation_deg: [0, 20, 150]"}) {
    EXPECT_EQ(validate(place).status, 0) << place;
  }
  const test::CommandResult inside = validate("position_m: [0, 0, 0]");
  EXPECT_EQ(inside.status, 2);
  EXPECT_NE(inside.output.find("the camera is inside of plane/body"), std::string::npos)
      << inside.output;
}

/// A body that is open below, so that not all rays leave it: in it, and just ahead of it,
/// looking back at nothing else.
TEST(CameraRun, IsInsideOfARoverWhereverItLooks) {
  const ScratchFolder folder("camera_rover");
  const auto validate = [&](const std::string& camera) {
    return validate_camera(folder, "rover", "rover_paper_b.yaml", camera);
  };
  for (const char* position : {"[0, 0, 0.2]", "[-0.5, 0, 0.2]", "[0.2, -0.2, 0.2]"}) {
    for (const char* yaw_deg : {"-30", "0", "90", "180"}) {
      const std::string place = std::string("position_m: ") + position +
                                ", rotation_deg: [0, -5, " + yaw_deg + "], horizontal_fov_deg: 70";
      const test::CommandResult inside = validate(place);
      EXPECT_EQ(inside.status, 2) << place;
      EXPECT_NE(inside.output.find("the camera is inside of rover/body"), std::string::npos)
          << place << inside.output;
    }
  }
  EXPECT_EQ(
      validate("position_m: [0.8, 0, 0.15], rotation_deg: [0, 0, 180], horizontal_fov_deg: 20")
          .status,
      0);
}

}  // namespace
}  // namespace vinerow::camera_run_test
