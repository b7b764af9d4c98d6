/// Bad input: exit status 2 and one clear sentence. Broken runs: exit status 3, a culprit, and a
/// readable log.

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "engine/api/messages/motion.h"
#include "engine/record/log_reader.h"
#include "tests/scenarios/command.h"
#include "tests/support/paths.h"

namespace vinerow::faults_test {
namespace {

using test::run_vinerow;
using test::scenario_file;
using test::ScratchFolder;

std::string plugin(const std::string& name) {
  return std::string(VINEROW_BINARY_DIR) + "/lib/lib" + name + ".so";
}

/// Status 2, one line, holding each of the texts.
void expect_refused(const std::string& arguments, const std::vector<std::string>& texts) {
  const auto result = run_vinerow(arguments);
  EXPECT_EQ(result.status, 2) << arguments << "\n" << result.output;
  for (const std::string& text : texts) {
    EXPECT_NE(result.output.find(text), std::string::npos)
        << arguments << "\nwanted: " << text << "\n"
        << result.output;
  }
  EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 1) << result.output;
}

std::string run_demo(const std::string& set) {
  return "run " + scenario_file("riseholme_rover") + " --quiet --no-log --out " +
         VINEROW_BINARY_DIR + "/scratch/refused --set '" + set + "'";
}

TEST(BadInput, EachIsAnsweredByOneSentence) {
  expect_refused(run_demo("rover.controller.speed_mps=fast"),
                 {"speed_mps", "must be a number", "fast"});
  expect_refused(run_demo("rover.controller.sped_mps=1"),
                 {"sped_mps", "did you mean 'speed_mps'?"});
  expect_refused(run_demo("rover.controller.speed_mps=.nan"), {"speed_mps", "nan", "finite"});
  expect_refused(run_demo("rover.mass_kg=-5"), {"mass_kg", "-5", "> 0"});
  expect_refused(run_demo("rover.controller.type=path_folower"),
                 {"path_folower", "did you mean 'path_follower'?"});
  expect_refused(run_demo("rover.sensors.gps.rate_Hz=30"), {"0.0333333", "0.001"});
  expect_refused(run_demo("world.survey_file=nowhere.geojson"), {"nowhere.geojson"});
  expect_refused(run_demo("rover.spawn={alley: 12}"), {"alley", "12", "9 alleys (0 to 8)"});
  expect_refused("run " + scenario_file("no_such_file"), {"no_such_file.yaml"});
  expect_refused("run " + scenario_file("orchard_rover") + " --seed -1",
                 {"--seed = '-1', must be a whole number from 0 to 9223372036854775807"});
  expect_refused("validate " + scenario_file("orchard_rover") + " --seed abc",
                 {"--seed = 'abc', must be a whole number"});
  expect_refused("runn", {"unknown command 'runn'; did you mean 'run'? (known: "});
  expect_refused("validate " + scenario_file("vineyard_rover") + " --set world.row_count=1",
                 {"has 1 row and so no alley between two", "{x_m, y_m}"});
  expect_refused("validate " + scenario_file("riseholme_rover") +
                     " --set rover.sensors.sonar_front.position_m=[9.2e18,0,0]",
                 {"position_m[0] = 9.2e+18 m, must be >= -100 m and <= 100 m"});
}

TEST(BadInput, AFollowerWithoutAPlannerIsTold) {
  const ScratchFolder folder("no_planner");
  expect_refused(
      "run " +
          folder.file("s.yaml",
                      "vinerow: 1\nname: s\nduration_s: 1\nworld: {type: vineyard, row_count: 2, "
                      "row_length_m: 10}\nvehicles:\n  rover: {type: diff_drive_rover, spawn: "
                      "{alley: 0}, controller: {type: path_follower}}\n"),
      {"s.yaml:6", "'path_follower' follows a plan, but the vehicle has no planner"});
}

/// The scenario on a small parcel.
std::string run_two_rows(const std::string& set) {
  return "run " + scenario_file("vineyard_4ws_two_rows") +
         " --set world.row_count=3 --set world.row_length_m=20 --quiet --no-log --out " +
         VINEROW_BINARY_DIR + "/scratch/refused --set '" + set + "'";
}

TEST(BadInput, TheFourWheelSteeringScenarioRefusesWhatItCannotDo) {
  expect_refused(run_two_rows("rover.type=diff_drive_rover"),
                 {"rover_paper_a.yaml:", "vehicle 'diff_drive_rover'", "unknown key"});
  expect_refused(
      run_two_rows("rover.planner=null"),
      {"vineyard_4ws_two_rows.yaml:", "'dwa' follows a plan, but the vehicle has no planner"});
  expect_refused(run_two_rows("rover.planner.alleys=[0, 9]"),
                 {"rover.planner (rrt_star): alleys holds 9", "0 to 1"});
  expect_refused(run_two_rows("rover.max_steer_deg=80"),
                 {"rover.max_steer_deg = 80 deg", "<= 45 deg"});
  expect_refused(run_two_rows("rover.sensors.sonar_left.rate_Hz=7"),
                 {"sonar_left.rate_Hz = 7 Hz", "0.142857143 s", "0.001 s"});
  expect_refused(run_two_rows("world.virtual_walls=perhaps"),
                 {"world.virtual_walls = 'perhaps'", "true or false"});
  expect_refused(run_two_rows("rover.on_crash=explode"),
                 {"rover.on_crash = 'explode'", "end, fail"});
}

TEST(BadInput, MapsThatCannotServe) {
  const ScratchFolder folder("maps");
  const auto yaml = [](const std::string& image, const std::string& origin) {
    return "image: " + image + "\nresolution: 0.1\norigin: " + origin +
           "\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n";
  };
  folder.file("map.pgm", "P2\n2 2\n255\n255 255 255 255\n");
  const std::string missing = folder.file("missing.yaml", yaml("nowhere.pgm", "[0, 0, 0]"));
  const std::string turned = folder.file("turned.yaml", yaml("map.pgm", "[0, 0, 0.3]"));
  expect_refused(run_two_rows("world.occupancy_file=" + missing),
                 {"missing.yaml:1", "nowhere.pgm", "does not exist"});
  expect_refused(run_two_rows("world.occupancy_file=" + turned),
                 {"turned.yaml:3", "yaw = 0.3 rad, must be 0"});
}

TEST(BadInput, CyclicIncludesAreNamed) {
  const ScratchFolder folder("cyclic");
  folder.file("a.yaml", "vinerow: 1\ninclude: b.yaml\n");
  folder.file("b.yaml", "include: a.yaml\n");
  expect_refused("validate " + (folder.path() / "a.yaml").string(), {"a.yaml", "b.yaml"});
}

TEST(BadInput, MeshesAndSurveysThatCannotServe) {
  const ScratchFolder folder("meshes");
  const auto with_world = [&](const std::string& world) {
    return "validate " +
           folder.file(
               "s.yaml",
               "vinerow: 1\nname: s\nduration_s: 1\nworld: " + world +
                   "\nvehicles:\n  rover: {type: diff_drive_rover, spawn: {x_m: 0, y_m: 0}}\n");
  };
  folder.file("empty.obj", "");
  folder.file("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  folder.file("points.geojson",
              R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},)"
              R"("geometry":{"type":"Point","coordinates":[7.9,44.6]}}]})");
  expect_refused(with_world("{type: mesh, items: [{file: empty.obj}]}"), {"empty.obj"});
  expect_refused(with_world("{type: mesh, items: [{file: points.obj}]}"), {"points.obj"});
  expect_refused(with_world("{type: surveyed, survey_file: points.geojson}"),
                 {"points.geojson", "LineString"});
}

