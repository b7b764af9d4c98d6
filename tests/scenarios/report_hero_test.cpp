/// Which picture a report begins with.

#include <gtest/gtest.h>

#include "engine/api/map.h"
#include "engine/api/world_model.h"
#include "engine/playback/frame_words.h"
#include "engine/render/scene.h"
#include "tests/scenarios/command.h"
#include "tools/report/page_pictures.h"

namespace vinerow::report_hero_test {
namespace {

namespace fs = std::filesystem;
using tools::report::Picture;
using tools::report::RunFolder;
using tools::report::VehicleLog;

/// A rover drives 1 m/s along a row from x = 0 at 0 s to x = 20 at 20 s and stands from then on; a
/// drone stands. Cameras behind both, and one from above.
class Hero : public ::testing::Test {
 protected:
  Hero() : folder_("report_hero") {
    run_.scenario.emplace();
    add_camera("rover", scenario::CameraKind::kChase, "rover");
    add_camera("drone", scenario::CameraKind::kChase, "drone");
    add_camera("above", scenario::CameraKind::kTop, "");
    const auto world = std::make_shared<WorldModel>();
    PlantRow row;
    row.line_W = {{0, 1, 0}, {20, 1, 0}};
    world->rows->rows.push_back(row);
    run_.world = world;
    for (const char* name : {"rover", "drone"}) {
      VehicleLog& vehicle = vehicles_.emplace_back();
      vehicle.name = name;
      for (int k = 0; k <= 40; ++k) {
        Odometry truth;
        const bool drives = vehicle.name == "rover" && k <= 20;
        truth.X_WB.p = {std::min(1.0 * k, 20.0), 0, 0};
        truth.v_WB_B = {drives ? 1.0 : 0.0, 0, 0};
        vehicle.truth.times.push_back(Time{} + duration_from_s(k));
        vehicle.truth.values.push_back(truth);
      }
    }
  }
  void add_camera(const char* name, scenario::CameraKind kind, const char* vehicle) {
    scenario::CameraConfig camera;
    camera.name = name;
    camera.kind = kind;
    camera.vehicle = vehicle;
    run_.scenario->pictures.cameras.push_back(camera);
  }
  void add_frame(const std::string& name, const std::map<std::string, double>& seen) {
    const render::Image image{2, 1, {1, 2, 3, 4, 5, 6}};
    const fs::path file = folder_.path() / (name + ".png");
    std::map<std::string, std::string> words;
    if (!seen.empty()) words[playback::kSeenKey] = playback::seen_text(seen);
    render::write_png(file.string(), image, words);
    Picture& picture = frames_.emplace_back();
    picture.file = file;
    picture.caption = name;
  }
  std::string hero() const {
    const Picture* picture = hero_picture(run_, vehicles_, frames_);
    return picture == nullptr ? "none" : picture->caption;
  }

  test::ScratchFolder folder_;
  RunFolder run_;
  std::vector<VehicleLog> vehicles_;
  std::vector<Picture> frames_;
};

TEST_F(Hero, ShowsMostOfWhatMoves) {
  EXPECT_EQ(hero(), "none");
  add_frame("rover_000005000", {{"rover", 0.010}, {"drone", 0.0}});
  add_frame("rover_000010000", {{"rover", 0.030}, {"drone", 0.0}});
  add_frame("rover_000012000", {{"rover", 0.020}, {"drone", 0.5}});
  EXPECT_EQ(hero(), "rover_000010000") << "the drone that fills the third one stands";
}

TEST_F(Hero, IsOfWorkAndNotOfAStandHoweverLarge) {
  add_frame("rover_000005000", {{"rover", 0.001}});
  add_frame("rover_000030000", {{"rover", 0.9}});
  add_frame("drone_000005000", {{"rover", 0.15}, {"drone", 0.2}});
  add_frame("above_000005000", {{"rover", 0.15}});
  EXPECT_EQ(hero(), "rover_000005000");
}

TEST_F(Hero, IsTheMiddleOfThoseThatDoNotTellWhatTheyShow) {
  for (const char* name : {"rover_000005000", "rover_000010000", "rover_000015000"}) {
    add_frame(name, {});
  }
  EXPECT_EQ(hero(), "rover_000010000");
}

}  // namespace
}  // namespace vinerow::report_hero_test
