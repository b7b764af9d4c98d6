#include "tools/report/line_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/html.h"
#include "tools/report/papers.h"
#include "tools/report/svg.h"

namespace vinerow::tools::report {
namespace {

/// A limit farther outside the lines than this multiple of their span is left out. Chosen.
constexpr double kFarLimit = 3.0;

Range line_range(const LinePlot& plot) {
  Range range;
  for (const PlotLine& line : plot.lines) range.include(line.samples.y);
  if (!range.empty()) return range;
  for (const PlotBand& band : plot.bands) {
    range.include(band.low);
    range.include(band.high);
  }
  return range;
}

/// Range of the lines, widened by bands up to a multiple of the lines' span; bands are clipped
/// there.
Range with_bands(const Range& lines, const LinePlot& plot) {
  constexpr double kMaxWider = 1.0;
  const double reach = kMaxWider * std::max(lines.span(), plot.min_span);
  Range range = lines;
  for (const PlotBand& band : plot.bands) {
    for (const auto* side : {&band.low, &band.high}) {
      for (const double y : *side) {
        if (std::isfinite(y)) range.include(std::clamp(y, lines.low - reach, lines.high + reach));
      }
    }
  }
  return range;
}

bool is_near(const PlotLimit& limit, const Range& lines, double min_span) {
  const double reach = kFarLimit * std::max(lines.span(), min_span);
  return lines.empty() || (limit.y > lines.low - reach && limit.y < lines.high + reach);
}

void draw_axes(const Axis& x, const Axis& y, const LinePlot& plot, const PlotFrame& frame,
               Svg& svg) {
  const double bottom = y.from_px(), right = x.to_px();
  for (const double tick : y.ticks()) {
    svg.line(x.from_px(), y.px(tick), right, y.px(tick), "grid");
    svg.text(x.from_px() - 7, y.px(tick) + 4, y.text(tick), "tick end");
  }
  for (const double tick : x.ticks()) {
    svg.line(x.px(tick), bottom, x.px(tick), bottom + 5, "axis");
    svg.text(x.px(tick), bottom + 19, x.text(tick), "tick mid");
  }
  svg.line(x.from_px(), bottom, right, bottom, "axis");
  svg.line(x.from_px(), bottom, x.from_px(), y.to_px(), "axis");
  svg.text(0.5 * (x.from_px() + right), frame.height - 8, plot.x_label, "label mid");
  svg.turned_text(15, 0.5 * (bottom + y.to_px()), -90, plot.y_label, "label mid");
}

void draw_line(const PlotLine& line, const Axis& x, const Axis& y, Svg& svg) {
  const Samples few = decimate(line.samples);
  std::vector<Eigen::Vector2d> stretch;
  for (std::size_t i = 0; i < few.size(); ++i) {
    if (std::isfinite(few.y[i])) {
      stretch.emplace_back(x.px(few.x[i]), y.px(few.y[i]));
      continue;
    }
    svg.polyline(stretch, "line " + line.style, line.label);
    stretch.clear();
  }
  svg.polyline(stretch, "line " + line.style, line.label);
}

void draw_band(const PlotBand& band, const Axis& x, const Axis& y, Svg& svg) {
  const Samples low = decimate({band.x, band.low}), high = decimate({band.x, band.high});
  const auto inside = [&](double value) {
    return y.px(std::clamp(value, y.range().low, y.range().high));
  };
  std::vector<Eigen::Vector2d> outline;
  for (std::size_t i = 0; i < low.size(); ++i) {
    if (std::isfinite(low.y[i])) outline.emplace_back(x.px(low.x[i]), inside(low.y[i]));
  }
  for (std::size_t i = high.size(); i-- > 0;) {
    if (std::isfinite(high.y[i])) outline.emplace_back(x.px(high.x[i]), inside(high.y[i]));
  }
  svg.polygon(outline, "band " + band.style);
}

std::string legend(const LinePlot& plot) {
  std::string keys;
  for (const PlotLine& line : plot.lines) keys += legend_key(line.style, line.label);
  for (const PlotBand& band : plot.bands) keys += legend_key("area " + band.style, band.label);
  if (!plot.spans.empty()) keys += legend_key("area span", plot.spans_label);
  const Range lines = line_range(plot);
  std::string previous_label;
  for (const PlotLimit& limit : plot.limits) {
    if (limit.label == previous_label || !is_near(limit, lines, plot.min_span)) continue;
    previous_label = limit.label;
    keys += legend_key("limit", limit.label);
  }
  return legend_line(keys);
}

}  // namespace

bool LinePlot::empty() const {
  return line_range(*this).empty();
}

Range x_range(const LinePlot& plot) {
  Range range;
  for (const PlotLine& line : plot.lines) {
    for (std::size_t i = 0; i < line.samples.size(); ++i) {
      if (std::isfinite(line.samples.y[i])) range.include(line.samples.x[i]);
    }
  }
  for (const PlotBand& band : plot.bands) range.include(band.x);
  return range.padded(0.0, 1e-3);
}

Range y_range(const LinePlot& plot) {
  const Range lines = line_range(plot);
  Range range = lines.empty() ? lines : with_bands(lines, plot);
  for (const PlotLimit& limit : plot.limits) {
    if (is_near(limit, lines, plot.min_span)) range.include(limit.y);
  }
  range = range.padded(0.05, plot.min_span);
  // No padding beyond the largest possible value, such as a charge of 100 %.
  const double maximum = std::max(plot.maximum, lines.empty() ? plot.maximum : lines.high);
  if (range.high > maximum) range = {std::min(range.low, maximum - plot.min_span), maximum};
  return range;
}

std::string draw(const LinePlot& plot, const PlotFrame& frame) {
  const Axis x(x_range(plot), frame.left, frame.width - frame.right, 8);
  const Axis y(y_range(plot), frame.height - frame.bottom, frame.top, 6);
  Svg svg(
      frame.width, frame.height, "plot", plot.title,
      fmt::format("data-x=\"{} {} {} {}\" data-y=\"{} {} {} {}\"", x.range().low, x.range().high,
                  x.from_px(), x.to_px(), y.range().low, y.range().high, y.from_px(), y.to_px()));
  for (const PlotSpan& span : plot.spans) {
    const double from = std::max(span.from, x.range().low), to = std::min(span.to, x.range().high);
    if (to > from) {
      svg.rect(x.px(from), y.to_px(), x.px(to) - x.px(from), y.from_px() - y.to_px(), "span");
    }
  }
  draw_axes(x, y, plot, frame, svg);
  for (const PlotBand& band : plot.bands) draw_band(band, x, y, svg);
  const Range lines = line_range(plot);
  for (const PlotLimit& limit : plot.limits) {
    if (!is_near(limit, lines, plot.min_span)) continue;
    svg.line(x.from_px(), y.px(limit.y), x.to_px(), y.px(limit.y), "limit");
  }
  for (const PlotLine& line : plot.lines) draw_line(line, x, y, svg);
  return svg.finish();
}

std::string figure(const LinePlot& plot, const PlotFrame& frame) {
  if (plot.empty()) return "";
  return figure(frame.width > PlotFrame{}.width ? "plot wide-chart" : "plot", plot.title,
                legend(plot) + draw(plot, frame), with_citations(plot.caption));
}

}  // namespace vinerow::tools::report
