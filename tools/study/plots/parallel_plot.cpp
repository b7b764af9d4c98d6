#include "tools/study/plots/parallel_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/html.h"
#include "tools/study/plots/colour_bar.h"
#include "tools/study/plots/level_labels.h"
#include "tools/study/plots/text_fit.h"

namespace vinerow::study {
namespace {

using tools::escaped;
using tools::report::Axis;
using tools::report::px;
using tools::report::Range;
using tools::report::Svg;

constexpr double kPaths_px = 330.0, kBar_px = 13.0;
constexpr std::size_t kTitleLines = 3;
constexpr double kTitleLine_px = 16.0;
constexpr double kPathsTop_px = kTitleLines * kTitleLine_px + 14.0;

/// Axis and its position.
struct Upright {
  const ParallelAxis* what;
  Axis axis;
  double x = 0.0;
};

Range parallel_range(const ParallelPlot& plot, std::size_t index) {
  const ParallelAxis& axis = plot.axes[index];
  if (!axis.levels.empty()) {
    const auto last = static_cast<double>(axis.levels.size() - 1);
    return last > 0.0 ? Range{0.0, last} : Range{-0.5, 0.5};
  }
  Range values;
  for (const ParallelLine& line : plot.lines) {
    if (can_draw(line.values[index])) values.include(line.values[index]);
  }
  return axis_range(values, axis.quantity, 0.0);
}

/// Labels next to an axis: heights and texts.
struct SideText {
  double y = 0.0;
  std::string text;
};

std::vector<SideText> side_texts(const Upright& upright) {
  std::vector<SideText> out;
  const std::vector<std::string>& levels = upright.what->levels;
  if (levels.empty()) {
    for (const double tick : upright.axis.ticks()) {
      out.push_back({upright.axis.px(tick), upright.axis.short_text(tick)});
    }
    return out;
  }
  const double pitch = kPaths_px / static_cast<double>(std::max<std::size_t>(1, levels.size() - 1));
  const std::size_t stride = label_stride(pitch, 16.0);
  for (std::size_t i = 0; i < levels.size(); i += stride) {
    out.push_back({upright.axis.px(static_cast<double>(i)), levels[i]});
  }
  return out;
}

double widest_side_px(const Upright& upright) {
  double widest = 0.0;
  for (const SideText& side : side_texts(upright)) {
    widest = std::max(widest, widest_px(side.text, kTick_px));
  }
  return widest;
}

struct ParallelLayout {
  std::vector<Upright> uprights;
  double pitch = 0.0, width = 0.0, height = 0.0;
};

ParallelLayout lay_out_axes(const ParallelPlot& plot) {
  constexpr double kMinPitch_px = 118.0, kMaxSide_px = 130.0;
  constexpr std::size_t kHalfAxes = 4;
  ParallelLayout at;
  for (std::size_t i = 0; i < plot.axes.size(); ++i) {
    at.uprights.push_back({&plot.axes[i], Axis(parallel_range(plot, i), kPathsTop_px + kPaths_px,
                                               kPathsTop_px, ticks_for(kPaths_px, false))});
  }
  const auto space_px = [&](const Upright& upright) {
    return std::max(60.0, std::min(widest_side_px(upright), kMaxSide_px) + 16.0);
  };
  const double left = space_px(at.uprights.front()), right = space_px(at.uprights.back()) + kBar_px;
  const double gaps = static_cast<double>(plot.axes.size()) - 1.0;
  const double page = plot.axes.size() <= kHalfAxes ? kHalfWidth_px : kFullWidth_px;
  at.pitch = std::max((page - left - right) / gaps, kMinPitch_px);
  for (std::size_t i = 0; i < at.uprights.size(); ++i) {
    at.uprights[i].x = left + static_cast<double>(i) * at.pitch;
  }
  at.width = left + gaps * at.pitch + right;
  at.height = kPathsTop_px + kPaths_px + 16.0;
  return at;
}

/// @param middle_px  centre of the title @param edge_px  nearest edge of the picture
void draw_upright_title(const Quantity& quantity, double middle_px, double edge_px, double pitch,
                        Svg& svg) {
  // Limit the width so that titles touch neither each other nor the edge.
  const double space_px = std::min(pitch - 14.0, 2.0 * std::abs(middle_px - edge_px) - 4.0);
  const std::size_t for_unit = quantity.unit.empty() ? 0 : 1;
  std::vector<std::string> lines =
      wrapped(quantity.label, space_px, kLabel_px, kTitleLines - for_unit);
  if (for_unit > 0) lines.push_back(shortened(quantity.unit, space_px, kLabel_px));
  double y = kPathsTop_px - 14.0 - kTitleLine_px * (static_cast<double>(lines.size()) - 1.0);
  for (std::size_t i = 0; i < lines.size(); ++i, y += kTitleLine_px) {
    const bool unit = for_unit > 0 && i + 1 == lines.size();
    svg.text(middle_px, y, lines[i], unit ? "tick mid" : "label mid");
  }
}

void draw_side(const Upright& upright, double pitch, bool first, bool last, Svg& svg) {
  const double space_px = first ? upright.x - 12.0 : last ? 140.0 : pitch - 26.0;
  for (const SideText& side : side_texts(upright)) {
    const std::string text = shortened(side.text, space_px, kTick_px);
    if (last) {
      svg.line(upright.x + kBar_px, side.y, upright.x + kBar_px + 4, side.y, "axis");
      svg.text(upright.x + kBar_px + 8, side.y + 4.3, text, "tick");
    } else {
      svg.line(upright.x - 4, side.y, upright.x, side.y, "axis");
      svg.text(upright.x - 8, side.y + 4.3, text, "tick end halo");
    }
  }
}

std::string tip_line(const Upright& upright, double value) {
  const auto& [quantity, levels] = *upright.what;
  if (!levels.empty()) {
    const auto index = static_cast<std::size_t>(std::max(0.0, std::round(value)));
    return quantity.label + ": " +
           (std::isfinite(value) && index < levels.size() ? levels[index] : "none");
  }
  return quantity.label + ": " + value_text(value, quantity);
}

void draw_path(const ParallelLine& line, const ParallelLayout& at, Svg& svg) {
  std::string path, tip;
  bool joined = false;
  for (std::size_t i = 0; i < at.uprights.size(); ++i) {
    const Upright& upright = at.uprights[i];
    const double value = line.values[i];
    tip += tip_line(upright, value) + "\n";
    if (can_draw(value)) {
      path += fmt::format("{}{} {}", joined ? "L" : "M", px(upright.x), px(upright.axis.px(value)));
    }
    joined = can_draw(value);
  }
  const double last = line.values.back();
  const std::string colour =
      can_draw(last) ? "stroke=\"" + colour_of(last, at.uprights.back().axis.range()) + "\"" : "";
  const std::string cell = cell_attribute(line.cell);
  svg.raw(fmt::format("<path class=\"way{}\"{}{} d=\"{}\"><title>{}</title></path>\n",
                      colour.empty() ? " uncoloured" : "", colour.empty() ? "" : " " + colour,
                      cell.empty() ? "" : " " + cell, path,
                      escaped(tip_text({tip.substr(0, tip.size() - 1), line.note}, line.cell))));
}

/// Opacity of the lines: many lines are transparent, which shows their density.
double opacity_for(std::size_t lines) {
  return lines <= 40 ? 0.9 : lines <= 200 ? 0.6 : lines <= 800 ? 0.4 : 0.28;
}

}  // namespace

std::string parallel_plot(const ParallelPlot& plot) {
  if (plot.axes.size() < 2 || plot.lines.empty()) return "";
  const ParallelLayout at = lay_out_axes(plot);
  Svg svg = study_svg(at.width, at.height, plot.texts.title);
  const std::size_t shown = std::min(plot.lines.size(), plot.max_lines);
  svg.open_group(fmt::format("class=\"ways\" stroke-opacity=\"{}\"", opacity_for(shown)));
  for (std::size_t i = 0; i < shown; ++i) {
    draw_path(plot.lines[i * plot.lines.size() / shown], at, svg);
  }
  svg.close_group();
  for (std::size_t i = 0; i < at.uprights.size(); ++i) {
    const Upright& upright = at.uprights[i];
    const bool first = i == 0, last = i + 1 == at.uprights.size();
    if (last) {
      svg.open_group("class=\"ways\"");
      draw_upright_bar(upright.axis, upright.x, kBar_px, svg);
      svg.close_group();
    } else {
      svg.line(upright.x, upright.axis.from_px(), upright.x, upright.axis.to_px(), "axis");
    }
    draw_side(upright, at.pitch, first, last, svg);
    const double middle = last ? upright.x + 0.5 * kBar_px : upright.x;
    draw_upright_title(upright.what->quantity, middle, middle < 0.5 * at.width ? 0.0 : at.width,
                       at.pitch, svg);
  }
  PlotTexts texts = plot.texts;
  if (shown < plot.lines.size()) {
    texts.caption += fmt::format("{}Of {} lines {} evenly chosen ones are drawn.",
                                 texts.caption.empty() ? "" : " ", plot.lines.size(), shown);
  }
  return study_figure(texts, "", svg.finish(), at.width);
}

}  // namespace vinerow::study
