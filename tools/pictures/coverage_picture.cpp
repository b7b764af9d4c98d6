#include "tools/pictures/coverage_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "engine/api/map.h"
#include "engine/math/statistics.h"
#include "engine/playback/frame_words.h"
#include "engine/render/scale_bar.h"
#include "tools/pictures/colour_scale.h"
#include "tools/pictures/legend.h"
#include "tools/pictures/picture_canvas.h"
#include "tools/pictures/picture_style.h"
#include "tools/pictures/plan_view.h"

namespace vinerow::tools {
namespace {

using Eigen::Vector2d;

constexpr Rgb kPlainGround = {232, 229, 220}, kNone = {190, 92, 76}, kTrack = {255, 255, 255};
constexpr Rgb kShot = {20, 24, 26}, kParcelEdge = {20, 24, 26};
constexpr int kPanelMargin = 32, kPanelGap = 36, kTitle = 34, kScales = 86, kNumbers = 198;
constexpr int kTallestPanel = 900;

/// Extent of both maps: the parcel, without the area in which the plane turns.
Eigen::AlignedBox2d extent_of(const playback::SurveyCoverage& coverage) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& p : coverage.options.parcel_W) box.extend(p);
  const Vector2d margin = Vector2d::Constant(0.08 * box.sizes().maxCoeff());
  return {Vector2d(box.min() - margin), Vector2d(box.max() + margin)};
}

/// One map on the canvas.
struct Panel : PlanProjection {
  double top = 0.0, width = 0.0;

  bool contains(const Vector2d& p_W) const {
    const Vector2d p = (*this)(p_W);
    return p.x() >= left && p.y() >= top && p.x() <= left + width && p.y() <= bottom;
  }
};

/// Layout of two maps: side by side, or one above the other if they are wide.
struct Layout {
  std::array<Panel, 2> panels;
  int height = 0;
  double numbers_top = 0.0;

  explicit Layout(const Eigen::AlignedBox2d& extent_W) {
    const double w = extent_W.sizes().x(), h = extent_W.sizes().y();
    const bool side_by_side = w < 1.6 * h;
    const double panel_width = side_by_side ? 0.5 * (kPictureWidth - 2 * kPanelMargin - kPanelGap)
                                            : kPictureWidth - 2 * kPanelMargin;
    Panel panel;
    panel.px_per_m = std::min(panel_width / w, kTallestPanel / h);
    panel.width = panel_width;
    panel.left = kPanelMargin;
    panel.top = kPanelMargin + kTitle;
    const double panel_height = std::ceil(h * panel.px_per_m);
    panel.bottom = panel.top + panel_height;
    // Centre a map that is narrower than its panel.
    panel.corner_W = extent_W.center() - 0.5 * Vector2d(panel_width, panel_height) / panel.px_per_m;
    panels = {panel, panel};
    const double block = kTitle + panel_height + kScales;
    if (side_by_side) {
      panels[1].left += panel_width + kPanelGap;
    } else {
      panels[1].top += block;
      panels[1].bottom += block;
    }
    numbers_top = kPanelMargin + (side_by_side ? block : 2 * block);
    height = static_cast<int>(numbers_top) + kNumbers;
  }
};

/// Colour of a cell; nullopt where the ground shows through.
using Paint = std::function<std::optional<Rgb>(std::size_t cell)>;

/// Colour of a cell. A cell outside the parcel takes the colour of a neighbour inside, so that
/// colours reach the parcel's edge.
std::optional<Rgb> colour_near(const metrics::CoverageMap& map, const Paint& paint, int i, int j) {
  if (i >= 0 && j >= 0 && i < map.columns && j < map.rows) {
    if (const auto colour = paint(map.cell(i, j))) return colour;
  }
  for (const auto& [di, dj] :
       {std::pair{0, 1}, {1, 0}, {0, -1}, {-1, 0}, {1, 1}, {1, -1}, {-1, -1}, {-1, 1}}) {
    const int k = i + di, l = j + dj;
    if (k < 0 || l < 0 || k >= map.columns || l >= map.rows) continue;
    if (const auto colour = paint(map.cell(k, l))) return colour;
  }
  return std::nullopt;
}

