/// What the plots of a study are made of: logarithmic axes, numbers, texts that fit, boxes,
/// colours.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tools/report/axis.h"
#include "tools/report/html.h"
#include "tools/study/plots/box_numbers.h"
#include "tools/study/plots/click_script.h"
#include "tools/study/plots/colour_bar.h"
#include "tools/study/plots/level_labels.h"
#include "tools/study/plots/plot_style.h"
#include "tools/study/plots/quantity.h"
#include "tools/study/plots/text_fit.h"

namespace vinerow::study::plot_parts_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using tools::report::Axis;
using tools::report::AxisScale;
using tools::report::Range;

std::vector<std::string> texts_of(const Axis& axis) {
  std::vector<std::string> out;
  for (const double tick : axis.ticks()) out.push_back(axis.short_text(tick));
  return out;
}

TEST(StudyLogarithmicAxis, MapsEqualRatiosToEqualLengths) {
  const Axis axis({1.0, 1000.0}, 100.0, 400.0, 10, AxisScale::kLogarithmic);
  EXPECT_NEAR(axis.px(1.0), 100.0, 1e-9);
  EXPECT_NEAR(axis.px(10.0), 200.0, 1e-9);
  EXPECT_NEAR(axis.px(1000.0), 400.0, 1e-9);
  EXPECT_NEAR(axis.px(std::sqrt(10.0)), 150.0, 1e-9);
}

TEST(StudyLogarithmicAxis, TakesAsManyTicksAsAreAllowed) {
  const auto texts = [](double low, double high, int max_ticks) {
    return texts_of(Axis({low, high}, 0.0, 1.0, max_ticks, AxisScale::kLogarithmic));
  };
  EXPECT_THAT(texts(0.01, 1.0, 10), ElementsAre("0.01", "0.02", "0.05", "0.1", "0.2", "0.5", "1"));
  EXPECT_THAT(texts(0.01, 1.0, 5), ElementsAre("0.01", "0.1", "1"));
  EXPECT_THAT(texts(1.0, 1e6, 4), ElementsAre("1", "100", "10000", "1000000"));
  EXPECT_THAT(texts(1e-6, 1.0, 4), ElementsAre("10⁻⁶", "10⁻⁴", "10⁻²", "10⁰"));
  // Less than a factor of five: ticks of equal steps.
  EXPECT_THAT(texts(2.0, 4.0, 5), ElementsAre("2.0", "2.5", "3.0", "3.5", "4.0"));
  const auto wide = texts(1e-300, 1e300, 6);
  EXPECT_LE(wide.size(), 6u);
  EXPECT_GE(wide.size(), 2u);
}

TEST(StudyAxisTexts, AreShortWhereNumbersAreLong) {
  EXPECT_THAT(texts_of(Axis({0.0, 2e7}, 0.0, 1.0, 4)),
              ElementsAre("0", "5·10⁶", "1.0·10⁷", "1.5·10⁷", "2.0·10⁷"));
  EXPECT_THAT(texts_of(Axis({-2e-6, 2e-6}, 0.0, 1.0, 4)),
              ElementsAre("−2·10⁻⁶", "−10⁻⁶", "0", "10⁻⁶", "2·10⁻⁶"));
  EXPECT_THAT(texts_of(Axis({0.0, 1.0}, 0.0, 1.0, 2)), ElementsAre("0.0", "0.5", "1.0"));
}

TEST(StudyRanges, GiveEqualValuesRoomAndKeepToWhatIsPossible) {
  const Range equal = axis_range({5.0, 5.0}, {"", ""});
  EXPECT_LT(equal.low, 5.0);
  EXPECT_GT(equal.high, 5.0);
  EXPECT_GT(axis_range({0.0, 0.0}, {"", ""}).span(), 0.0);
  EXPECT_GT(axis_range({-1e300, -1e300}, {"", ""}).span(), 0.0);
  EXPECT_TRUE(std::isfinite(axis_range({-1e300, 1e300}, {"", ""}).span()));
  // Of 0 to 1, a twentieth on either side; not below 0 for a probability.
  const Range free = axis_range({0.0, 1.0}, {"", ""});
  EXPECT_DOUBLE_EQ(free.low, -0.05);
  EXPECT_DOUBLE_EQ(free.high, 1.05);
  const Range bounded = axis_range({0.0, 1.0}, {"", "", 0.0, 1.0});
  EXPECT_EQ(bounded.low, 0.0);
  EXPECT_EQ(bounded.high, 1.0);
  // A bound that the values break counts for nothing.
  EXPECT_LT(axis_range({-0.2, 1.0}, {"", "", 0.0, 1.0}).low, -0.2);
}

TEST(StudyNumbers, TellIntervalsAndUnits) {
  const double nan = kNoValue, infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(interval_text(0.83, 0.71, 0.91, {"speed", "m/s"}), "0.83 (0.71 to 0.91) m/s");
  EXPECT_EQ(interval_text(0.83, nan, nan, {"speed", "m/s"}), "0.83 m/s");
  EXPECT_EQ(interval_text(nan, 0.0, 1.0, {"speed", "m/s"}), "not measured");
  EXPECT_EQ(interval_text(1.0, -infinite, infinite, {"", "°"}), "1 (−∞ to ∞)°");
  // Hundredths of a range from 0 to 1, tenths of one from 0 to 12.
  EXPECT_EQ(even_text(0.5, {0.0, 1.0}), "0.50");
  EXPECT_EQ(even_text(-3.0, {-4.0, 8.0}), "−3.0");
  EXPECT_EQ(even_text(2.5e8, {0.0, 1e9}), "2.5·10⁸");
  EXPECT_EQ((Quantity{"speed", "m/s"}.title()), "speed, m/s");
  EXPECT_EQ((Quantity{"share", ""}.title()), "share");
}

