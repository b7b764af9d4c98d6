#include "tools/study/plots/interval_plot.h"

#include <algorithm>
#include <cmath>

#include "tools/report/html.h"
#include "tools/study/plots/level_labels.h"
#include "tools/study/plots/text_fit.h"

namespace vinerow::study {
namespace {

using tools::report::Axis;
using tools::report::Range;
using tools::report::Svg;

constexpr double kRowsTop_px = 26.0, kRowsBottom_px = 50.0, kDot_px = 4.6;
constexpr double kText_px = 15.0;  ///< minimum row pitch for labels

struct IntervalLayout {
  double left = 0.0, right = 0.0;  ///< edges of the plot
  double row = 0.0, bottom = 0.0, width = 0.0, height = 0.0;
  std::size_t stride = 1;  ///< every stride-th row has labels

  double middle(std::size_t i) const { return kRowsTop_px + (static_cast<double>(i) + 0.5) * row; }
};

/// Value and interval without the unit, which is on the axis.
std::string numbers_text(const IntervalRow& row, const Range& range) {
  return even_interval_text(row.value, row.low, row.high, range);
}

IntervalLayout lay_out_rows(const IntervalPlot& plot, const Range& range) {
  constexpr double kMaxLabel_px = 250.0, kMinPlot_px = 220.0;
  constexpr double kTallest_px = 3000.0, kMinRow_px = 5.0, kRow_px = 24.0;
  std::vector<std::string> names = {plot.rows_title}, numbers;
  for (const IntervalRow& row : plot.rows) {
    names.push_back(row.label);
    numbers.push_back(numbers_text(row, range));
  }
  const auto count = static_cast<double>(plot.rows.size());
  IntervalLayout at;
  at.row = std::clamp(kTallest_px / count, kMinRow_px, kRow_px);
  at.stride = label_stride(at.row, kText_px);
  at.left = std::ceil(row_labels_px(names, kMaxLabel_px) * kLabel_px / kTick_px + 20.0);
  const double numbers_px = std::ceil(row_labels_px(numbers, 220.0) + 24.0);
  const bool half = at.left + kMinPlot_px + numbers_px <= kHalfWidth_px;
  at.width = half ? kHalfWidth_px : kFullWidth_px;
  at.right = at.width - numbers_px;
  at.bottom = kRowsTop_px + count * at.row;
  at.height = at.bottom + kRowsBottom_px;
  return at;
}

Range values_of(const IntervalPlot& plot) {
  Range values;
  for (const IntervalRow& row : plot.rows) {
    if (!can_draw(row.value)) continue;
    for (const double value : {row.value, row.low, row.high}) {
      if (can_draw(value)) values.include(value);
    }
  }
  if (plot.reference && can_draw(plot.reference->value)) values.include(plot.reference->value);
  return values;
}

bool contains_reference(const IntervalPlot& plot, const IntervalRow& row) {
  return plot.reference && row.low <= plot.reference->value && plot.reference->value <= row.high;
}

void draw_interval(const IntervalRow& row, const Axis& x, double y, double cap, Svg& svg) {
  if (std::isnan(row.low) || std::isnan(row.high)) return;
  const auto place = [&](double bound) {
    return x.px(std::clamp(bound, x.range().low, x.range().high));
  };
  svg.line(place(row.low), y, place(row.high), y, "whisker s0");
  // No cap where the interval continues beyond the plot.
  for (const double bound : {row.low, row.high}) {
    if (can_draw(bound)) svg.line(place(bound), y - cap, place(bound), y + cap, "whisker s0");
  }
}

void draw_row(const IntervalPlot& plot, std::size_t i, const IntervalLayout& at, const Axis& x,
              Svg& svg) {
  const IntervalRow& row = plot.rows[i];
  const Range& range = x.range();
  const double y = at.middle(i), size = std::min(1.0, at.row / 16.0);
  const std::string attribute = cell_attribute(row.cell);
  svg.open_group("class=\"mark\"" + (attribute.empty() ? "" : " " + attribute));
  const std::string tip = tip_text(
      {row.label, plot.value.label + ": " + interval_text(row.value, row.low, row.high, plot.value),
       row.note},
      row.cell);
  svg.raw("<title>" + tools::escaped(tip) + "</title>\n");
  // The whole row reacts to the pointer.
  svg.rect(0, y - 0.5 * at.row, at.width, at.row, "reach");
  if (can_draw(row.value)) {
    draw_interval(row, x, y, 4.0 * size, svg);
    svg.circle(x.px(row.value), y, kDot_px * size,
               contains_reference(plot, row) ? "ring s0" : "dot s0");
  }
  if (i % at.stride == 0) {
    svg.text(at.left - 12, y + 4.3, shortened(row.label, at.left - 16.0, kLabel_px), "label end");
    svg.text(at.right + 14, y + 4.3,
             shortened(numbers_text(row, range), at.width - at.right - 16.0, kTick_px), "tick");
  }
  svg.close_group();
}

std::string interval_legend(const IntervalPlot& plot) {
  using tools::report::legend_key;
  std::string keys;
  if (!plot.spread_label.empty()) keys += legend_key("s0", plot.spread_label);
  if (!plot.reference) return keys;
  if (!plot.reference->label.empty()) keys += legend_key("ref", plot.reference->label);
  const bool hollow = std::any_of(plot.rows.begin(), plot.rows.end(), [&](const auto& row) {
    return can_draw(row.value) && contains_reference(plot, row);
  });
  if (hollow) keys += legend_words("○: the interval contains it");
  return keys;
}

}  // namespace

std::string interval_plot(const IntervalPlot& plot) {
  if (plot.rows.empty()) return "";
  const Range range = axis_range(values_of(plot), plot.value);
  const IntervalLayout at = lay_out_rows(plot, range);
  const Axis x(range, at.left, at.right, ticks_for(at.right - at.left, true));
  Svg svg = study_svg(at.width, at.height, plot.texts.title);
  draw_level_axis(x, at.bottom, kRowsTop_px, plot.value.title(), svg);
  svg.text(at.left - 12, kRowsTop_px - 9, shortened(plot.rows_title, at.left - 16.0, kTick_px),
           "tick end");
  if (plot.reference && can_draw(plot.reference->value)) {
    const double at_px = x.px(plot.reference->value);
    svg.line(at_px, at.bottom, at_px, kRowsTop_px, "line ref");
  }
  for (std::size_t i = 0; i < plot.rows.size(); ++i) draw_row(plot, i, at, x, svg);
  return study_figure(plot.texts, interval_legend(plot), svg.finish(), at.width);
}

}  // namespace vinerow::study