/// Cells whose neighbours are all inside the parcel, for which the edge need not be checked.
std::vector<char> inner_cells(const metrics::CoverageMap& map) {
  std::vector<char> inner(map.pictures.size(), 0);
  for (int j = 1; j + 1 < map.rows; ++j) {
    for (int i = 1; i + 1 < map.columns; ++i) {
      bool all = true;
      for (int k = 0; k < 9; ++k)
        all = all && map.pictures[map.cell(i + k % 3 - 1, j + k / 3 - 1)] >= 0;
      inner[map.cell(i, j)] = all;
    }
  }
  return inner;
}

void draw_cells(Canvas& canvas, const Panel& panel, const playback::SurveyCoverage& coverage,
                const Paint& paint) {
  constexpr int kSamples = 3;
  const metrics::CoverageMap& map = coverage.map;
  const std::vector<char> inner = inner_cells(map);
  for (int y = static_cast<int>(panel.top); y < panel.bottom; ++y) {
    for (int x = static_cast<int>(panel.left); x < panel.left + panel.width; ++x) {
      std::array<int, 3> sum = {0, 0, 0};
      int painted = 0;
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const Vector2d p_W =
            panel.world(x + (s % kSamples + 0.5) / kSamples, y + (s / kSamples + 0.5) / kSamples);
        const Vector2d cell = (p_W - map.corner_W) / map.cell_m;
        const int i = static_cast<int>(std::floor(cell.x()));
        const int j = static_cast<int>(std::floor(cell.y()));
        if (i < -1 || j < -1 || i > map.columns || j > map.rows) continue;
        const bool on_map = i >= 0 && j >= 0 && i < map.columns && j < map.rows;
        const bool is_inner = on_map && inner[map.cell(i, j)];
        if (!is_inner && !contains(coverage.options.parcel_W, p_W)) continue;
        const std::optional<Rgb> colour = colour_near(map, paint, i, j);
        if (!colour) continue;
        ++painted;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += (*colour)[c];
      }
      if (painted == 0) continue;
      canvas.blend(x, y, {sum[0] / painted, sum[1] / painted, sum[2] / painted},
                   painted / static_cast<double>(kSamples * kSamples));
    }
  }
}

void draw_world(Canvas& canvas, const Panel& panel, const playback::SurveyCoverage& coverage) {
  for (const auto& row : coverage.rows) {
    if (!panel.contains(row[0]) || !panel.contains(row[1])) continue;
    canvas.line(panel(row[0]), panel(row[1]), 1.0, kInk, 0.22);
  }
  canvas.outline(panel(coverage.options.parcel_W), 2.5, kParcelEdge);
  for (std::size_t i = 0; i + 1 < coverage.track_W.size(); ++i) {
    const Vector2d &a = coverage.track_W[i], &b = coverage.track_W[i + 1];
    if (!panel.contains(a) || !panel.contains(b)) continue;
    const bool over_parcel = contains(coverage.options.parcel_W, a);
    canvas.line(panel(a), panel(b), 1.6, over_parcel ? kTrack : kFaint, 0.85);
  }
  for (const metrics::LaneShot& lane_shot : coverage.shots) {
    if (!panel.contains(lane_shot.shot.X_WS.p.head<2>())) continue;
    const Vector2d at = panel(Vector2d(lane_shot.shot.X_WS.p.head<2>()));
    canvas.fill(render::circle(at, 3.6, 12), kTrack, 0.9);
    canvas.fill(render::circle(at, 2.4, 12), lane_shot.lane >= 0 ? kShot : kNone);
  }
}

