#include "tools/study/plots/band_plot.h"

#include <algorithm>
#include <cmath>

#include "tools/report/html.h"

namespace vinerow::study {
namespace {

using tools::report::Axis;
using tools::report::AxisScale;
using tools::report::Range;
using tools::report::Svg;

constexpr double kBandHeight_px = 340.0, kBandTop_px = 12.0, kBandBottom_px = 50.0,
                 kBandRight_px = 20.0;
/// Horizontal offset between groups, so that their whiskers do not cover each other.
constexpr double kGroupOffset_px = 5.0;

bool on_axis(double value, AxisScale scale) {
  return can_draw(value) && (scale == AxisScale::kLinear || value > 0.0);
}

bool is_drawn(const BandPoint& point, const BandPlot& plot) {
  return on_axis(point.x, plot.x_scale) && on_axis(point.value, plot.y_scale);
}

Range shown_range(const Range& values, const Quantity& quantity, AxisScale scale) {
  return scale == AxisScale::kLinear ? axis_range(values, quantity) : logarithmic_range(values);
}

/// Axes that contain every point with its interval.
struct BandAxes {
  Axis x, y;
};

BandAxes make_axes(const BandPlot& plot, const Range& xs, const Range& ys) {
  const Axis y(shown_range(ys, plot.y, plot.y_scale), kBandHeight_px - kBandBottom_px, kBandTop_px,
               ticks_for(kBandHeight_px - kBandBottom_px - kBandTop_px, false), plot.y_scale);
  const double left = upright_axis_px(y), right = kHalfWidth_px - kBandRight_px;
  return {Axis(shown_range(xs, plot.x, plot.x_scale), left, right, ticks_for(right - left, true),
               plot.x_scale),
          y};
}

/// Pixel of an interval's bound, clipped to the plot.
double bound_px(double bound, const Axis& y, AxisScale scale) {
  if (scale == AxisScale::kLogarithmic && bound <= 0.0) return y.from_px();
  return y.px(std::clamp(bound, y.range().low, y.range().high));
}

class GroupDrawing {
 public:
  GroupDrawing(const BandPlot& plot, std::size_t group, const BandAxes& axes)
      : plot_(plot), group_(plot.groups[group]), axes_(axes), index_(group) {
    for (const BandPoint& point : group_.points) {
      if (on_axis(point.x, plot.x_scale)) points_.push_back(&point);
    }
    std::stable_sort(points_.begin(), points_.end(),
                     [](const auto* a, const auto* b) { return a->x < b->x; });
    if (plot.spread == Spread::kWhiskers) {
      group_offset_px_ = kGroupOffset_px * (static_cast<double>(group) -
                                            0.5 * (static_cast<double>(plot.groups.size()) - 1.0));
    }
  }

  void draw_spread(Svg& svg) const {
    if (plot_.spread == Spread::kBand) {
      for (const auto& stretch : stretches()) draw_band(stretch, svg);
      return;
    }
    for (const BandPoint* point : points_) {
      if (is_drawn(*point, plot_) && has_interval(*point)) draw_whisker(*point, svg);
    }
  }

  void draw_line(Svg& svg) const {
    for (const auto& stretch : stretches()) {
      std::vector<Eigen::Vector2d> line;
      for (const BandPoint* point : stretch) line.emplace_back(x_px(*point), y_px(*point));
      svg.polyline(line, "line " + group_class(index_), group_.label);
    }
  }

  void draw_marks(Svg& svg) const {
    for (const BandPoint* point : points_) {
      if (!is_drawn(*point, plot_)) continue;
      draw_marker(group_shape(index_), x_px(*point), y_px(*point), group_class(index_),
                  tip_text({group_.label, plot_.x.label + ": " + value_text(point->x, plot_.x),
                            plot_.y.label + ": " +
                                interval_text(point->value, point->low, point->high, plot_.y),
                            point->note},
                           point->cell),
                  point->cell, plot_.groups.size() > 3 ? 7.0 : 11.0, svg);
    }
  }

 private:
  static bool has_interval(const BandPoint& point) {
    return !std::isnan(point.low) && !std::isnan(point.high);
  }
  double x_px(const BandPoint& point) const { return axes_.x.px(point.x) + group_offset_px_; }
  double y_px(const BandPoint& point) const { return axes_.y.px(point.value); }

