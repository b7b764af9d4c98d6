#include "tools/study/plots/box_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/html.h"
#include "tools/study/plots/box_numbers.h"
#include "tools/study/plots/level_labels.h"

namespace vinerow::study {
namespace {

using tools::report::Axis;
using tools::report::Range;
using tools::report::Svg;

constexpr double kBoxPlot_px = 300.0, kBoxTop_px = 12.0, kBoxRight_px = 20.0;
constexpr double kSpeck_px = 3.4;  ///< radius

struct BoxLayout {
  double left = 0.0, pitch = 0.0, width = 0.0, height = 0.0;
  double half_box = 0.0;
  LevelLabels labels;

  double centre(std::size_t level) const {
    return left + (static_cast<double>(level) + 0.5) * pitch;
  }
};

BoxLayout lay_out_boxes(const BoxPlot& plot, const Axis& y) {
  constexpr double kWanted_px = 44.0, kMin_px = 8.0, kWidestBox_px = 84.0;
  const auto count = static_cast<double>(plot.levels.size());
  BoxLayout at;
  at.left = upright_axis_px(y);
  const double around = at.left + kBoxRight_px;
  const bool half = count * kWanted_px <= kHalfWidth_px - around;
  at.pitch = std::max(((half ? kHalfWidth_px : kFullWidth_px) - around) / count, kMin_px);
  at.width = around + count * at.pitch;
  at.half_box = 0.5 * std::min(0.62 * at.pitch, kWidestBox_px);
  std::vector<std::string> names;
  for (const BoxLevel& level : plot.levels) names.push_back(level.label);
  at.labels = fit_level_labels(names, at.pitch, at.left + 0.5 * at.pitch);
  at.height = kBoxTop_px + kBoxPlot_px + at.labels.height_px + 30.0;
  return at;
}

std::string box_tip(const BoxPlot& plot, const BoxLevel& level, const BoxNumbers& box,
                    std::size_t count) {
  const auto line = [&](const char* name, double value) {
    return fmt::format("{}: {}", name, value_text(value, plot.y));
  };
  const std::size_t none = level.values.size() - count;
  return tip_text(
      {plot.x.label + ": " + level.label,
       tools::report::counted(static_cast<long>(count), "value") +
           (none == 0 ? "" : fmt::format(", {} not measured", none)),
       line("upper whisker", box.high_whisker), line("upper quartile", box.upper_quartile),
       line("median", box.median), line("lower quartile", box.lower_quartile),
       line("lower whisker", box.low_whisker)},
      kNoCell);
}

void draw_box(const BoxNumbers& box, const std::string& tip, double x, double half_width,
              const Axis& y, Svg& svg) {
  const double top = y.px(box.upper_quartile), bottom = y.px(box.lower_quartile);
  const double cap = 0.5 * half_width;
  svg.line(x, top, x, y.px(box.high_whisker), "whisker s0");
  svg.line(x, bottom, x, y.px(box.low_whisker), "whisker s0");
  for (const double end : {box.high_whisker, box.low_whisker}) {
    svg.line(x - cap, y.px(end), x + cap, y.px(end), "whisker s0");
  }
  svg.rect(x - half_width, top, 2.0 * half_width, bottom - top, "box s0", tip);
  svg.line(x - half_width, y.px(box.median), x + half_width, y.px(box.median), "median s0");
}

/// Offsets at which dots do not cover each other, as near to the middle as possible. In a full row
/// they overlap. @param heights_px  ascending @returns offsets from the middle, px
std::vector<double> side_by_side(const std::vector<double>& heights_px, double max_px) {
  constexpr double kStep_px = 2.0 * kSpeck_px + 0.4;
  std::vector<double> offsets;
  for (std::size_t i = 0; i < heights_px.size(); ++i) {
    double chosen = 0.0;
    for (int k = 0; k < 1000; ++k) {
      // 0, 1, -1, 2, -2, ... steps from the middle.
      const double offset = (k % 2 == 0 ? -1.0 : 1.0) * ((k + 1) / 2) * kStep_px;
      if (std::abs(offset) > max_px) break;
      bool free = true;
      for (std::size_t j = i; free && j-- > 0;) {
        const double apart = heights_px[i] - heights_px[j];
        if (apart >= kStep_px) break;
        free = std::hypot(offset - offsets[j], apart) >= kStep_px - 1e-9;
      }
      if (!free) continue;
      chosen = offset;
      break;
    }
    offsets.push_back(chosen);
  }
  return offsets;
}

void draw_dots(const BoxPlot& plot, const BoxLevel& level, const BoxNumbers& box, double x,
               double half_width, const Axis& y, Svg& svg) {
  const bool all = level.values.size() <= kMaxDots;
  std::vector<const BoxValue*> shown;
  for (const BoxValue& value : level.values) {
    if (can_draw(value.value) && (all || box.is_outlier(value.value))) shown.push_back(&value);
  }
  std::stable_sort(shown.begin(), shown.end(),
                   [](const auto* a, const auto* b) { return a->value > b->value; });
  std::vector<double> heights_px;
  for (const BoxValue* value : shown) heights_px.push_back(y.px(value->value));
  const std::vector<double> offsets =
      side_by_side(heights_px, std::max(0.0, half_width - kSpeck_px));
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const bool outlier = box.is_outlier(shown[i]->value);
    svg.circle(x + offsets[i], heights_px[i], kSpeck_px, outlier ? "ring s1" : "speck s0",
               tip_text({plot.x.label + ": " + level.label,
                         plot.y.label + ": " + value_text(shown[i]->value, plot.y),
                         outlier ? "outlier" : "", shown[i]->note},
                        shown[i]->cell),
               cell_attribute(shown[i]->cell));
  }
}

std::string box_legend(bool with_dots, bool with_outliers) {
  std::string keys = legend_words("box: quartiles, median") +
                     legend_words("whiskers: up to 1.5 interquartile ranges");
  if (with_dots) keys += legend_words("●: single values");
  if (with_outliers) keys += legend_words("○: outliers");
  return keys;
}

}  // namespace

