/// A browser opens the replay: it draws, and complains of nothing. Skipped where there is none.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "engine/api/messages/event.h"
#include "engine/imaging/png.h"
#include "tests/scenarios/command.h"
#include "tools/replay/replay.h"

namespace vinerow::replay_browser_test {
namespace {

using test::ScratchFolder;

std::string output_of(const std::string& command) {
  std::string output;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.append(buffer.data(), count);
  }
  pclose(pipe);
  return output;
}

std::string find_browser() {
  const std::string found =
      output_of("command -v chromium || command -v chromium-browser || command -v google-chrome");
  return found.substr(0, found.find('\n'));
}

/// Without a graphics card, without a network, and with a profile of its own.
std::string browser_call(const std::string& browser, const ScratchFolder& folder,
                         const std::string& options) {
  return "timeout 400 " + browser +
         " --headless=new --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader"
         " --disable-gpu-watchdog"
         " --host-resolver-rules='MAP * ~NOTFOUND' --hide-scrollbars --enable-logging=stderr"
         " --window-size=800,500 --virtual-time-budget=8000 --user-data-dir=" +
         (folder.path() / "profile").string() + " " + options + " 2>&1";
}

/// Lines that a page's scripts or its loading wrote; a driver's remarks on speed are none.
std::string complaints(const std::string& output) {
  std::string lines;
  for (std::size_t at = 0; at < output.size();) {
    const std::size_t end = std::min(output.find('\n', at), output.size());
    const std::string line = output.substr(at, end - at);
    if (line.find("CONSOLE") != std::string::npos &&
        line.find("GL Driver Message") == std::string::npos) {
      lines += line + "\n";
    }
    at = end + 1;
  }
  return lines;
}

/// Does what a user would, and writes what came of it into the page.
constexpr const char* kTrial = R"(<script>
(function () {
  const stage = document.getElementById("vinerow-replay"), results = [];
  const key = (name, more) => stage.dispatchEvent(new KeyboardEvent("keydown", Object.assign({ key: name, bubbles: true }, more)));
  const check = (name, value) => results.push(name + "=" + value);
  const wait = setInterval(() => {
    if (stage.dataset.state !== "ready") return;
    clearInterval(wait);
    const player = VinerowReplay.player;
    check("opened", player.t <= player.scene.firstMove().t && player.scene.firstMove().t <= player.t + 2);
    key("Home"); key("ArrowRight"); check("right", player.t);
    key("ArrowLeft"); key("ArrowLeft"); check("left", player.t);
    key("End"); check("end", player.t === player.index.duration_s);
    key(" "); check("play", player.playing + " " + player.t);
    key(" "); check("pause", player.playing);
    key("+"); check("speed", player.speed);
    stage.querySelector(".vr-vehicles tr").click(); check("follow", player.eye.followed.name);
    key("1", { shiftKey: true }); check("behind", player.eye.behind);
    const before = player.eye.camera.position.clone();
    player.seek(8); player.eye.update(0.1);
    check("moved", player.eye.camera.position.distanceTo(before) > 1);
    key("h"); check("free", player.eye.followed === null);
    const box = stage.querySelector("[data-show=canopy]"); box.click(); player.draw();
    check("canopy", player.scene.canopy.visible);
    const slider = stage.querySelector(".vr-slider"); slider.value = "3"; slider.dispatchEvent(new Event("input"));
    check("slider", player.t);
    const simple = stage.querySelector(".vr-simple"); check("simple", simple.checked + " " + player.quality);
    simple.click(); check("full", player.quality + " " + player.scene.sun.castShadow);
    player.setQuality(0); player.draw();
    stage.dataset.trial = results.join(";");
  }, 100);
})();
</script>
)";

class ReplayBrowser : public ::testing::Test {
 protected:
  ReplayBrowser() : folder_("replay_browser"), browser_(find_browser()) {}

