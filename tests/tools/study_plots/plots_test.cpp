/// Where marks and texts of the plots lie, and what the plots make of unusual input.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tests/tools/study_plots/sample_plots.h"
#include "tests/tools/study_plots/svg_reader.h"
#include "tools/report/plot_files.h"
#include "tools/study/plots/band_plot.h"
#include "tools/study/plots/box_plot.h"
#include "tools/study/plots/heat_map.h"
#include "tools/study/plots/interval_plot.h"
#include "tools/study/plots/parallel_plot.h"
#include "tools/study/plots/plot_style.h"

namespace vinerow::study::plots_test {
namespace {

using testing::Document;
using testing::Element;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::overlaps;
using testing::read_xml;
using tools::report::AxisScale;

/// Half of the last digit that a place is written with.
constexpr double kPlace_px = 0.0051;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr const char* kHostile = "\"><script>alert('&1')</script>\x01\x1f\xff\n]]>";

/// A figure that is well formed and whose texts do not overlap.
Document checked(const std::string& figure) {
  const Document document = read_xml(figure);
  EXPECT_EQ(document.fault, "") << figure.substr(0, 2000);
  EXPECT_EQ(overlaps(document), "");
  EXPECT_THAT(figure, Not(HasSubstr("nan")));
  EXPECT_THAT(figure, Not(HasSubstr("\"inf")));
  return document;
}

HeatMap heat_of(std::size_t columns, std::size_t rows, const std::vector<double>& values) {
  HeatMap map;
  map.texts = {"success", ""};
  map.x = {"speed", "m/s"}, map.y = {"noise", "m"}, map.value = {"share", ""};
  for (std::size_t x = 0; x < columns; ++x) map.x_levels.push_back(fmt::format("x{}", x));
  for (std::size_t y = 0; y < rows; ++y) map.y_levels.push_back(fmt::format("y{}", y));
  for (std::size_t i = 0; i < columns * rows; ++i) {
    map.tiles.push_back(
        {values[i % values.size()], kNoValue, kNoValue, "", static_cast<std::int64_t>(i)});
  }
  return map;
}

BandPlot band_of(const std::vector<BandPoint>& points) {
  BandPlot plot;
  plot.texts = {"error", "A caption."};
  plot.x = {"speed", "m/s"}, plot.y = {"error", "m"};
  plot.groups = {{"group", points}};
  return plot;
}

BoxPlot boxes_of(const std::vector<std::vector<double>>& levels) {
  BoxPlot plot;
  plot.texts = {"error", ""};
  plot.x = {"speed", "m/s"}, plot.y = {"error", "m"};
  std::int64_t cell = 0;
  for (const auto& values : levels) {
    BoxLevel level = {fmt::format("level {}", plot.levels.size()), {}};
    for (const double value : values) level.values.push_back({value, cell++, ""});
    plot.levels.push_back(level);
  }
  return plot;
}

ParallelPlot plot_of_lines(const std::vector<std::vector<double>>& lines) {
  ParallelPlot plot;
  plot.texts = {"settings", "A caption."};
  plot.axes = {{{"controller", ""}, {"a", "b", "c"}}, {{"speed", "m/s"}, {}}, {{"error", "m"}, {}}};
  for (const auto& values : lines) {
    plot.lines.push_back({values, static_cast<std::int64_t>(plot.lines.size()), ""});
  }
  return plot;
}

IntervalPlot rows_of(const std::vector<IntervalRow>& rows) {
  IntervalPlot plot;
  plot.texts = {"success", ""};
  plot.value = {"probability", ""};
  plot.rows_title = "setting";
  plot.rows = rows;
  return plot;
}

/// The plot's horizontal axis: the longest level line of class "axis".
Element level_axis(const Document& svg) {
  Element longest;
  double length = 0.0;
  for (const Element& line : svg.with_class("axis")) {
    const double wide = line.number("x2") - line.number("x1");
    if (line.number("y1") == line.number("y2") && wide > length) longest = line, length = wide;
  }
  return longest;
}

TEST(StudyHeatMap, PutsTilesInRowsFromTheLowerLeft) {
  const Document svg = checked(heat_map(heat_of(3, 2, {0.0, 0.2, 0.4, 0.6, 0.8, 1.0})));
  const std::vector<Element> tiles = svg.with_cell();
  ASSERT_EQ(tiles.size(), 6u);
  const auto at = [&](std::size_t i, const char* side) { return tiles[i].number(side); };
  // Neighbours are a gap of 1.5 px apart; 36 px is the height of a tile with it.
  for (const std::size_t i : {1u, 2u, 4u, 5u}) {
    EXPECT_NEAR(at(i, "x"), at(i - 1, "x") + at(i - 1, "width") + 1.5, 2.0 * kPlace_px);
    EXPECT_EQ(at(i, "y"), at(i - 1, "y"));
  }
  EXPECT_NEAR(at(0, "y") - at(3, "y"), 36.0, 2.0 * kPlace_px);
  EXPECT_EQ(at(0, "x"), at(3, "x"));
  EXPECT_EQ(tiles[0].attributes.at("fill"), "#440154");
  EXPECT_EQ(tiles[5].attributes.at("fill"), "#fde725");
  std::vector<std::string> values;
  for (const Element& text : svg.with_class("value")) values.push_back(text.text);
  EXPECT_THAT(values, ElementsAre("0.00", "0.20", "0.40", "0.60", "0.80", "1.00"));
  EXPECT_TRUE(svg.with_class("value")[0].is("on-dark"));
  EXPECT_TRUE(svg.with_class("value")[5].is("on-light"));
}

TEST(StudyHeatMap, TellsLevelsValueAndIntervalOfATile) {
  HeatMap map = heat_of(2, 1, {0.25, 0.75});
  map.tiles[1].low = 0.6, map.tiles[1].high = 0.9, map.tiles[1].note = "20 runs";
  const Document svg = checked(heat_map(map));
  EXPECT_EQ(svg.named("title")[1].text,
            "speed: x1\nnoise: y0\nshare: 0.75 (0.6 to 0.9)\n20 runs\ncell 1");
}

TEST(StudyHeatMap, HatchesWhatHasNoValueAndSaysWhy) {
  HeatMap map = heat_of(2, 2, {0.25, 0.5});
  map.tiles[3] = {kNoValue, kNoValue, kNoValue, "no run was made", kNoCell};
  const std::string figure = heat_map(map);
  const Document svg = checked(figure);
  EXPECT_EQ(svg.with_class("hatch").size(), 1u);
  EXPECT_EQ(svg.with_cell().size(), 3u);
  EXPECT_THAT(figure, HasSubstr("share: not measured\nno run was made"));
  EXPECT_THAT(figure, HasSubstr("class=\"key area missing\""));
  EXPECT_THAT(heat_map(heat_of(2, 2, {0.25, 0.5})), Not(HasSubstr("missing")));
}

TEST(StudyHeatMap, TakesAnyNumberOfLevels) {
  EXPECT_EQ(heat_map(heat_of(0, 2, {1.0})), "");
  EXPECT_EQ(heat_map(heat_of(2, 0, {1.0})), "");
  checked(heat_map(heat_of(1, 1, {0.3})));
  checked(heat_map(heat_of(1, 12, {0.3, 0.4})));
  checked(heat_map(heat_of(30, 30, {0.3, 0.4})));
  const Document wide = checked(heat_map(heat_of(1000, 2, {0.1, 0.2, 0.3})));
  EXPECT_EQ(wide.with_cell().size(), 2000u);
  EXPECT_TRUE(wide.with_class("value").empty());
  checked(heat_map(heat_of(2, 1000, {0.1, 0.2, 0.3})));
  EXPECT_THAT(heat_map(heat_of(200, 200, {0.1})), HasSubstr("40000 tiles are too many to draw"));
}

TEST(StudyHeatMap, TakesAnyValues) {
  for (const auto& values : std::vector<std::vector<double>>{{5.0},
                                                             {0.0},
                                                             {kNoValue},
                                                             {-1e300, 1e300},
                                                             {-3.5, -1e-12},
                                                             {kInfinite, 1.0, -kInfinite},
                                                             {1e-308, 2e-308},
                                                             {123456789.0, 123456790.0}}) {
    const Document svg = checked(heat_map(heat_of(3, 2, values)));
    EXPECT_EQ(svg.with_cell().size(), 6u) << values[0];
  }
}

TEST(StudyBandPlot, DrawsMarksWhereItsAxesSay) {
  const Document svg = checked(band_plot(band_of(
      {{4.0, 10.0, 8.0, 10.0, "", 7}, {0.0, 0.0, 0.0, 2.0, "", 5}, {1.0, 5.0, 5.0, 6.0, "", 6}})));
  const Element axis = level_axis(svg);
  const double left = axis.number("x1"), right = axis.number("x2");
  EXPECT_EQ(right, 620.0);
  // A twentieth of the span is added on either side; y from 290 up to 12.
  const auto x_px = [&](double x) { return left + (x + 0.2) / 4.4 * (right - left); };
  const auto y_px = [](double y) { return 290.0 - (y + 0.5) / 11.0 * 278.0; };
  const std::vector<Element> dots = svg.with_class("dot");
  ASSERT_EQ(dots.size(), 3u);
  const std::vector<std::pair<double, double>> expected = {{0.0, 0.0}, {1.0, 5.0}, {4.0, 10.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(dots[i].number("cx"), x_px(expected[i].first), kPlace_px);
    EXPECT_NEAR(dots[i].number("cy"), y_px(expected[i].second), kPlace_px);
    EXPECT_EQ(svg.with_cell()[i].attributes.at("data-cell"), fmt::format("{}", 5 + i));
  }
  EXPECT_EQ(svg.with_class("band").size(), 1u);
  EXPECT_EQ(svg.named("polyline").size(), 1u);
}

TEST(StudyBandPlot, DrawsALogarithmicAxis) {
  BandPlot plot = band_of({{1.0, 1.0, kNoValue, kNoValue, "", 0},
                           {10.0, 2.0, kNoValue, kNoValue, "", 1},
                           {100.0, 3.0, kNoValue, kNoValue, "", 2},
                           {0.0, 4.0, kNoValue, kNoValue, "", 3},
                           {-1.0, 5.0, kNoValue, kNoValue, "", 4}});
  plot.x_scale = AxisScale::kLogarithmic;
  const std::vector<Element> dots = checked(band_plot(plot)).with_class("dot");
  ASSERT_EQ(dots.size(), 3u);
  const double x0 = dots[0].number("cx"), x1 = dots[1].number("cx"), x2 = dots[2].number("cx");
  EXPECT_NEAR(x1 - x0, x2 - x1, 3.0 * kPlace_px);
}

TEST(StudyBandPlot, DrawsWhiskersBesideEachOther) {
  BandPlot plot = band_of({{1.0, 1.0, 0.5, 1.5, "", 0}, {2.0, 2.0, 1.0, kInfinite, "", 1}});
  plot.groups.push_back({"other", plot.groups[0].points});
  plot.spread = Spread::kWhiskers;
  plot.spread_label = "95 % interval";
  const std::string figure = band_plot(plot);
  const Document svg = checked(figure);
  EXPECT_EQ(svg.with_class("whisker").size(), 12u);
  // The second group's marks are squares, 5 px to the right of the first one's circles.
  const std::vector<Element> dots = svg.with_class("dot");
  ASSERT_EQ(dots.size(), 4u);
  EXPECT_NEAR(dots[2].number("x") + 0.5 * dots[2].number("width") - dots[0].number("cx"), 5.0,
              3.0 * kPlace_px);
  EXPECT_THAT(figure, HasSubstr("● group"));
  EXPECT_THAT(figure, HasSubstr("■ other"));
  EXPECT_THAT(figure, HasSubstr("whiskers: 95 % interval"));
}

TEST(StudyBandPlot, BreaksTheLineAtAGapAndTakesAnyValues) {
  EXPECT_EQ(band_plot(band_of({})), "");
  EXPECT_EQ(band_plot(band_of({{1.0, kNoValue, 0.0, 1.0, "", 0}})), "");
  EXPECT_EQ(band_plot({}), "");
  const Document gap = checked(band_plot(band_of({{1.0, 1.0, 0.0, 2.0, "", 0},
                                                  {2.0, 1.0, 0.0, 2.0, "", 1},
                                                  {3.0, kNoValue, 0.0, 2.0, "", 2},
                                                  {4.0, 1.0, 0.0, 2.0, "", 3},
                                                  {5.0, 1.0, 0.0, 2.0, "", 4}})));
  EXPECT_EQ(gap.named("polyline").size(), 2u);
  EXPECT_EQ(gap.with_cell().size(), 4u);
  checked(band_plot(band_of({{1.0, 1.0, kNoValue, kNoValue, "", 0}})));
  checked(
      band_plot(band_of({{-1e300, 1e300, -1e300, 1e300, "", 0}, {1e300, -5.0, 0.0, 0.0, "", 1}})));
  std::vector<BandPoint> many;
  for (int i = 0; i < 1000; ++i) many.push_back({1e-9 * i, 1e12 + i, 1e12, 1e12 + 1e3, "", i});
  EXPECT_EQ(checked(band_plot(band_of(many))).with_cell().size(), 1000u);
}

TEST(StudyBoxPlot, DrawsBoxesAndDotsWhereItsAxisSays) {
  const std::string figure = box_plot(boxes_of({{0.0, 1.0, 2.0, 3.0, 4.0, 20.0}}));
  const Document svg = checked(figure);
  // The range is -1 to 21, from y = 312 up to 12. Quartiles 1.25, 2.5, 3.75; the reach ends at 7.5.
  const auto y_px = [](double y) { return 312.0 - (y + 1.0) / 22.0 * 300.0; };
  const Element box = svg.with_class("box").back();
  EXPECT_NEAR(box.number("y"), y_px(3.75), kPlace_px);
  EXPECT_NEAR(box.number("y") + box.number("height"), y_px(1.25), 2.0 * kPlace_px);
  EXPECT_NEAR(svg.with_class("median")[0].number("y1"), y_px(2.5), kPlace_px);
  EXPECT_NEAR(svg.with_class("whisker")[0].number("y2"), y_px(4.0), kPlace_px);
  EXPECT_NEAR(svg.with_class("whisker")[1].number("y2"), y_px(0.0), kPlace_px);
  const double middle = box.number("x") + 0.5 * box.number("width");
  ASSERT_EQ(svg.with_class("speck").size(), 5u);
  ASSERT_EQ(svg.with_class("ring").size(), 1u);
  EXPECT_NEAR(svg.with_class("ring")[0].number("cy"), y_px(20.0), kPlace_px);
  EXPECT_EQ(svg.with_class("ring")[0].attributes.at("data-cell"), "5");
  for (const Element& dot : svg.with_class("speck")) {
    EXPECT_NEAR(dot.number("cx"), middle, 2.0 * kPlace_px);
  }
}

TEST(StudyBoxPlot, PutsEqualValuesSideBySide) {
  const Document svg = checked(box_plot(boxes_of({std::vector<double>(9, 2.0), {1.0, 3.0}})));
  const std::vector<Element> dots = svg.with_class("speck");
  ASSERT_EQ(dots.size(), 11u);
  std::map<std::string, int> places;
  for (std::size_t i = 0; i < 9; ++i) ++places[dots[i].attributes.at("cx")];
  EXPECT_EQ(places.size(), 9u);
}

TEST(StudyBoxPlot, ShowsOutliersAloneWhereThereAreManyValues) {
  std::vector<double> many;
  for (int i = 0; i < 60; ++i) many.push_back(0.01 * i);
  many.push_back(100.0);
  const Document svg = checked(box_plot(boxes_of({many})));
  EXPECT_TRUE(svg.with_class("speck").empty());
  EXPECT_EQ(svg.with_class("ring").size(), 1u);
}

TEST(StudyBoxPlot, TakesAnyLevelsAndValues) {
  EXPECT_EQ(box_plot(boxes_of({})), "");
  EXPECT_EQ(box_plot(boxes_of({{}, {kNoValue}})), "");
  const std::string figure = box_plot(boxes_of({{1.0, 2.0, kNoValue}, {}, {kNoValue}}));
  checked(figure);
  EXPECT_THAT(figure, HasSubstr("2 values, 1 not measured"));
  checked(box_plot(boxes_of({{7.0, 7.0, 7.0}})));
  checked(box_plot(boxes_of({{-1e300, 1e300, 0.0, kInfinite}})));
  checked(box_plot(boxes_of(std::vector<std::vector<double>>(1000, {1.0, 2.0, 3.0}))));
}

TEST(StudyParallelPlot, DrawsALineThroughEveryAxis) {
  const std::string figure =
      parallel_plot(plot_of_lines({{0.0, 1.0, 5.0}, {2.0, 3.0, 10.0}, {1.0, 2.0, 0.0}}));
  const Document svg = checked(figure);
  const std::vector<Element> paths = svg.with_class("way");
  ASSERT_EQ(paths.size(), 3u);
  // Axes from y = 392 up to 62; the first line: the lowest level, the least speed, half of the
  // error.
  EXPECT_THAT(paths[0].attributes.at("d"), HasSubstr(" 392L"));
  EXPECT_TRUE(paths[0].attributes.at("d").ends_with(" 227"));
  EXPECT_EQ(paths[1].attributes.at("stroke"), "#fde725");
  EXPECT_EQ(paths[2].attributes.at("stroke"), "#440154");
  EXPECT_TRUE(paths[1].attributes.at("d").ends_with(" 62"));
  EXPECT_THAT(figure, HasSubstr("controller: c\nspeed: 3 m/s\nerror: 10 m\ncell 1"));
}

TEST(StudyParallelPlot, LeavesGapsAndDrawsNoMoreLinesThanAllowed) {
  const Document svg =
      checked(parallel_plot(plot_of_lines({{0.0, kNoValue, 1.0}, {1.0, 2.0, kNoValue}})));
  const std::string path = svg.with_class("way")[0].attributes.at("d");
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2);
  EXPECT_EQ(std::count(path.begin(), path.end(), 'L'), 0);
  EXPECT_TRUE(svg.with_class("way")[1].is("uncoloured"));
  ParallelPlot many = plot_of_lines(std::vector<std::vector<double>>(100, {0.0, 1.0, 2.0}));
  many.max_lines = 10;
  const std::string figure = parallel_plot(many);
  const std::vector<Element> few = checked(figure).with_cell();
  ASSERT_EQ(few.size(), 10u);
  EXPECT_EQ(few[9].attributes.at("data-cell"), "90");
  EXPECT_THAT(figure, HasSubstr("A caption. Of 100 lines 10 evenly chosen ones are drawn."));
}

TEST(StudyParallelPlot, TakesAnyAxesAndValues) {
  EXPECT_EQ(parallel_plot({}), "");
  EXPECT_EQ(parallel_plot(plot_of_lines({})), "");
  checked(parallel_plot(plot_of_lines({{0.0, 1e300, kNoValue}, {0.0, -1e300, kInfinite}})));
  ParallelPlot plot;
  plot.texts = {"many axes", ""};
  for (int i = 0; i < 12; ++i) {
    plot.axes.push_back({{"a rather long name of a metric", "m/s²"},
                         i % 3 == 0 ? std::vector<std::string>(1000, "a level with a long name")
                                    : std::vector<std::string>()});
  }
  plot.axes.push_back({{"one level", ""}, {"only"}});
  plot.lines = {{std::vector<double>(13, 0.0), 1, ""}};
  checked(parallel_plot(plot));
}

TEST(StudyIntervalPlot, PutsDotsAndIntervalsInRows) {
  IntervalPlot plot = rows_of({{"a", 0.5, 0.25, 1.0, "", 3}, {"b", 1.0, 0.5, 1.0, "", 4}});
  plot.value.minimum = 0.0, plot.value.maximum = 1.0;
  plot.reference = {0.0, "none"};
  const Document svg = checked(interval_plot(plot));
  const Element axis = level_axis(svg);
  const double left = axis.number("x1"), length = axis.number("x2") - left;
  const std::vector<Element> dots = svg.with_class("dot");
  ASSERT_EQ(dots.size(), 2u);
  EXPECT_NEAR(dots[0].number("cx"), left + 0.5 * length, 2.0 * kPlace_px);
  EXPECT_NEAR(dots[1].number("cx"), left + length, 2.0 * kPlace_px);
  // Rows of 24 px from y = 26 on.
  EXPECT_NEAR(dots[0].number("cy"), 38.0, kPlace_px);
  EXPECT_NEAR(dots[1].number("cy"), 62.0, kPlace_px);
  const Element whisker = svg.with_class("whisker")[0];
  EXPECT_NEAR(whisker.number("x1"), left + 0.25 * length, 2.0 * kPlace_px);
  EXPECT_NEAR(whisker.number("x2"), left + length, 2.0 * kPlace_px);
  EXPECT_NEAR(svg.named("line").front().number("y1"), 74.0, kPlace_px);
  EXPECT_EQ(svg.with_cell().size(), 2u);
}

TEST(StudyIntervalPlot, MarksIntervalsThatContainTheReference) {
  IntervalPlot plot = rows_of({{"a", 0.5, -0.1, 1.0, "", 3}, {"b", 1.0, 0.5, 1.5, "", 4}});
  plot.reference = {0.0, "no effect"};
  const std::string figure = interval_plot(plot);
  const Document svg = checked(figure);
  EXPECT_EQ(svg.with_class("ring").size(), 1u);
  EXPECT_EQ(svg.with_class("dot").size(), 1u);
  EXPECT_THAT(figure, HasSubstr("no effect"));
  EXPECT_THAT(figure, HasSubstr("0.50 (−0.10 to 1.00)"));
}

TEST(StudyIntervalPlot, TakesAnyRows) {
  EXPECT_EQ(interval_plot(rows_of({})), "");
  EXPECT_THAT(interval_plot(rows_of({{"a", kNoValue, 0.0, 1.0, "no run", 1}})),
              HasSubstr("not measured"));
  checked(interval_plot(rows_of({{"a", kNoValue, 0.0, 1.0, "no run", 1}})));
  checked(interval_plot(rows_of({{"a", 3.0, -kInfinite, kInfinite, "", 1}})));
  checked(
      interval_plot(rows_of({{"a", -1e300, -1e300, 1e300, "", 1}, {"b", 2.0, 2.0, 2.0, "", 2}})));
  std::vector<IntervalRow> many;
  for (int i = 0; i < 1000; ++i) {
    many.push_back(
        {"a setting with a long name, longer than any row has room for it " + std::to_string(i),
         1e9 * i, 1e9 * i - 1e8, 1e9 * i + 1e8, "", i});
  }
  EXPECT_EQ(checked(interval_plot(rows_of(many))).with_cell().size(), 1000u);
}

/// Plots of every kind in which each text is the given one.
std::vector<std::string> plots_of_text(const std::string& text) {
  const Quantity quantity = {text, text};
  HeatMap heat = heat_of(4, 4, {0.1, 0.9, kNoValue});
  heat.texts = {text, text};
  heat.x = heat.y = heat.value = quantity;
  heat.x_levels = heat.y_levels = std::vector<std::string>(4, text);
  for (HeatTile& tile : heat.tiles) tile.note = text;
  BandPlot band = band_of({{1.0, 1.0, 0.5, 2.0, text, 1}, {2.0, 1.0, 0.5, 2.0, text, 2}});
  band.texts = {text, text};
  band.x = band.y = quantity;
  band.spread_label = band.groups[0].label = text;
  BoxPlot boxes = boxes_of({{1.0, 2.0, 3.0}, {2.0, 9.0}, {1.0}});
  boxes.texts = {text, text};
  boxes.x = boxes.y = quantity;
  for (BoxLevel& level : boxes.levels) level.label = level.values[0].note = text;
  ParallelPlot paths = plot_of_lines({{0.0, 1.0, 2.0}, {1.0, 5.0, 3.0}});
  paths.texts = {text, text};
  for (ParallelAxis& axis : paths.axes) axis.quantity = quantity;
  paths.axes[0].levels = paths.axes[2].levels = std::vector<std::string>(4, text);
  paths.lines[0].note = text;
  IntervalPlot rows = rows_of({{text, 0.5, 0.1, 0.9, text, 1}, {text, 0.5, 0.1, 0.9, text, 2}});
  rows.texts = {text, text};
  rows.value = quantity;
  rows.rows_title = rows.spread_label = text;
  rows.reference = {0.5, text};
  return {heat_map(heat), band_plot(band), box_plot(boxes), parallel_plot(paths),
          interval_plot(rows)};
}

TEST(StudyPlots, EscapeEveryText) {
  for (const std::string& figure : plots_of_text(kHostile)) {
    const Document document = checked(figure);
    EXPECT_TRUE(document.named("script").empty());
  }
}

TEST(StudyPlots, TakeTextsOfAnyLength) {
  for (const std::string text :
       {"", " ", "W", "a long text of many words that goes on and on and never comes to an end",
        "WWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWWW",
        "葡萄園葡萄園葡萄園葡萄園葡萄園葡萄園葡萄園葡萄園葡萄園葡萄園葡萄園葡萄園葡萄園葡萄園"}) {
    for (const std::string& figure : plots_of_text(text)) checked(figure);
  }
}

TEST(StudyPlots, AreTheSameEveryTime) {
  EXPECT_EQ(testing::sample_page(), testing::sample_page());
}

TEST(StudyPlots, BecomeFilesOfTheirOwn) {
  const auto files = tools::plot_files_of(testing::sample_page(), study_plot_style());
  ASSERT_EQ(files.size(), 13u);
  EXPECT_EQ(files[0].name, "success_over_speed_and_noise.svg");
  for (const auto& file : files) {
    EXPECT_EQ(read_xml(file.svg).fault, "") << file.name;
    // Other programs than browsers know neither variables nor sizes of a page.
    EXPECT_THAT(file.svg, Not(HasSubstr("var(")));
    EXPECT_THAT(file.svg, Not(HasSubstr("min-width")));
  }
  EXPECT_THAT(files[0].svg, HasSubstr("svg.study text.on-dark { fill: #ffffff; }"));
  EXPECT_THAT(files[1].svg, HasSubstr("svg.study .whisker.s0 { stroke: #1f6fb4;"));
}

}  // namespace
}  // namespace vinerow::study::plots_test