std::string box_plot(const BoxPlot& plot) {
  Range values;
  for (const BoxLevel& level : plot.levels) {
    for (const BoxValue& value : level.values) {
      if (can_draw(value.value)) values.include(value.value);
    }
  }
  if (values.empty()) return "";
  const Axis y(axis_range(values, plot.y), kBoxTop_px + kBoxPlot_px, kBoxTop_px,
               ticks_for(kBoxPlot_px, false));
  const BoxLayout at = lay_out_boxes(plot, y);
  Svg svg = study_svg(at.width, at.height, plot.texts.title);
  const double right = at.width - kBoxRight_px, bottom = y.from_px();
  draw_upright_axis(y, at.left, right, plot.y.title(), svg);
  svg.line(at.left, bottom, right, bottom, "axis");
  draw_level_labels(at.labels, at.centre(0), at.pitch, bottom, svg);
  draw_title_below(at.left, right, at.height - 9.0, plot.x.title(), svg);
  bool with_dots = false, with_outliers = false;
  for (std::size_t i = 0; i < plot.levels.size(); ++i) {
    const BoxLevel& level = plot.levels[i];
    std::vector<double> numbers;
    for (const BoxValue& value : level.values) {
      if (can_draw(value.value)) numbers.push_back(value.value);
    }
    const auto box = calc_box_numbers(numbers);
    if (!box) continue;
    draw_box(*box, box_tip(plot, level, *box, numbers.size()), at.centre(i), at.half_box, y, svg);
    draw_dots(plot, level, *box, at.centre(i), at.half_box, y, svg);
    with_dots = with_dots || level.values.size() <= kMaxDots;
    for (const double value : numbers) with_outliers = with_outliers || box->is_outlier(value);
  }
  return study_figure(plot.texts, box_legend(with_dots, with_outliers), svg.finish(), at.width);
}

}  // namespace vinerow::study
