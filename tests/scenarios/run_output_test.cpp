/// What `vinerow run` leaves when its user or the disk ends it early, and that `vinerow validate`
/// refuses what it would refuse.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/record/log_reader.h"
#include "tests/scenarios/command.h"

namespace vinerow::run_output_test {
namespace {

using test::CommandResult;
using test::read_text;
using test::run_vinerow;
using test::ScratchFolder;
using ::testing::HasSubstr;
using ::testing::Not;

/// A rover on two short alleys: under a second of work, and a log of a megabyte.
const char* const kRover = R"(vinerow: 1
name: small
duration_s: 60
world: {type: vineyard, row_count: 3, row_length_m: 15, relief_m: 1}
vehicles:
  rover:
    type: diff_drive_rover
    spawn: {alley: 0, offset_m: 2}
    planner: {type: coverage, headland_m: 1.5}
    controller: {type: path_follower, rate_Hz: 40, speed_mps: 1.2}
)";

nlohmann::json summary_in(const std::filesystem::path& folder) {
  return nlohmann::json::parse(read_text(folder / "summary.json"));
}

std::vector<std::string> unfinished_files(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".part") names.push_back(entry.path().string());
  }
  return names;
}

TEST(FullDisk, InTheLogEndsTheRunAndKeepsTheVerdict) {
  const ScratchFolder folder("full_log");
  const std::string scenario = folder.file("s.yaml", kRover);
  const std::filesystem::path out = folder.path() / "out";
  // No file above 400 kB (blocks of 512 bytes).
  const CommandResult result =
      run_vinerow("run " + scenario + " --quiet --no-report --out " + out.string() +
                      " --set stop_when_finished=false --set record.truth_rate_Hz=100",
                  "ulimit -f 800;");
  EXPECT_EQ(result.status, 3) << result.output;
  EXPECT_THAT(result.output, HasSubstr("log.mcap: the log cannot be written: the file would "
                                       "exceed the size limit (ulimit -f)"));
  const nlohmann::json summary = summary_in(out);
  EXPECT_EQ(summary["status"], "broken off");
  EXPECT_THAT(summary["error"].get<std::string>(), HasSubstr("the log cannot be written"));
  EXPECT_TRUE(std::filesystem::exists(out / "junit.xml"));
  // The log ends with its last whole chunk.
  const record::LogReader log(out / "log.mcap");
  EXPECT_FALSE(log.info().complete);
  EXPECT_GT(log.info().messages, 100u);
  EXPECT_EQ(log.info().damaged, 0u);
  EXPECT_TRUE(unfinished_files(out).empty());
}

TEST(FullDisk, InTheReportKeepsTheVerdictAndLeavesNoHalfPage) {
  const ScratchFolder folder("full_report");
  const std::string scenario = folder.file("s.yaml", kRover);
  const std::filesystem::path out = folder.path() / "out";
  // The page holds its script and scene; the log of a second is smaller.
  const CommandResult result = run_vinerow(
      "run " + scenario + " --quiet --no-pictures --set duration_s=1 --out " + out.string(),
      "ulimit -f 1400;");
  EXPECT_EQ(result.status, 3) << result.output;
  EXPECT_THAT(result.output, HasSubstr("simulated 1.000 s"));
  EXPECT_THAT(result.output,
              HasSubstr("no report: '" + (out / "report.html").string() + "' cannot be written: "));
  EXPECT_EQ(summary_in(out)["exit_status"], 0);
  EXPECT_FALSE(std::filesystem::exists(out / "report.html"));
  EXPECT_TRUE(unfinished_files(out).empty());
}

TEST(FullDisk, ARealOneIsCalledSo) {
  const ScratchFolder folder("full_disk");
  const std::string scenario = folder.file("s.yaml", kRover);
  const std::filesystem::path disk = folder.path() / "disk", kept = folder.path() / "kept";
  std::filesystem::create_directories(disk);
  std::filesystem::create_directories(kept);
  // A disk of 2 MB in a name space of its own, of which the verdict's reserve takes one.
  const std::string inside =
      "mount -t tmpfs -o size=2m none " + disk.string() + " || exit 77; " +
      std::string(VINEROW_BINARY_DIR) + "/bin/vinerow run " + scenario + " --quiet --out " +
      disk.string() + "/out --set stop_when_finished=false --set record.truth_rate_Hz=200" +
      " --set record.compression=none > " + (kept / "output").string() + " 2>&1; status=$?; cp " +
      disk.string() + "/out/*.json " + disk.string() + "/out/*.xml " + kept.string() + "; ls -a " +
      disk.string() + "/out > " + (kept / "files").string() + "; exit $status";
  const int ended =
      std::system(("unshare --user --map-root-user --mount sh -c '" + inside + "'").c_str());
  const int status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
  if (!std::filesystem::exists(kept / "output")) GTEST_SKIP() << "no disk can be mounted here";
  const std::string output = read_text(kept / "output");
  EXPECT_EQ(status, 3) << output;
  EXPECT_THAT(output, HasSubstr("the log cannot be written: the disk is full"));
  EXPECT_EQ(summary_in(kept)["status"], "broken off");
  EXPECT_THAT(read_text(kept / "junit.xml"), HasSubstr("</testsuites>"));
  EXPECT_THAT(read_text(kept / "files"), Not(HasSubstr(".part")));
}

