/// What a report is drawn with: axes, lines, bands, pictures.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <regex>
#include <sstream>

#include "engine/core/error.h"
#include "engine/imaging/jpeg.h"
#include "engine/imaging/png.h"
#include "engine/math/deviation.h"
#include "engine/playback/vehicle_colours.h"
#include "tests/scenarios/command.h"
#include "tools/replay/page_text.h"
#include "tools/replay/simplify_line.h"
#include "tools/report/axis.h"
#include "tools/report/estimate_plots.h"
#include "tools/report/html.h"
#include "tools/report/line_plot.h"
#include "tools/report/mission_map.h"
#include "tools/report/motion_plots.h"
#include "tools/report/page_pictures.h"
#include "tools/report/page_style.h"
#include "tools/report/units.h"

namespace vinerow::tools::report::report_plots_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// Points of the first polyline with a label, in pixels.
std::vector<Eigen::Vector2d> line_points(const std::string& svg) {
  std::smatch found;
  EXPECT_TRUE(
      std::regex_search(svg, found, std::regex("data-label=\"[^\"]*\" points=\"([^\"]*)\"")));
  std::istringstream text(found[1].str());
  std::vector<Eigen::Vector2d> points;
  for (std::string pair; text >> pair;) {
    const std::size_t comma = pair.find(',');
    points.emplace_back(std::stod(pair.substr(0, comma)), std::stod(pair.substr(comma + 1)));
  }
  return points;
}

TEST(ReportAxis, MapsValuesStraightBetweenItsEnds) {
  const Axis axis({2.0, 10.0}, 100.0, 500.0, 5);
  EXPECT_DOUBLE_EQ(axis.px(2.0), 100.0);
  EXPECT_DOUBLE_EQ(axis.px(4.0), 200.0);
  EXPECT_DOUBLE_EQ(axis.px(10.0), 500.0);
  const Axis upwards({-1.0, 1.0}, 300.0, 0.0, 5);
  EXPECT_DOUBLE_EQ(upwards.px(0.5), 75.0);
}

TEST(ReportAxis, TakesRoundTicks) {
  const auto texts = [](double low, double high, int maximum) {
    const Axis axis({low, high}, 0.0, 1.0, maximum);
    std::vector<std::string> out;
    for (const double tick : axis.ticks()) out.push_back(axis.text(tick));
    return out;
  };
  // The step is the smallest of 1, 2 and 5 times a power of ten with no more steps than allowed.
  EXPECT_THAT(texts(0.0, 1.0, 6), ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_THAT(texts(-0.013, 0.014, 6), ElementsAre("−0.010", "−0.005", "0.000", "0.005", "0.010"));
  EXPECT_THAT(texts(0.0, 2600.0, 6), ElementsAre("0", "500", "1000", "1500", "2000", "2500"));
  EXPECT_THAT(texts(0.03, 0.17, 4), ElementsAre("0.05", "0.10", "0.15"));
}

TEST(ReportPlot, DrawsALineWhereItsAxesSay) {
  LinePlot plot;
  plot.title = "ramp";
  plot.y_label = "m";
  plot.lines = {{"ramp", {{0.0, 5.0, 10.0}, {0.0, 1.0, 5.0}}, "s0"}};
  PlotFrame frame;
  frame.width = 600, frame.height = 300, frame.left = 100, frame.right = 0, frame.top = 0;
  frame.bottom = 50;
  // y from -0.25 to 5.25: a twentieth of its span is added on either side.
  const auto y_px = [](double y) { return 250.0 - (y + 0.25) / 5.5 * 250.0; };
  const std::vector<Eigen::Vector2d> points = line_points(draw(plot, frame));
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[0].x(), 100.0, 0.005);
  EXPECT_NEAR(points[1].x(), 350.0, 0.005);
  EXPECT_NEAR(points[2].x(), 600.0, 0.005);
  EXPECT_NEAR(points[0].y(), y_px(0.0), 0.005);
  EXPECT_NEAR(points[1].y(), y_px(1.0), 0.005);
  EXPECT_NEAR(points[2].y(), y_px(5.0), 0.005);
}

TEST(ReportPlot, ShowsLimitsThatAreNearAndLeavesFarOnesOut) {
  LinePlot plot;
  plot.lines = {{"error", {{0.0, 1.0}, {-0.1, 0.1}}, "s0"}};
  plot.limits = {{0.5, "limit"}};
  EXPECT_GT(y_range(plot).high, 0.5);
  EXPECT_THAT(figure(plot), HasSubstr("class=\"limit\""));
  plot.limits = {{50.0, "limit"}};
  EXPECT_LT(y_range(plot).high, 0.2);
  EXPECT_THAT(figure(plot), Not(HasSubstr("limit")));
}