  /// Runs of points without a gap.
  std::vector<std::vector<const BandPoint*>> stretches() const {
    std::vector<std::vector<const BandPoint*>> out(1);
    for (const BandPoint* point : points_) {
      if (is_drawn(*point, plot_)) {
        out.back().push_back(point);
      } else if (!out.back().empty()) {
        out.emplace_back();
      }
    }
    return out;
  }

  void draw_band(const std::vector<const BandPoint*>& stretch, Svg& svg) const {
    std::vector<Eigen::Vector2d> outline;
    for (const BandPoint* point : stretch) {
      // The band has no width where the interval is unknown.
      const double low = has_interval(*point) ? point->low : point->value;
      outline.emplace_back(x_px(*point), bound_px(low, axes_.y, plot_.y_scale));
    }
    for (auto point = stretch.rbegin(); point != stretch.rend(); ++point) {
      const double high = has_interval(**point) ? (*point)->high : (*point)->value;
      outline.emplace_back(x_px(**point), bound_px(high, axes_.y, plot_.y_scale));
    }
    svg.polygon(outline, "band " + group_class(index_));
  }

  void draw_whisker(const BandPoint& point, Svg& svg) const {
    constexpr double kCap_px = 4.0;
    const std::string css_class = "whisker " + group_class(index_);
    const double x = x_px(point);
    const double low = bound_px(point.low, axes_.y, plot_.y_scale);
    const double high = bound_px(point.high, axes_.y, plot_.y_scale);
    svg.line(x, low, x, high, css_class);
    for (const double end : {low, high}) svg.line(x - kCap_px, end, x + kCap_px, end, css_class);
  }

  const BandPlot& plot_;
  const BandGroup& group_;
  const BandAxes& axes_;
  std::size_t index_;
  double group_offset_px_ = 0.0;
  std::vector<const BandPoint*> points_;
};

std::string band_legend(const BandPlot& plot, bool with_spread) {
  std::string keys;
  for (std::size_t g = 0; g < plot.groups.size(); ++g) {
    const std::string& label = plot.groups[g].label;
    if (label.empty()) continue;
    keys += tools::report::legend_key(group_class(g),
                                      std::string(shape_letter(group_shape(g))) + " " + label);
  }
  if (!with_spread || plot.spread_label.empty()) return keys;
  if (plot.spread == Spread::kWhiskers)
    return keys + legend_words("whiskers: " + plot.spread_label);
  const char* colour = plot.groups.size() == 1 ? "area s0" : "area s7";
  return keys + tools::report::legend_key(colour, plot.spread_label);
}

}  // namespace

std::string band_plot(const BandPlot& plot) {
  Range xs, ys;
  bool with_spread = false;
  for (const BandGroup& group : plot.groups) {
    for (const BandPoint& point : group.points) {
      if (!is_drawn(point, plot)) continue;
      xs.include(point.x);
      ys.include(point.value);
      for (const double bound : {point.low, point.high}) {
        if (on_axis(bound, plot.y_scale)) ys.include(bound);
        with_spread = with_spread || !std::isnan(bound);
      }
    }
  }
  if (xs.empty()) return "";
  const BandAxes axes = make_axes(plot, xs, ys);
  Svg svg = study_svg(kHalfWidth_px, kBandHeight_px, plot.texts.title);
  draw_upright_axis(axes.y, axes.x.from_px(), axes.x.to_px(), plot.y.title(), svg);
  draw_level_axis(axes.x, axes.y.from_px(), axes.y.from_px(), plot.x.title(), svg);
  std::vector<GroupDrawing> drawings;
  for (std::size_t g = 0; g < plot.groups.size(); ++g) drawings.emplace_back(plot, g, axes);
  // Marks are above all bands and lines, so that each can be clicked.
  for (const GroupDrawing& drawing : drawings) drawing.draw_spread(svg);
  for (const GroupDrawing& drawing : drawings) drawing.draw_line(svg);
  for (const GroupDrawing& drawing : drawings) drawing.draw_marks(svg);
  return study_figure(plot.texts, band_legend(plot, with_spread), svg.finish(), kHalfWidth_px);
}

}  // namespace vinerow::study