TEST(BadInput, AWayIntoARowIsRefused) {
  expect_refused(run_demo("rover.planner={type: waypoints, x_m: [0, 12, -12], y_m: [-20, 0, 0]}"),
                 {"path into a row"});
}

TEST(Plugins, WrongOnesAreRefusedByName) {
  expect_refused("list --plugin /nowhere/libx.so", {"/nowhere/libx.so", "does not exist"});
  expect_refused("list --plugin " + plugin("vinerow_test_no_plugin"),
                 {"vinerow_test_no_plugin", "VINEROW_PLUGIN"});
  expect_refused("list --plugin " + plugin("vinerow_test_old_abi"),
                 {"vinerow_test_old_abi", "vinerow-abi-0-cxxabi-1000", "rebuild it"});
}

#if defined(__x86_64__) && !defined(__AVX__)
TEST(Plugins, OneCompiledForWiderVectorsIsRefused) {
  expect_refused("list --plugin " + plugin("vinerow_test_other_alignment"),
                 {"vinerow_test_other_alignment",
                  "was compiled with 32-byte alignment (-mavx or -march=native?), this vinerow uses "
                  "16; rebuild it"});
}
#endif

/// Runs the demo with a misbehaving controller.
void expect_broken_off(const std::string& controller, const std::string& text) {
  const ScratchFolder folder("broken_" + controller);
  const auto result = run_vinerow(
      "run " + scenario_file("riseholme_rover") + " --quiet --no-pictures --plugin " +
      plugin("vinerow_test_faulty_parts") + " --set 'rover.controller={type: " + controller +
      "}' --set criteria=[] --out " + folder.path().string());
  EXPECT_EQ(result.status, 3) << result.output;
  EXPECT_NE(result.output.find("t = 0.500000 s: rover.controller (" + controller + "): " + text),
            std::string::npos)
      << result.output;
  const record::LogReader log(folder.path() / "log.mcap");
  EXPECT_TRUE(log.info().complete);
  EXPECT_NEAR(log.info().last.s(), 0.5, 1e-9);
  EXPECT_NE(test::read_text(folder.path() / "summary.json").find("\"exit_status\": 3"),
            std::string::npos);
  EXPECT_NE(test::read_text(folder.path() / "events.jsonl").find("\"error\""), std::string::npos);
}