TEST(CtrlC, WhilePicturesAreDrawnKeepsWhatIsThere) {
  const ScratchFolder folder("ctrl_c");
  const std::string scenario = folder.file("s.yaml", kRover);
  const std::filesystem::path out = folder.path() / "out", output = folder.path() / "output";
  const std::string command = "exec " + std::string(VINEROW_BINARY_DIR) + "/bin/vinerow run " +
                              scenario + " --set pictures.every_s=0.05 --out " + out.string() +
                              " > " + output.string() + " 2>&1";
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  const auto frames = [&] {
    std::error_code none;
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(out / "frames", none)) {
      count += entry.path().extension() == ".png" ? 1 : 0;
    }
    return count;
  };
  int status = 0;
  const auto ended = [&] { return waitpid(child, &status, WNOHANG) == child; };
  bool over = false;
  for (int i = 0; i < 1200 && frames() < 2 && !over; ++i) {
    over = ended();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (over) GTEST_SKIP() << "no pictures here: " << read_text(output);
  // The verdict is known and printed before that.
  EXPECT_EQ(summary_in(out)["status"], "all criteria met");
  EXPECT_THAT(read_text(output), HasSubstr("\ndigest   "));
  kill(child, SIGINT);
  for (int i = 0; i < 600 && !over; ++i) {
    over = ended();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ASSERT_TRUE(over) << "it went on";
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << "the verdict's";
  const std::string printed = read_text(output);
  EXPECT_THAT(printed, HasSubstr("drawing pictures   0 %  0 of ")) << "a pipe gets lines";
  EXPECT_THAT(printed, HasSubstr("interrupted: verdict, log and the pictures so far are kept"));
  const nlohmann::json summary = summary_in(out);
  EXPECT_EQ(summary["pictures"].size(), frames());
  EXPECT_THAT(summary["picture_note"].get<std::string>(), HasSubstr("interrupted after "));
  EXPECT_TRUE(record::LogReader(out / "log.mcap").info().complete);
  EXPECT_FALSE(std::filesystem::exists(out / "report.html"));
  EXPECT_TRUE(unfinished_files(out).empty());
  const CommandResult report = run_vinerow("report " + out.string());
  EXPECT_EQ(report.status, 0) << report.output;
}

TEST(OneFolder, TakesNoSecondRun) {
  const ScratchFolder folder("two_runs");
  const std::string scenario = folder.file("s.yaml", kRover);
  const std::string out = (folder.path() / "out").string();
  const std::string binary = std::string(VINEROW_BINARY_DIR) + "/bin/vinerow";
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    execl(binary.c_str(), "vinerow", "run", scenario.c_str(), "--quiet", "--no-pictures", "--set",
          "duration_s=100000", "--set", "stop_when_finished=false", "--out", out.c_str(),
          static_cast<char*>(nullptr));
    _exit(127);
  }
  for (int i = 0; i < 600 && !std::filesystem::exists(out + "/events.jsonl"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  const CommandResult second = run_vinerow("run " + scenario + " --quiet --out " + out);
  EXPECT_EQ(second.status, 2);
  EXPECT_EQ(second.output, "vinerow: folder '" + out +
                               "' is in use by another run: wait until it ends, or give this one a "
                               "folder of its own (--out)\n");
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 3) << "interrupted while simulating";
  EXPECT_EQ(summary_in(out)["status"], "broken off");
  EXPECT_TRUE(record::LogReader(std::filesystem::path(out) / "log.mcap").info().complete);
}

TEST(Validate, RefusesWhatARunRefuses) {
  const ScratchFolder folder("validate");
  const std::string scenario = folder.file("s.yaml", kRover);
  const std::string out = " --quiet --out " + (folder.path() / "out").string();
  for (const std::string set :
       {"criteria=[{metric: rover.cross_track_rms, max: 1}]", "rover.planner.headland_m=-3",
        "rover.spawn={x_m: 3000, y_m: 0}", "rover.sensors={wheels: {type: gps}}",
        "rover.planner={type: rrt_star, goal: [1.0e5, 1.0e5]}"}) {
    const std::string sets = " --set '" + set + "'";
    const CommandResult run = run_vinerow("run " + scenario + sets + out);
    const CommandResult validated = run_vinerow("validate " + scenario + sets);
    EXPECT_EQ(run.status, 2) << set << run.output;
    EXPECT_EQ(validated.status, 2) << set << validated.output;
    EXPECT_EQ(validated.output, run.output) << set;
  }
  // What shows at the first instant, also of a mission.
  const std::string inside = folder.file(
      "mission.yaml", std::string(kRover) +
                          "    sensors: {cam: {type: camera, rate_Hz: 2, position_m: [0, "
                          "0, 0.05], width_px: 32, height_px: 24}}\n"
                          "phases: {drive: {vehicles: [rover]}}\n");
  const CommandResult blind = run_vinerow("validate " + inside);
  EXPECT_EQ(blind.status, 2) << blind.output;
  EXPECT_THAT(blind.output, HasSubstr("rover.sensors.cam: the camera is inside of rover/body"));
  EXPECT_EQ(run_vinerow("run " + inside + out).output, blind.output);
  const CommandResult good = run_vinerow("validate " + scenario);
  EXPECT_EQ(good.status, 0) << good.output;
  EXPECT_THAT(good.output, HasSubstr("valid (1 vehicle, world 'vineyard', 60 s)"));
}

TEST(MeshFolder, IsMadeIfItIsMissing) {
  const ScratchFolder folder("mesh_folder");
  const std::string scenario = folder.file("s.yaml", kRover);
  const CommandResult made =
      run_vinerow("validate " + scenario + " --set world.mesh_folder=" + folder.path().string() +
                  "/new/meshes");
  EXPECT_EQ(made.status, 0) << made.output;
  EXPECT_FALSE(std::filesystem::is_empty(folder.path() / "new/meshes"));
  const CommandResult taken =
      run_vinerow("validate " + scenario + " --set world.mesh_folder=" + scenario);
  EXPECT_EQ(taken.status, 2);
  EXPECT_THAT(taken.output, HasSubstr("for mesh files cannot be created: Not a directory"));
}

/// The scenario inside a run's folder or log is not one that the user gave.
TEST(RunFolder, WhoseDataMovedNamesItsOwnScenario) {
  const ScratchFolder folder("moved");
  const std::string cube = folder.file(
      "cube.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const std::string scenario =
      folder.file("s.yaml",
                  "vinerow: 1\nname: moved\nduration_s: 0.1\nvehicles: {}\n"
                  "world: {type: mesh, items: [{file: cube.obj}]}\n");
  const std::string out = (folder.path() / "out").string();
  const CommandResult run =
      run_vinerow("run " + scenario + " --quiet --no-report --no-pictures --out " + out);
  ASSERT_EQ(run.status, 0) << run.output;
  std::filesystem::remove(cube);
  const std::string missing = "world.items[0].file = '" + cube + "': no such file";
  for (const auto& [command, place] :
       {std::pair<std::string, std::string>{"report " + out, out + "/scenario.resolved.yaml:"},
        {"render " + out, out + "/log.mcap: scenario.resolved.yaml:"}}) {
    const CommandResult result = run_vinerow(command);
    EXPECT_EQ(result.status, 2) << result.output;
    EXPECT_THAT(result.output, ::testing::StartsWith("vinerow: " + place));
    EXPECT_THAT(result.output, HasSubstr(missing));
  }
}

TEST(StarterScenario, GivesAPictureAndCanBeDrawnAgain) {
  const ScratchFolder folder("starter");
  const std::string scenario = folder.file("s.yaml", kRover);
  const std::string out = (folder.path() / "out").string();
  const CommandResult run = run_vinerow("run " + scenario +
                                        " --quiet --no-report --set "
                                        "duration_s=2.3 --set pictures.width=160 --set "
                                        "pictures.height=90 --out " +
                                        out);
  ASSERT_EQ(run.status, 0) << run.output;
  if (run.output.find("pictures none") != std::string::npos) GTEST_SKIP() << run.output;
  EXPECT_TRUE(std::filesystem::exists(out + "/frames/chase_000002300.png"));
  const CommandResult again =
      run_vinerow("render " + out + "/log.mcap --camera chase --every 1 --width 160 --height 90");
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_TRUE(std::filesystem::exists(out + "/frames/chase_000001000.png"));
  // Half a millisecond apart, in the order of their names.
  const CommandResult close = run_vinerow("render " + out +
                                          "/log.mcap --camera chase --time 1 --time 1.0005 --width "
                                          "160 --height 90 --out " +
                                          out + "/close");
  EXPECT_EQ(close.status, 0) << close.output;
  EXPECT_TRUE(std::filesystem::exists(out + "/close/chase_000001000.000000.png"));
  EXPECT_TRUE(std::filesystem::exists(out + "/close/chase_000001000.500000.png"));
  const CommandResult late = run_vinerow("render " + out + "/log.mcap --time 99999");
  EXPECT_EQ(late.status, 2);
  EXPECT_THAT(late.output, HasSubstr("there is no frame at 99999 s: the log covers 0 s to 2.3 s"));
}

}  // namespace
}  // namespace vinerow::run_output_test