  void SetUp() override {
    if (browser_.empty()) GTEST_SKIP() << "no chromium on this machine";
    if (!tools::has_replay()) GTEST_SKIP() << tools::replay_absence();
  }

  /// The page of a few seconds' flight.
  std::string make_page() {
    const std::string run = (folder_.path() / "run").string(), page = run + "/replay.html";
    const auto ran = test::run_vinerow(
        "run " + test::scenario_file("vineyard_quadrotor_two_rows") +
        " --no-pictures --quiet --set duration_s=12 --set criteria=[] --set world.row_count=4 "
        "--set world.row_length_m=30 --out " +
        run);
    EXPECT_EQ(ran.status, 0) << ran.output;
    const auto result = test::run_vinerow("replay " + run);
    EXPECT_EQ(result.status, 0) << result.output;
    return page;
  }

  const ScratchFolder folder_;
  const std::string browser_;
};

TEST_F(ReplayBrowser, DrawsTheSceneWithoutComplaint) {
  const std::string page = make_page();
  const std::string picture = (folder_.path() / "shot.png").string();
  const std::string output = output_of(
      browser_call(browser_, folder_,
                   "--screenshot=" + picture + " 'file://" + page + "#replay:t=9;follow=drone'"));
  EXPECT_EQ(complaints(output), "");
  const auto pixels = imaging::read_png(picture);
  ASSERT_TRUE(pixels) << output;
  // Between the panels: grass and leaves, not one colour. The vehicle's name lies above the middle.
  std::set<std::uint32_t> colours;
  int count = 0, green = 0;
  for (int y = pixels->height / 4; y < 3 * pixels->height / 4; ++y) {
    for (int x = pixels->width / 4; x < 3 * pixels->width / 4; ++x) {
      const std::uint8_t* p = pixels->at(x, y);
      colours.insert(p[0] << 16 | p[1] << 8 | p[2]);
      ++count;
      green += p[1] > p[2] + 10 && p[1] + 10 > p[0];
    }
  }
  EXPECT_GT(colours.size(), 3000u);
  EXPECT_GT(green, count / 4);
}

TEST_F(ReplayBrowser, ReachesItsLastStateAndShowsTheTimeOfItsAddress) {
  const std::string page = make_page();
  const std::string dom = output_of(
      browser_call(browser_, folder_, "--dump-dom 'file://" + page + "#replay:t=7.3;view=above'"));
  EXPECT_EQ(complaints(dom), "");
  EXPECT_NE(dom.find("data-state=\"ready\""), std::string::npos);
  EXPECT_NE(dom.find(">00:07.3</output>"), std::string::npos);
}

TEST_F(ReplayBrowser, ObeysKeysListsAndSlider) {
  const std::string page = make_page();
  std::string text = test::read_text(page);
  text.insert(text.rfind("</body>"), kTrial);
  const std::string trial = folder_.file("trial.html", text);
  const std::string dom =
      output_of(browser_call(browser_, folder_, "--dump-dom 'file://" + trial + "'"));
  EXPECT_EQ(complaints(dom), "");
  const std::size_t at = dom.find("data-trial=\"");
  ASSERT_NE(at, std::string::npos) << dom.substr(0, 2000);
  EXPECT_EQ(dom.substr(at + 12, dom.find('"', at + 12) - at - 12),
            "opened=true;right=5;left=0;end=true;play=true "
            "0;pause=false;speed=8;follow=drone;behind=true;"
            "moved=true;free=true;canopy=false;slider=3;simple=true 0;full=2 true");
}

TEST_F(ReplayBrowser, SaysSoWhereNothingCanBeDrawn) {
  const std::string page = make_page();
  const std::string dom = output_of(
      browser_call(browser_, folder_, "--disable-3d-apis --dump-dom 'file://" + page + "'"));
  EXPECT_NE(dom.find("data-state=\"failed\""), std::string::npos);
  EXPECT_NE(dom.find("cannot draw 3D graphics"), std::string::npos);
}

}  // namespace
}  // namespace vinerow::replay_browser_test