TEST(Plugins, AnExceptionEndsTheRunWithItsCulprit) {
  expect_broken_off("throws", "threw an exception: the gearbox is on fire");
}
TEST(Plugins, NanEndsTheRunWithItsCulprit) {
  expect_broken_off("writes_nan", "wrote NaN into signal 'rover/actuators'");
}

TEST(CommandLine, OptionsThatRepeatTakeOneValueEach) {
  const auto result = run_vinerow("validate --files-only --set seed=3 --set duration_s=2 " +
                                  scenario_file("riseholme_rover"));
  EXPECT_EQ(result.status, 0) << result.output;
}

TEST(ExitStatus, AFailedCriterionGivesOne) {
  const ScratchFolder folder("criterion");
  const auto result = run_vinerow("run " + scenario_file("riseholme_rover") +
                                  " --quiet --no-pictures --set duration_s=1 --set " +
                                  "'criteria=[{metric: rover.distance_m, min: 1000}]' --out " +
                                  folder.path().string());
  EXPECT_EQ(result.status, 1) << result.output;
  EXPECT_NE(result.output.find("FAILED  rover.distance_m"), std::string::npos) << result.output;
}

TEST(ExitStatus, ACrashGivesOneAndSaysWhoWhyAndWhen) {
  const ScratchFolder folder("crash");
  const std::string file =
      folder.file("s.yaml",
                  "vinerow: 1\nname: s\nduration_s: 1\nworld: {type: vineyard, row_count: 2, "
                  "row_length_m: 10}\nvehicles:\n  rover: {type: wreck, spawn: {alley: 0}}\n");
  const std::string command = "run " + file + " --quiet --no-pictures --plugin " +
                              plugin("vinerow_test_faulty_parts") + " --out " +
                              folder.path().string();
  const auto ended = run_vinerow(command);
  EXPECT_EQ(ended.status, 1) << ended.output;
  EXPECT_NE(ended.output.find("vinerow: rover crashed at 0.500 s: fell off its trailer\n"),
            std::string::npos)
      << ended.output;
  EXPECT_NE(ended.output.find("simulated 0.500 s"), std::string::npos) << ended.output;
  const std::string summary = test::read_text(folder.path() / "summary.json");
  EXPECT_NE(summary.find("\"text\": \"fell off its trailer\""), std::string::npos) << summary;

  const auto failed = run_vinerow(command + " --set rover.on_crash=fail");
  EXPECT_EQ(failed.status, 1) << failed.output;
  EXPECT_NE(failed.output.find("simulated 1.000 s"), std::string::npos) << failed.output;
}

TEST(NoRenderer, AMachineWithoutTheLibraryStillSimulates) {
  const ScratchFolder folder("no_renderer");
  const auto result = run_vinerow("run " + scenario_file("riseholme_rover") +
                                      " --quiet --set duration_s=1 --set criteria=[] --out " +
                                      folder.path().string(),
                                  "VINEROW_OSMESA=/nowhere/libOSMesa.so");
  EXPECT_EQ(result.status, 0) << result.output;
  EXPECT_NE(result.output.find("pictures none: /nowhere/libOSMesa.so cannot be loaded"),
            std::string::npos)
      << result.output;
}

TEST(KilledRun, LeavesAReadableLogAndCanBeRendered) {
  const ScratchFolder folder("killed");
  const std::string binary = std::string(VINEROW_BINARY_DIR) + "/bin/vinerow";
  const std::string out = folder.path().string();
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    // Long enough that it is still under way when the signal comes.
    execl(binary.c_str(), "vinerow", "run", scenario_file("riseholme_rover").c_str(), "--quiet",
          "--no-pictures", "--set", "duration_s=100000", "--set", "stop_when_finished=false",
          "--out", out.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  // Two flushes of a second each after the log has begun.
  const auto log_file = folder.path() / "log.mcap";
  for (int i = 0; i < 300 && !std::filesystem::exists(log_file); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(3500));
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));

  const record::LogReader log(log_file);
  EXPECT_FALSE(log.info().complete);
  EXPECT_GT(log.info().messages, 100u);
  std::size_t poses = 0;
  log.read<Odometry>("/rover/truth", [&](Time, const Odometry&) { ++poses; });
  EXPECT_GT(poses, 10u);
  const auto info = run_vinerow("info " + log_file.string());
  EXPECT_EQ(info.status, 0) << info.output;
  EXPECT_NE(info.output.find("cut off"), std::string::npos) << info.output;
  const auto render = run_vinerow("render " + log_file.string() +
                                  " --camera chase --time 1 --width 160 --height 90");
  EXPECT_EQ(render.status, 0) << render.output;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "frames" / "chase_000001000.png"));
}

}  // namespace
}  // namespace vinerow::faults_test