TEST(ReportPlot, BreaksTheLineAtAGapAndDrawsNothingOfNothing) {
  const double nan = std::nan("");
  LinePlot plot;
  plot.lines = {{"a", {{0, 1, 2, 3, 4}, {1, 1, nan, 2, 2}}, "s0"}};
  const std::string svg = draw(plot);
  const std::regex line("<polyline class=\"line s0\"");
  EXPECT_EQ(std::distance(std::sregex_iterator(svg.begin(), svg.end(), line), {}), 2);
  plot.lines = {{"a", {{0, 1}, {nan, nan}}, "s0"}};
  EXPECT_TRUE(plot.empty());
  EXPECT_EQ(figure(plot), "");
}

TEST(ReportDecimate, KeepsEveryExtreme) {
  Samples line;
  for (int i = 0; i < 100'000; ++i) line.add(0.01 * i, std::sin(0.003 * i));
  // Peaks of one sample, which plain thinning would lose.
  const std::vector<std::pair<int, double>> peaks = {{777, 9.0}, {50'001, -7.0}, {99'998, 4.0}};
  for (const auto& [at, value] : peaks) line.y[at] = value;
  const Samples few = decimate(line, 1500);
  EXPECT_LE(few.size(), 1502u);
  EXPECT_GE(few.size(), 1000u);
  EXPECT_TRUE(std::is_sorted(few.x.begin(), few.x.end()));
  EXPECT_EQ(few.x.front(), line.x.front());
  EXPECT_EQ(few.x.back(), line.x.back());
  for (const auto& [at, value] : peaks) {
    const auto found = std::find(few.x.begin(), few.x.end(), line.x[at]);
    ASSERT_NE(found, few.x.end());
    EXPECT_EQ(few.y[found - few.x.begin()], value);
  }
  // Every point of the many lies between the lowest and the highest of the few around it.
  std::size_t k = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    while (k + 1 < few.size() && few.x[k + 1] <= line.x[i]) ++k;
    const std::size_t from = k < 4 ? 0 : k - 4, to = std::min(k + 5, few.size());
    EXPECT_GE(line.y[i], *std::min_element(few.y.begin() + from, few.y.begin() + to));
    EXPECT_LE(line.y[i], *std::max_element(few.y.begin() + from, few.y.begin() + to));
  }
}

TEST(ReportDecimate, KeepsGapsAndShortLines) {
  const double nan = std::nan("");
  const Samples line = {{0, 1, 2, 3, 4, 5}, {nan, 1, nan, nan, 3, 4}};
  const Samples few = decimate(line);
  ASSERT_EQ(few.size(), 4u);
  EXPECT_EQ(few.x[0], 1.0);
  EXPECT_TRUE(std::isnan(few.y[1]));
  EXPECT_EQ(few.y[2], 3.0);
  EXPECT_EQ(few.y[3], 4.0);
  EXPECT_EQ(decimate({{1, 2}, {nan, nan}}).size(), 0u);
}

TEST(ReportMap, SimplifiesALineWithinItsTolerance) {
  std::vector<Eigen::Vector2d> line;
  for (int i = 0; i <= 2000; ++i) {
    const double s = 0.01 * i;
    line.emplace_back(s, std::sin(s) + (i % 2 ? 0.004 : 0.0));
  }
  const auto few = simplify_line(line, 0.01);
  EXPECT_LT(few.size(), 150u);
  EXPECT_EQ(few.front(), line.front());
  EXPECT_EQ(few.back(), line.back());
  const Polyline distance(few);
  for (const Eigen::Vector2d& p : line) EXPECT_LE(distance.nearest(p).distance_m, 0.01 + 1e-12);
  EXPECT_EQ(simplify_line<Eigen::Vector2d>({{0, 0}, {1, 1}, {2, 2}, {5, 5}}, 1e-9).size(), 2u);
}

