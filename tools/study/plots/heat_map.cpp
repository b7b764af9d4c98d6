#include "tools/study/plots/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/report/html.h"
#include "tools/study/plots/colour_bar.h"
#include "tools/study/plots/level_labels.h"
#include "tools/study/plots/text_fit.h"

namespace vinerow::study {
namespace {

using tools::report::px;
using tools::report::Range;
using tools::report::Svg;

constexpr double kValue_px = 12.0;

/// Layout of the plot, px.
struct HeatLayout {
  double left = 0.0, top = 0.0;
  double tile_width = 0.0, tile_height = 0.0;
  double plot_width = 0.0, plot_height = 0.0;
  double width = 0.0, height = 0.0;
  LevelLabels x_labels;
  bool with_values = false;  ///< values are written into the tiles
};

double widest_value_px(const HeatMap& map, const Range& range) {
  double widest = 0.0;
  for (const HeatTile& tile : map.tiles) {
    if (can_draw(tile.value)) {
      widest = std::max(widest, widest_px(even_text(tile.value, range), kValue_px));
    }
  }
  return widest;
}

HeatLayout lay_out_tiles(const HeatMap& map, const Range& range) {
  constexpr double kTitle_px = 30.0, kRight_px = 18.0, kMinTile_px = 3.0;
  constexpr double kMaxWidth_px = 110.0, kMaxHeight_px = 36.0, kTallest_px = 520.0;
  const auto columns = static_cast<double>(map.x_levels.size());
  const auto rows = static_cast<double>(map.y_levels.size());
  HeatLayout at;
  at.left = std::ceil(kTitle_px + row_labels_px(map.y_levels, 190.0) + 8.0);
  at.top = kLyingBar_px + 12.0;
  const double value_px = widest_value_px(map, range);
  // Half of the page if the values fit into the tiles, otherwise the full width.
  const double around = at.left + kRight_px, wanted = std::max(value_px + 10.0, 36.0);
  const bool half = columns * wanted <= kHalfWidth_px - around;
  const double available_px = (half ? kHalfWidth_px : kFullWidth_px) - around;
  at.tile_width = std::clamp(available_px / columns, kMinTile_px, kMaxWidth_px);
  at.tile_height = std::clamp(kTallest_px / rows, kMinTile_px, kMaxHeight_px);
  at.plot_width = columns * at.tile_width;
  at.plot_height = rows * at.tile_height;
  at.x_labels = fit_level_labels(map.x_levels, at.tile_width, at.left + 0.5 * at.tile_width);
  at.width = std::max(around + at.plot_width, 420.0);
  at.height = at.top + at.plot_height + at.x_labels.height_px + 30.0;
  at.with_values = value_px + 6.0 <= at.tile_width && at.tile_height >= kValue_px + 4.0;
  return at;
}

std::string heat_tip(const HeatMap& map, std::size_t x, std::size_t y, const HeatTile& tile) {
  return tip_text(
      {map.x.label + ": " + map.x_levels[x], map.y.label + ": " + map.y_levels[y],
       map.value.label + ": " + interval_text(tile.value, tile.low, tile.high, map.value),
       tile.note},
      tile.cell);
}

/// Draws slanted lines inside a tile.
void draw_hatch(double left, double top, double width, double height, Svg& svg) {
  constexpr double kPitch_px = 7.0;
  std::string path;
  for (double along = kPitch_px; along < width + height; along += kPitch_px) {
    // From the left or lower side to the upper or right side.
    const double from_x = std::max(0.0, along - height), to_x = std::min(width, along);
    path += fmt::format("M{} {}L{} {}", px(left + from_x), px(top + along - from_x),
                        px(left + to_x), px(top + along - to_x));
  }
  svg.raw("<path class=\"hatch\" d=\"" + path + "\"/>\n");
}

void draw_tile(const HeatMap& map, const HeatLayout& at, const Range& range, std::size_t x,
               std::size_t y, Svg& svg) {
  const HeatTile& tile = map.tiles[y * map.x_levels.size() + x];
  const double left = at.left + static_cast<double>(x) * at.tile_width;
  const double top = at.top + at.plot_height - static_cast<double>(y + 1) * at.tile_height;
  const bool drawn = can_draw(tile.value);
  std::string attributes = cell_attribute(tile.cell);
  if (drawn) {
    attributes +=
        fmt::format("{}fill=\"{}\"", attributes.empty() ? "" : " ", colour_of(tile.value, range));
  }
  // Gaps only between tiles that are large enough.
  const bool large = std::min(at.tile_width, at.tile_height) >= 10.0;
  const double gap = !large ? 0.0 : at.tile_height < 20.0 ? 0.5 : 0.75;
  svg.rect(left + gap, top + gap, at.tile_width - 2.0 * gap, at.tile_height - 2.0 * gap,
           drawn ? large ? "tile" : "tile sharp" : "tile missing", heat_tip(map, x, y, tile),
           attributes);
  if (!drawn && large) {
    draw_hatch(left + gap, top + gap, at.tile_width - 2.0 * gap, at.tile_height - 2.0 * gap, svg);
  }
  if (drawn && at.with_values) {
    svg.text(left + 0.5 * at.tile_width, top + 0.5 * at.tile_height + 4.3,
             even_text(tile.value, range),
             is_dark(tile.value, range) ? "value on-dark" : "value on-light");
  }
}

void draw_y_labels(const HeatMap& map, const HeatLayout& at, Svg& svg) {
  const std::size_t stride = label_stride(at.tile_height, 15.0);
  for (std::size_t y = 0; y < map.y_levels.size(); y += stride) {
    const double middle = at.top + at.plot_height - (static_cast<double>(y) + 0.5) * at.tile_height;
    svg.text(at.left - 8, middle + 4.3, shortened(map.y_levels[y], at.left - 38.0, kTick_px),
             "tick end");
  }
}

}  // namespace

std::string heat_map(const HeatMap& map) {
  if (map.x_levels.empty() || map.y_levels.empty()) return "";
  if (map.tiles.size() > kMaxTiles) {
    return empty_figure(map.texts, fmt::format("{} tiles are too many to draw; the maximum is {}.",
                                               map.tiles.size(), kMaxTiles));
  }
  Range values;
  bool missing = false;
  for (const HeatTile& tile : map.tiles) {
    if (can_draw(tile.value)) values.include(tile.value);
    missing = missing || !can_draw(tile.value);
  }
  // The colour range is exactly the range of the values.
  const Range range = axis_range(values, map.value, 0.0);
  const HeatLayout at = lay_out_tiles(map, range);
  Svg svg = study_svg(at.width, at.height, map.texts.title);
  if (!values.empty()) {
    const double available_px = at.width - at.left - 6.0;
    const double length = std::min(std::clamp(at.plot_width, 220.0, 320.0), available_px - 12.0);
    draw_lying_bar(range, map.value, at.left, 2.0, length, available_px, svg);
  }
  for (std::size_t y = 0; y < map.y_levels.size(); ++y) {
    for (std::size_t x = 0; x < map.x_levels.size(); ++x) draw_tile(map, at, range, x, y, svg);
  }
  const double right = at.left + at.plot_width, bottom = at.top + at.plot_height;
  draw_y_labels(map, at, svg);
  draw_level_labels(at.x_labels, at.left + 0.5 * at.tile_width, at.tile_width, bottom, svg);
  draw_title_below(at.left, right, at.height - 9.0, map.x.title(), svg);
  draw_title_left(at.top, bottom, map.y.title(), svg);
  const std::string legend =
      missing ? tools::report::legend_key("area missing", "no value") : std::string();
  return study_figure(map.texts, legend, svg.finish(), at.width);
}

}  // namespace vinerow::study
