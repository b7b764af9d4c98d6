/// Where vehicles may start, what the ends of the ground and walls that are part of it do to them,
/// and who gets nowhere.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "engine/core/error.h"
#include "tests/scenarios/session_support.h"
#include "tests/support/paths.h"
#include "vinerow/testing.h"

namespace vinerow::starts_and_edges_test {
namespace {

using test::ScratchFolder;
using ::testing::HasSubstr;
using ::testing::Not;

/// Ground of 40 m x 40 m that rises by 0.1 to the east from z = -12 m in the middle.
std::string hillside() {
  return "v -20 -20 -14\nv 20 -20 -10\nv 20 20 -10\nv -20 20 -14\nf 1 2 3 4\n";
}

/// The same with a wall across it, 1.5 m high, its face at x = 6 m.
std::string hillside_with_wall() {
  return hillside() +
         "v 6 -20 -12\nv 6 20 -12\nv 6 20 -9.9\nv 6 -20 -9.9\nv 6.3 -20 -9.9\nv 6.3 20 -9.9\n"
         "v 6.3 20 -12\nv 6.3 -20 -12\nf 5 8 7 6\nf 8 9 10 7\nf 9 12 11 10\n";
}

std::string scenario(const std::string& world, const std::string& spawn, double to_x_m) {
  return fmt::format(
      "vinerow: 1\nname: s\nduration_s: 120\nworld: {}\nvehicles:\n  rover:\n"
      "    include: {}/assets/vehicles/rover_paper_b.yaml\n    spawn: {}\n"
      "    planner: {{type: waypoints, x_m: [0, {}], y_m: [0, 0]}}\n"
      "    controller: {{type: path_follower, rate_Hz: 20}}\n"
      "metrics: {{deviation: {{type: path_deviation}}}}\n",
      world, VINEROW_SOURCE_DIR, spawn, to_x_m);
}

test::CommandResult run(const ScratchFolder& folder, const std::string& yaml) {
  return test::run_vinerow("run " + folder.file("s.yaml", yaml) +
                           " --quiet --no-log --no-report --out " +
                           (folder.path() / "out").string());
}

std::string events(const ScratchFolder& folder) {
  return test::read_text(folder.path() / "out" / "events.jsonl");
}

NamedValues wheels(double radps) {
  return {{"wheel_fl_speed_radps", "wheel_fr_speed_radps", "wheel_rl_speed_radps",
           "wheel_rr_speed_radps"},
          {radps, radps, radps, radps}};
}

/// Drives straight until the run breaks off, fast: slowly it would come to lie on the edge.
/// @returns why
std::string drive_off(Session session, double radps) {
  session.command("rover/actuators", session.now(), wheels(radps));
  try {
    while (!session.over()) session.advance_for(Duration{500'000'000});
  } catch (const SimulationError& error) {
    return error.what();
  }
  const Eigen::Vector3d p = session.signal<Odometry>("rover/truth").value().X_WB.p;
  return fmt::format("it went on to the end at x = {:.2f} m, y = {:.2f} m", p.x(), p.y());
}

SessionOptions driven() {
  return SessionOptions().take_over<NamedValues>("rover/actuators");
}

TEST(MeshWorldRun, ARoverDrivesBelowZeroAndItsRunEndsWhereTheMeshEnds) {
  const ScratchFolder folder("mesh_edge");
  folder.file("hill.obj", hillside());
  const std::string message = drive_off(
      open_session_text("vinerow: 1\nname: s\nduration_s: 60\n"
                        "world: {type: mesh, items: [{file: hill.obj}]}\n"
                        "vehicles: {rover: {type: diff_drive_rover, spawn: {x_m: 0, y_m: 0}}}\n",
                        folder.path(), {}, driven()),
      20.0);
  EXPECT_THAT(message, HasSubstr("rover (diff_drive_rover)"));
  EXPECT_THAT(message, HasSubstr("it left the terrain at x = 2"));
  EXPECT_THAT(message, HasSubstr("the ground of world 'mesh' extends from x = -20.0 to 20.0 m, "
                                 "y = -20.0 to 20.0 m"));
}

TEST(MeshWorldRun, AWallThatIsPartOfTheTerrainIsTouchedAndHoldsWhoGoesOn) {
  const ScratchFolder folder("mesh_wall");
  folder.file("hill.obj", hillside_with_wall());
  const auto result =
      run(folder, scenario("{type: mesh, items: [{file: hill.obj, surface: terrain}]}",
                           "{x_m: 0, y_m: 0}", 15));
  EXPECT_EQ(result.status, 1) << result.output;
  EXPECT_THAT(events(folder), HasSubstr("touches a wall of the terrain at x = 6.0"));
  EXPECT_THAT(result.output, HasSubstr("rover is stuck at "));
  EXPECT_THAT(result.output, HasSubstr("its wheels were commanded to roll "));
  const std::string summary = test::read_text(folder.path() / "out" / "summary.json");
  EXPECT_THAT(summary, HasSubstr("\"status\": \"a vehicle is stuck\""));
}

TEST(MeshWorldRun, AnObstacleIsTouchedByItsName) {
  const ScratchFolder folder("mesh_obstacle");
  folder.file("hill.obj", hillside());
  folder.file("crate.obj",
              "v 6 -20 -12\nv 6 20 -12\nv 6 20 -9.9\nv 6 -20 -9.9\nv 6.3 -20 -9.9\nv 6.3 20 -9.9\n"
              "v 6.3 20 -12\nv 6.3 -20 -12\nf 1 4 3 2\nf 4 5 6 3\nf 5 8 7 6\n");
  const auto result =
      run(folder, scenario("{type: mesh, items: [{file: hill.obj, surface: terrain}, {file: "
                           "crate.obj, name: crate, surface: obstacle}]}",
                           "{x_m: 0, y_m: 0}", 15));
  EXPECT_EQ(result.status, 1) << result.output;
  EXPECT_THAT(events(folder), HasSubstr("touches obstacle 'crate' at x = 6.0"));
}

TEST(Contacts, ATouchAfterAPauseIsAnotherOne) {
  std::string text = test::kFreeRover;
  text.replace(text.find("duration_s: 3"), 13, "duration_s: 60");
  const std::string crate = ", obstacles: [{name: crate, alley: 0, distance_m: 4}]";
  text.insert(text.find(", relief_m"), crate);
  Session session = open_session_text(text, ".", {}, driven());
  const auto contacts = session.signal<NamedValues>("rover/contacts");
  const auto drive = [&](double radps, std::int64_t time_s) {
    session.command("rover/actuators", session.now(), wheels(radps));
    session.advance_for(Duration{time_s * 1'000'000'000});
    return contacts.value().values;
  };
  using Counted = std::vector<double>;  // how many touches so far; whether it touches now
  EXPECT_EQ(drive(4.0, 15), (Counted{1.0, 1.0})) << "pushes for seconds: one touch";
  EXPECT_EQ(drive(-4.0, 2), (Counted{1.0, 0.0}));
  EXPECT_EQ(drive(4.0, 6), (Counted{2.0, 1.0}));
}

TEST(Edges, LeavingAParcelNamesTheKeyThatMakesItLarger) {
  std::string text = test::kFreeRover;
  text.replace(text.find("duration_s: 3"), 13, "duration_s: 60");
  const std::string message = drive_off(open_session_text(text, ".", {}, driven()), -20.0);
  EXPECT_THAT(message, HasSubstr("it left the terrain at"));
  EXPECT_THAT(message, HasSubstr("; increase world.surroundings_m (6 m now) to extend it"));
}

TEST(Starts, BesideTheGroundNamesTheKeyThatMakesItLarger) {
  const ScratchFolder folder("beside");
  const std::string world = "{type: vineyard, row_count: 3, row_length_m: 20}";
  const auto result = test::run_vinerow(
      "validate " + folder.file("s.yaml", scenario(world, "{x_m: 4000, y_m: 0}", 5)));
  EXPECT_EQ(result.status, 2) << result.output;
  EXPECT_THAT(result.output,
              HasSubstr("s.yaml:8: vehicles.rover.spawn is at x = 4000.000 m, y = 0.000 m, where "
                        "world 'vineyard' has no ground; increase world.surroundings_m ("));
  EXPECT_THAT(result.output, HasSubstr(" m now) to extend it"));
}

TEST(Worlds, AFaultThatIsFoundWhileBuildingHasItsPlaceToo) {
  const ScratchFolder folder("too_fine");
  const std::string world =
      "{type: vineyard, row_count: 900, row_length_m: 5000, terrain_cell_m: 0.5}";
  const auto result =
      test::run_vinerow("validate " + folder.file("s.yaml", scenario(world, "{alley: 0}", 5)));
  EXPECT_EQ(result.status, 2) << result.output;
  EXPECT_THAT(result.output, HasSubstr("s.yaml:4: world.terrain_cell_m = 0.5 m gives "));
}

TEST(Starts, InsideARowOrAVehicleAreRefusedBeforeTheRun) {
  const ScratchFolder folder("starts");
  const std::string world = "{type: vineyard, row_count: 3, row_length_m: 20, row_bearing_deg: 90}";
  const auto validate = [&](const std::string& spawn) {
    return test::run_vinerow("validate " + folder.file("s.yaml", scenario(world, spawn, 5)));
  };
  EXPECT_EQ(validate("{alley: 0, offset_m: 3}").status, 0);
  // The first alley's middle is at y = 37.66 m, a row 1.4 m beside it.
  const auto inside = validate("{x_m: 67.3, y_m: 39.06}");
  EXPECT_EQ(inside.status, 2) << inside.output;
  EXPECT_THAT(inside.output, HasSubstr("s.yaml:8: vehicles.rover.spawn: at x = "));
  EXPECT_THAT(inside.output, HasSubstr("the vehicle would stand in the "));
  EXPECT_THAT(inside.output, HasSubstr("'alley: 0' to 'alley: 1' start in the middle of an alley"));
  const auto two = test::run_vinerow(
      "validate " + folder.file("two.yaml", scenario(world, "{alley: 0, offset_m: 3}", 5) + "") +
      " --set 'vehicles.other={type: diff_drive_rover, spawn: {alley: 0, offset_m: 4}}'");
  EXPECT_EQ(two.status, 2) << two.output;
  EXPECT_THAT(two.output, HasSubstr("vehicles.other.spawn: at x = "));
  EXPECT_THAT(two.output, HasSubstr("the vehicle would stand in vehicle 'rover', which starts at"));
}

TEST(Starts, APartForAnotherKindOfVehicleIsRefusedWithItsPlace) {
  const ScratchFolder folder("kinds");
  std::string yaml =
      scenario("{type: vineyard, row_count: 2, row_length_m: 10}", "{alley: 0, offset_m: 3}", 5);
  yaml.replace(yaml.find("path_follower"), 13, "quadrotor_pid");
  const auto result = test::run_vinerow("validate " + folder.file("s.yaml", yaml));
  EXPECT_EQ(result.status, 2) << result.output;
  EXPECT_THAT(result.output,
              HasSubstr("s.yaml:10: rover.controller (quadrotor_pid) needs a vehicle "
                        "with rotors; vehicle type 'diff_drive_rover' has wheels"));
}

TEST(Verdicts, AMetricWithoutValueSaysWhy) {
  const ScratchFolder folder("not_measured");
  const auto result = run(
      folder,
      scenario("{type: vineyard, row_count: 2, row_length_m: 10}", "{alley: 0, offset_m: 3}", 5) +
          "criteria:\n  - {metric: rover.turn_deviation_rms_m, max: 0.5}\n");
  EXPECT_EQ(result.status, 1) << result.output;
  EXPECT_THAT(result.output,
              HasSubstr("FAILED  rover.turn_deviation_rms_m not measured (at most 0.5): "
                        "it never drove a turn"));
  EXPECT_THAT(result.output, Not(HasSubstr("nan")));
}

TEST(Steps, TooLongForTheWheelsAreRefused) {
  const ScratchFolder folder("steps");
  const auto result = test::run_vinerow(
      "validate " +
      folder.file("s.yaml", scenario("{type: vineyard, row_count: 2, row_length_m: 10}",
                                     "{alley: 0, offset_m: 3}", 5)) +
      " --set physics.step_s=0.025");
  EXPECT_EQ(result.status, 2) << result.output;
  EXPECT_THAT(result.output,
              HasSubstr("rover: physics.step_s = 0.025 s is too long for its wheels, "
                        "which are valid to 0.0025 s"));
}

TEST(Steps, TooLongForRotorsAndWingsAreRefused) {
  const auto said = [](const std::string& name) {
    const auto result =
        test::run_vinerow("validate " + test::scenario_file(name) + " --set physics.step_s=0.0125");
    EXPECT_EQ(result.status, 2) << result.output;
    return result.output;
  };
  const std::string is_too_long = "physics.step_s = 0.0125 s is too long for its ";
  EXPECT_THAT(said("quadrotor_gust"),
              HasSubstr("drone: " + is_too_long + "rotors, which are valid to 0.01 s"));
  EXPECT_THAT(said("trmpc_stress"),
              HasSubstr("plane: " + is_too_long + "wings, which are valid to 0.01 s"));
}

TEST(Density, OfAnotherHeightThanTheGroundsIsTold) {
  // 600 m x 600 m of ground at 1620 m about 45 N 9 E, where UTM zone 32 has its middle.
  const ScratchFolder folder("density");
  std::string dem = "ncols 60\nnrows 60\nxllcorner 499700\nyllcorner 4982650\ncellsize 10\n";
  for (int i = 0; i < 60 * 60; ++i) dem += i % 60 == 59 ? "1620\n" : "1620 ";
  const std::string file = folder.file("high.asc", dem);
  const std::string warning = "the air has the density at the origin's altitude";
  const auto message = [&](const std::string& more) {
    run(folder, scenario("{type: vineyard, row_count: 2, row_length_m: 10, surroundings_m: 90, "
                         "crs: EPSG:32632, origin_latitude_deg: 45, origin_longitude_deg: 9, "
                         "dem_file: " +
                             file + more + "}",
                         "{x_m: 0, y_m: 0}", 5));
    return events(folder);
  };
  EXPECT_THAT(message(", origin_altitude_m: 0"),
              HasSubstr(warning + ", 0 m, but the ground is at z = 1620 m: set wind.atmosphere "
                                  "to us76, or air_density_kgm3, or origin_altitude_m"));
  EXPECT_THAT(message(", origin_altitude_m: 1500"), Not(HasSubstr(warning)));
  EXPECT_THAT(message(", origin_altitude_m: 0, wind: {atmosphere: us76}"), Not(HasSubstr(warning)));
}

}  // namespace
}  // namespace vinerow::starts_and_edges_test