void draw_tick(Canvas& canvas, double x, double top, const std::string& words,
               bool strong = false) {
  canvas.line({x, top + 16}, {x, top + 22}, 1.5, strong ? kInk : kFaint);
  canvas.text(words, 15, {x, top + 38}, strong ? kInk : kFaint, 0.5);
}

void draw_counts(Canvas& canvas, const Panel& panel, const playback::SurveyCoverage& coverage) {
  const metrics::CoverageMap& map = coverage.map;
  const int max_pictures = std::max(1, *std::max_element(map.pictures.begin(), map.pictures.end()));
  // One colour per count: each step of the scale is one more picture.
  const auto colour_of = [max_pictures](int count) {
    return viridis(max_pictures > 1 ? (count - 1.0) / (max_pictures - 1.0) : 1.0);
  };
  draw_cells(canvas, panel, coverage, [&](std::size_t cell) -> std::optional<Rgb> {
    const int count = map.pictures[cell];
    if (count < 0) return std::nullopt;
    return count == 0 ? kNone : colour_of(count);
  });
  draw_world(canvas, panel, coverage);
  canvas.text("Number of pictures that see each point", 20, {panel.left, panel.top - 12}, kInk);
  const double top = panel.bottom + 14, width = panel.width - 190;
  draw_colour_bar(canvas, panel.left, top, width, 16, [&](double share) {
    return colour_of(1 + std::min(max_pictures - 1, static_cast<int>(share * max_pictures)));
  });
  for (const double value : ticks(1, max_pictures, 12)) {
    if (value != std::floor(value)) continue;
    draw_tick(canvas, panel.left + (value - 0.5) / max_pictures * width, top,
              fmt::format("{:g}", value));
  }
  draw_legend_patch(canvas, panel.left + panel.width - 150, top, kNone, "no picture");
}

void draw_overlaps(Canvas& canvas, const Panel& panel, const playback::SurveyCoverage& coverage) {
  const metrics::CoverageMap& map = coverage.map;
  const double wanted = coverage.options.wanted_overlap;
  double min_overlap = wanted;
  for (const float overlap : map.forward_overlap) {
    if (overlap > 0.0f) min_overlap = std::min(min_overlap, static_cast<double>(overlap));
  }
  const double from = std::max(0.0, std::floor((min_overlap - 0.051) * 20.0) / 20.0);
  draw_cells(canvas, panel, coverage, [&](std::size_t cell) -> std::optional<Rgb> {
    const double overlap = map.forward_overlap[cell];
    if (overlap < 0.0) return std::nullopt;
    return overlap == 0.0 ? kNone : viridis((overlap - from) / (1.0 - from));
  });
  draw_world(canvas, panel, coverage);
  canvas.text("Smallest forward overlap of consecutive pictures at each point, on its best lane",
              20, {panel.left, panel.top - 12}, kInk);
  const double top = panel.bottom + 14, width = panel.width - 190;
  draw_colour_bar(canvas, panel.left, top, width, 16, viridis);
  const auto x_of = [&](double value) { return panel.left + (value - from) / (1 - from) * width; };
  for (const double value : ticks(from, 1.0, 6)) {
    if (std::abs(x_of(value) - x_of(wanted)) < 85.0) continue;
    draw_tick(canvas, x_of(value), top, fmt::format("{:.0f} %", 100 * value));
  }
  canvas.line({x_of(wanted), top - 5}, {x_of(wanted), top + 16}, 2.5, kInk);
  draw_tick(canvas, x_of(wanted), top, fmt::format("{:g} % requested", 100 * wanted), true);
  draw_legend_patch(canvas, panel.left + panel.width - 150, top, kNone, "no overlap");
}

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.1f} %", 100.0 * share) : "not measured";
}

/// Overlap that every pair of pictures keeps on at least half of the parcel.
double held_on_half(const metrics::CoverageMap& map) {
  std::vector<float> held;
  std::copy_if(map.forward_overlap.begin(), map.forward_overlap.end(), std::back_inserter(held),
               [](float overlap) { return overlap >= 0.0f; });
  return held.empty() ? 0.0 : value_in_order(held, (held.size() - 1) / 2);
}

