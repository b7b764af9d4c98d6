#include "tools/study/plots/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/html.h"
#include "tools/study/plots/text_fit.h"

namespace vinerow::study {
namespace {

using tools::escaped;
using tools::report::Axis;
using tools::report::Svg;

/// Tick labels of 12.5 px are drawn with at least 9 px and at most 15 px.
constexpr double kMinScale = 9.0 / kTick_px;
constexpr double kMaxScale = 15.0 / kTick_px;
constexpr double kTitleSpace_px = 26.0;
/// Minimum space to the right of an axis.
constexpr double kRightOfAxis_px = 20.0;

double widest_tick_px(const Axis& axis) {
  double widest = 0.0;
  for (const double tick : axis.ticks()) {
    widest = std::max(widest, widest_px(axis.short_text(tick), kTick_px));
  }
  return widest;
}

}  // namespace

Svg study_svg(double width_px, double height_px, const std::string& title) {
  return Svg(width_px, height_px, "study", title,
             fmt::format("style=\"min-width:{:.0f}px;max-width:{:.0f}px\"", kMinScale * width_px,
                         kMaxScale * width_px));
}

std::string study_figure(const PlotTexts& texts, const std::string& legend, const std::string& svg,
                         double width_px) {
  const std::string keys = legend.empty() ? "" : tools::report::legend_line(legend);
  return fmt::format(
      "<figure class=\"plot study{}\">\n<h4>{}</h4>\n{}<div class=\"study-scroll\">\n{}</div>\n{}"
      "</figure>\n",
      width_px > kHalfWidth_px ? " wide" : "", escaped(texts.title), keys, svg,
      texts.caption.empty() ? "" : "<figcaption>" + escaped(texts.caption) + "</figcaption>\n");
}

std::string empty_figure(const PlotTexts& texts, const std::string& reason) {
  return fmt::format("<figure class=\"plot study\">\n<h4>{}</h4>\n<p>{}</p>\n</figure>\n",
                     escaped(texts.title), escaped(reason));
}

std::string legend_words(const std::string& words) {
  return "<span>" + escaped(words) + "</span>";
}

double upright_axis_px(const Axis& y) {
  return std::ceil(kTitleSpace_px + widest_tick_px(y) + 7.0);
}

void draw_upright_axis(const Axis& y, double left_px, double right_px, const std::string& title,
                       Svg& svg) {
  for (const double tick : y.ticks()) {
    svg.line(left_px, y.px(tick), right_px, y.px(tick), "grid");
    svg.text(left_px - 7, y.px(tick) + 4, y.short_text(tick), "tick end");
  }
  svg.line(left_px, y.from_px(), left_px, y.to_px(), "axis");
  draw_title_left(y.to_px(), y.from_px(), title, svg);
}

void draw_level_axis(const Axis& x, double axis_px, double grid_to_px, const std::string& title,
                     Svg& svg) {
  // Labels of a logarithmic axis differ in width; a label that would touch the previous one is left
  // out.
  double free_from = 2.0;
  for (const double tick : x.ticks()) {
    const double at = x.px(tick), half = 0.5 * widest_px(x.short_text(tick), kTick_px);
    if (grid_to_px != axis_px) svg.line(at, axis_px, at, grid_to_px, "grid");
    svg.line(at, axis_px, at, axis_px + 5, "axis");
    if (at - half < free_from || at + half > x.to_px() + kRightOfAxis_px) continue;
    svg.text(at, axis_px + 19, x.short_text(tick), "tick mid");
    free_from = at + half + 6.0;
  }
  svg.line(x.from_px(), axis_px, x.to_px(), axis_px, "axis");
  draw_title_below(x.from_px(), x.to_px(), axis_px + 38, title, svg);
}

void draw_title_below(double from_px, double to_px, double baseline_px, const std::string& title,
                      Svg& svg) {
  const double width = std::max(to_px - from_px, 200.0);
  svg.text(0.5 * (from_px + to_px), baseline_px, shortened(title, width, kLabel_px), "label mid");
}

void draw_title_left(double from_px, double to_px, const std::string& title, Svg& svg) {
  svg.turned_text(15, 0.5 * (from_px + to_px), -90, shortened(title, to_px - from_px, kLabel_px),
                  "label mid");
}

int ticks_for(double length_px, bool wide) {
  return std::clamp(static_cast<int>(length_px / (wide ? 54.0 : 40.0)), 2, 10);
}

}  // namespace vinerow::study