TEST(StudyTexts, AreShortenedToTheirRoom) {
  EXPECT_EQ(shortened("abc", 100.0, 10.0), "abc");
  const std::string cut = shortened("a rather long text of many words", 100.0, 10.0);
  EXPECT_TRUE(cut.ends_with("…"));
  EXPECT_LE(widest_px(cut, 10.0), 100.0);
  EXPECT_EQ(shortened("abc", 3.0, 10.0), "");
  // Letters of several bytes stay whole.
  EXPECT_EQ(tools::escaped(shortened("äöüäöüäöü", 40.0, 10.0)), shortened("äöüäöüäöü", 40.0, 10.0));
}

TEST(StudyTexts, BreakBetweenWords) {
  EXPECT_THAT(wrapped("one two three", 45.0, 10.0, 3), ElementsAre("one two", "three"));
  EXPECT_THAT(wrapped("one two three", 45.0, 10.0, 1), ElementsAre(HasSubstr("one t")));
  EXPECT_TRUE(wrapped("", 45.0, 10.0, 2).empty());
  for (const std::string& line :
       wrapped(std::string(80, 'W') + " " + std::string(80, 'i'), 60.0, 10.0, 2)) {
    EXPECT_LE(widest_px(line, 10.0), 60.0);
  }
}

TEST(StudyLevelLabels, StandLevelThenSlantedThenFewer) {
  EXPECT_FALSE(fit_level_labels({"one", "two"}, 60.0, 100.0).slanted);
  const LevelLabels slanted =
      fit_level_labels({"a controller with a name", "another one"}, 60.0, 100.0);
  EXPECT_TRUE(slanted.slanted);
  EXPECT_NE(slanted.texts[1], "");
  const LevelLabels few = fit_level_labels(std::vector<std::string>(30, "12.5"), 10.0, 100.0);
  EXPECT_FALSE(few.slanted);
  // A text takes 36 px with its gap: every fifth of 10 px each.
  EXPECT_NE(few.texts[5], "");
  EXPECT_EQ(few.texts[1], "");
  EXPECT_EQ(label_stride(10.0, 45.0), 5u);
  EXPECT_EQ(label_stride(0.1, 45.0), 500u);
}

TEST(StudyBoxNumbers, AreThoseOfTukey) {
  // numpy.quantile of these: 3.25, 5.5, 7.75; the reach ends at 14.5.
  const auto box = calc_box_numbers({20, 1, 2, 3, 9, 4, 8, 5, 7, 6});
  ASSERT_TRUE(box);
  EXPECT_DOUBLE_EQ(box->lower_quartile, 3.25);
  EXPECT_DOUBLE_EQ(box->median, 5.5);
  EXPECT_DOUBLE_EQ(box->upper_quartile, 7.75);
  EXPECT_DOUBLE_EQ(box->low_whisker, 1.0);
  EXPECT_DOUBLE_EQ(box->high_whisker, 9.0);
  EXPECT_TRUE(box->is_outlier(20.0));
  EXPECT_FALSE(box->is_outlier(9.0));
}

TEST(StudyBoxNumbers, PassOverWhatCannotBeDrawn) {
  EXPECT_FALSE(calc_box_numbers({}));
  EXPECT_FALSE(calc_box_numbers({kNoValue, std::numeric_limits<double>::infinity()}));
  const auto one = calc_box_numbers({kNoValue, 3.0});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->low_whisker, 3.0);
  EXPECT_EQ(one->median, 3.0);
  EXPECT_EQ(one->high_whisker, 3.0);
}

TEST(StudyColours, RunFromVioletToYellowWithTextsThatCanBeRead) {
  EXPECT_EQ(colour_of(2.0, {2.0, 4.0}), "#440154");
  EXPECT_EQ(colour_of(4.0, {2.0, 4.0}), "#fde725");
  EXPECT_EQ(colour_of(9.0, {2.0, 4.0}), "#fde725");
  EXPECT_TRUE(is_dark(2.0, {2.0, 4.0}));
  EXPECT_FALSE(is_dark(4.0, {2.0, 4.0}));
}

TEST(StudyScript, IsWellFormedInsideAPage) {
  EXPECT_THAT(click_script(), Not(HasSubstr("<")));
  EXPECT_THAT(click_script(), Not(HasSubstr("&")));
  EXPECT_THAT(study_plot_style(), Not(HasSubstr("<")));
  EXPECT_THAT(study_plot_style(), Not(HasSubstr("&")));
}

TEST(StudyEscape, ReplacesBytesThatAreNoText) {
  EXPECT_EQ(tools::escaped("a\xff"
                           "b"),
            "a\uFFFDb");
  EXPECT_EQ(tools::escaped("a\uFFFE\uFFFF"
                           "b"),
            "ab");
  EXPECT_EQ(tools::escaped("grün \x01<"), "grün &lt;");
}

}  // namespace
}  // namespace vinerow::study::plot_parts_test