TEST(ReportPictures, ShrinkByTheMeanAndComeBackAsTheyWere) {
  const test::ScratchFolder folder("report_png");
  imaging::Pixels pixels(4, 2);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) {
      const std::uint8_t value = static_cast<std::uint8_t>(10 * (x + 4 * y));
      std::uint8_t* at = pixels.at(x, y);
      at[0] = value, at[1] = 100, at[2] = static_cast<std::uint8_t>(255 - value), at[3] = 255;
    }
  }
  const imaging::Pixels small = shrunk(pixels, 2);
  ASSERT_EQ(small.width, 2);
  ASSERT_EQ(small.height, 1);
  EXPECT_EQ(small.at(0, 0)[0], (0 + 10 + 40 + 50) / 4);
  EXPECT_EQ(small.at(1, 0)[0], (20 + 30 + 60 + 70) / 4);
  EXPECT_EQ(small.at(1, 0)[1], 100);
  for (const std::uint8_t alpha : {255, 7}) {
    pixels.at(1, 1)[3] = alpha;
    const std::string bytes = imaging::encode_png(pixels);
    EXPECT_EQ(bytes, imaging::encode_png(pixels));
    const auto back = imaging::read_png(folder.file("x.png", bytes));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->rgba, pixels.rgba);
  }
}

/// The picture through a browser's decoder: what it shows at each pixel, or nothing without one.
std::optional<imaging::Pixels> seen_by_browser(const test::ScratchFolder& folder,
                                               const std::string& jpeg, int width, int height) {
  if (std::system("command -v chromium > /dev/null") != 0) return std::nullopt;
  const std::string page = folder.file(
      "jpeg.html",
      "<!DOCTYPE html><style>body{margin:0}img{display:block}</style><img src=\"data:image/"
      "jpeg;base64," +
          base64(jpeg) + "\"/>");
  const std::string shot = (folder.path() / "shot.png").string();
  const std::string command =
      "timeout 200 chromium --headless --no-sandbox --hide-scrollbars --force-color-profile=srgb "
      "--user-data-dir=" +
      (folder.path() / "profile").string() + " --screenshot=" + shot +
      fmt::format(" --window-size={},{} 'file://{}' > /dev/null 2>&1", width, height, page);
  if (std::system(command.c_str()) != 0) return std::nullopt;
  const auto pixels = imaging::read_png(shot);
  return pixels ? std::optional(*pixels) : std::nullopt;
}

/// Leaves and sky: a smooth part, edges, and sides that are no multiples of 16.
imaging::Pixels test_photo() {
  imaging::Pixels pixels(531, 317);
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      std::uint8_t* p = pixels.at(x, y);
      const bool leaf = (x / 13 + y / 9) % 3 == 0 && y > 120;
      p[0] = static_cast<std::uint8_t>(leaf ? 60 : 90 + x / 8);
      p[1] = static_cast<std::uint8_t>(leaf ? 120 : 130 + y / 4);
      p[2] = static_cast<std::uint8_t>(leaf ? 40 : 230 - y / 3);
      p[3] = 255;
    }
  }
  return pixels;
}

TEST(ReportPictures, AreJpegThatABrowserShowsAsTheyWere) {
  const imaging::Pixels pixels = test_photo();
  const std::string fine = imaging::encode_jpeg(pixels, 95),
                    coarse = imaging::encode_jpeg(pixels, 40);
  EXPECT_EQ(fine, imaging::encode_jpeg(pixels, 95));
  EXPECT_LT(coarse.size(), fine.size() / 2);
  // T.81: start of image, end of image; a frame header with the size.
  EXPECT_EQ(fine.substr(0, 4), "\xFF\xD8\xFF\xE0");
  EXPECT_EQ(fine.substr(fine.size() - 2), "\xFF\xD9");
  EXPECT_EQ(imaging::encode_jpeg(imaging::Pixels(1, 1), 90).substr(0, 2), "\xFF\xD8");

  const test::ScratchFolder folder("report_jpeg");
  const auto seen = seen_by_browser(folder, fine, pixels.width, pixels.height);
  if (!seen) GTEST_SKIP() << "no chromium that takes a screenshot on this machine";
  ASSERT_EQ(seen->width, pixels.width);
  ASSERT_EQ(seen->height, pixels.height);
  double sum = 0.0;
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      for (int c = 0; c < 3; ++c) sum += std::abs(pixels.at(x, y)[c] - seen->at(x, y)[c]);
    }
  }
  // Quanta of 95 are 1 to 12; halved colours cost the rest at edges. Wrong tables give tens.
  EXPECT_LT(sum / (3.0 * pixels.width * pixels.height), 4.0);
  // In the smooth sky nothing is lost but rounding.
  for (const auto& [x, y] : {std::pair{20, 30}, {300, 60}, {500, 100}, {530, 5}}) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixels.at(x, y)[c], seen->at(x, y)[c], 6) << x << y;
  }
}