void draw_numbers(Canvas& canvas, const Layout& layout, const playback::SurveyCoverage& coverage) {
  const auto number = [&](const char* name) { return coverage.map.numbers.at(name); };
  const double left = kPanelMargin, top = layout.numbers_top + 18;
  canvas.text(fmt::format("{}: {} of {}", playback::title_of_name(coverage.scenario),
                          coverage.camera, coverage.vehicle),
              22, {left, top + 6}, kInk);
  const double area_ha = 1e-4 * std::abs(signed_area_m2(coverage.options.parcel_W));
  std::vector<std::string> lines;
  lines.push_back(fmt::format(
      "{:.0f} pictures, parcel of {:.2f} ha: seen once {}, twice {}, three times {}",
      number("shots"), area_ha, percent(number("covered_share")),
      percent(number("covered_twice_share")), percent(number("covered_three_times_share"))));
  if (number("shots_off_ground") > 0) {
    lines.back() += fmt::format("; {:.0f} look beyond the ground", number("shots_off_ground"));
  }
  lines.push_back(fmt::format(
      "forward overlap: mean {}, minimum {}; at least one pair reaches the requested {:g} % on {} "
      "of the parcel, every pair on {}",
      percent(number("forward_overlap_mean")), percent(number("forward_overlap_min")),
      100 * coverage.options.wanted_overlap, percent(number("overlap_covered_share")),
      percent(number("overlap_held_share"))));
  // Distinguish slightly too little overlap from none.
  const double half = held_on_half(coverage.map);
  if (half > 0.0 && half < coverage.options.wanted_overlap) {
    lines.push_back(
        fmt::format("every pair keeps at least {} on half of the parcel", percent(half)));
  }
  lines.push_back(fmt::format("side overlap: mean {}, minimum {}",
                              percent(number("side_overlap_mean")),
                              percent(number("side_overlap_min"))));
  if (std::isfinite(number("gsd_mean_m"))) {
    lines.push_back(fmt::format(
        "GSD: mean {:.1f} mm, {:.1f} to {:.1f} mm; {:.2f} % above that of a vertical picture",
        1e3 * number("gsd_mean_m"), 1e3 * number("gsd_min_m"), 1e3 * number("gsd_max_m"),
        100 * number("gsd_formula_error_mean")));
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    canvas.text(lines[i], 16, {left, top + 34 + 24 * static_cast<double>(i)}, kFaint);
  }
  const auto outside = std::count_if(
      coverage.shots.begin(), coverage.shots.end(), [&](const metrics::LaneShot& lane_shot) {
        return !layout.panels[0].contains(lane_shot.shot.X_WS.p.head<2>());
      });
  std::string key =
      "thin lines: plant rows; white and grey: track; dots: pictures, red if not on a lane";
  if (outside > 0) key += fmt::format("; {} pictures are outside this frame", outside);
  canvas.text(key, 14, {left, top + 34 + 24 * static_cast<double>(lines.size())}, kFaint);
}

}  // namespace

render::Image draw_coverage(const playback::SurveyCoverage& coverage) {
  const Layout layout(extent_of(coverage));
  Canvas canvas(kPictureWidth, layout.height, kPaper);
  for (const Panel& panel : layout.panels) {
    canvas.fill(render::rectangle(panel.left, panel.top, panel.left + panel.width, panel.bottom),
                kPlainGround);
  }
  draw_counts(canvas, layout.panels[0], coverage);
  draw_overlaps(canvas, layout.panels[1], coverage);
  draw_numbers(canvas, layout, coverage);
  draw_scale_bar(canvas, {kPictureWidth - kPanelMargin, layout.numbers_top + kNumbers - 30},
                 0.2 * layout.panels[0].width / layout.panels[0].px_per_m,
                 layout.panels[0].px_per_m, kInk);
  return canvas.image();
}

}  // namespace vinerow::tools