TEST(ReportPlot, ShowsHeadingsBetweenMinusAndPlus180Degrees) {
  // Twice around to the left: the heading goes on to 720 degrees.
  Track track;
  for (int i = 0; i <= 72; ++i) {
    track.t_s.push_back(i);
    track.heading_rad.push_back(2.0 * 2.0 * std::numbers::pi * i / 72.0);
    track.plan_heading_rad.push_back(track.heading_rad.back());
    track.lateral_m.push_back(0.0);
    track.speed_mps.push_back(1.0);
    track.height_error_m.push_back(0.0);
    track.p_W.emplace_back(0, 0, 0);
    track.in_turn.push_back(0);
  }
  VehicleLog vehicle;
  vehicle.name = "rover";
  bool found = false;
  for (const LinePlot& plot : motion_plots(RunFolder{}, vehicle, track)) {
    if (plot.title != "Heading") continue;
    found = true;
    int gaps = 0;
    for (const double y : plot.lines.front().samples.y) {
      gaps += std::isnan(y) ? 1 : 0;
      if (!std::isnan(y)) {
        EXPECT_LE(std::abs(y), 180.0 + 1e-9);
      }
    }
    EXPECT_EQ(gaps, 2);
  }
  EXPECT_TRUE(found);
}

TEST(ReportPlot, CutsABandThatWouldFlattenTheLine) {
  LinePlot plot;
  plot.title = "error";
  plot.lines = {{"error", {{0, 1, 2}, {-0.1, 0.0, 0.1}}, "s0"}};
  plot.bands = {{"2 sigma", {0, 1, 2}, {-9, -9, -9}, {9, 9, 9}, "s0"}};
  // The lines' own span on either side, and the margin of a twentieth.
  EXPECT_NEAR(y_range(plot).high, 0.3 + 0.05 * 0.6, 1e-12);
  plot.bands = {{"2 sigma", {0, 1, 2}, {-0.15, -0.15, -0.15}, {0.15, 0.15, 0.15}, "s0"}};
  EXPECT_NEAR(y_range(plot).high, 0.15 + 0.05 * 0.3, 1e-12);
  LinePlot charge;
  charge.lines = {{"charge", {{0, 1}, {100.0, 90.0}}, "s0"}};
  charge.maximum = 100.0;
  EXPECT_EQ(y_range(charge).high, 100.0);
}

TEST(ReportPlot, PutsABandThatWouldFillThePlotIntoWords) {
  VehicleLog vehicle;
  for (int i = 0; i <= 10; ++i) {
    const Time t = Time{} + duration_from_s(i);
    Odometry truth, fine, coarse;
    fine.X_WB.p = {0.0, 0.02 * (i % 2), 0.0};
    coarse.X_WB.p = {0.0, 0.1 * (i - 5), 0.0};  // at most 0.5 m
    fine.position_variance_m2 = Eigen::Vector3d::Constant(0.02 * 0.02);
    coarse.position_variance_m2 = Eigen::Vector3d::Constant(1.0);
    for (auto* trace : {&vehicle.truth, &vehicle.estimates["fine"], &vehicle.estimates["coarse"]}) {
      trace->times.push_back(t);
      trace->values.push_back(trace == &vehicle.truth               ? truth
                              : trace == &vehicle.estimates["fine"] ? fine
                                                                    : coarse);
    }
  }
  const LinePlot across = estimate_plots(vehicle, nullptr).front();
  ASSERT_EQ(across.bands.size(), 1u);
  EXPECT_EQ(across.bands.front().label, "fine, ±2σ stated");
  EXPECT_THAT(across.caption, HasSubstr("would fill the plot: coarse, ±2σ stated (±2 m)"));
  EXPECT_LT(y_range(across).high, 0.6);
}

TEST(ReportColours, AreThoseOfTheFrames) {
  EXPECT_EQ(playback::hex_colour(playback::vehicle_colour(0).rgb), "#ffb80d");
  EXPECT_EQ(playback::hex_colour(playback::vehicle_colour(8).rgb), "#ffb80d");
  for (std::size_t v = 0; v < playback::kVehicleColours.size(); ++v) {
    EXPECT_THAT(page_style(), HasSubstr(playback::hex_colour(playback::vehicle_colour(v).rgb)));
    EXPECT_THAT(page_style(), HasSubstr(playback::vehicle_colour(v).on_paper));
  }
}

}  // namespace
}  // namespace vinerow::tools::report::report_plots_test
