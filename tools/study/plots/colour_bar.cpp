#include "tools/study/plots/colour_bar.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/math/srgb.h"
#include "tools/pictures/colour_scale.h"
#include "tools/study/plots/frame.h"
#include "tools/study/plots/text_fit.h"

namespace vinerow::study {
namespace {

using tools::report::Axis;
using tools::report::Range;
using tools::report::Svg;

constexpr int kSteps = 64;
/// Overlap of neighbouring steps, so that no seam shows between them.
constexpr double kOver_px = 2.0;

double share_of(double value, const Range& range) {
  return (value - range.low) / range.span();
}

std::string hex(double share) {
  const auto rgb = tools::viridis(share);
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

}  // namespace

std::string colour_of(double value, const Range& range) {
  return hex(share_of(value, range));
}

bool is_dark(double value, const Range& range) {
  const auto rgb = tools::viridis(share_of(value, range));
  constexpr std::array<double, 3> kWeights = {0.2126, 0.7152, 0.0722};
  double luminance = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    luminance += kWeights[c] * linear_from_srgb(rgb[c] / 255.0);
  }
  // Contrast is (lighter + 0.05) / (darker + 0.05); white has luminance 1, black 0.
  return 1.05 / (luminance + 0.05) > (luminance + 0.05) / 0.05;
}

void draw_lying_bar(const Range& range, const Quantity& quantity, double left_px, double top_px,
                    double length_px, double space_px, Svg& svg) {
  constexpr double kThick_px = 12.0;
  const double bar = top_px + 18.0;
  svg.text(left_px, top_px + 11, shortened(quantity.title(), space_px, kLabel_px), "label");
  const double step = length_px / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double wide = i + 1 < kSteps ? step + kOver_px : step;
    svg.rect(left_px + i * step, bar, wide, kThick_px, "sharp", "",
             fmt::format("fill=\"{}\"", hex((i + 0.5) / kSteps)));
  }
  const Axis axis(range, left_px, left_px + length_px, ticks_for(length_px, true));
  double free_from = 2.0;
  for (const double tick : axis.ticks()) {
    const double at = axis.px(tick), half = 0.5 * widest_px(axis.short_text(tick), kTick_px);
    svg.line(at, bar + kThick_px, at, bar + kThick_px + 4, "axis");
    if (at - half < free_from || at + half > left_px + space_px) continue;
    svg.text(at, bar + kThick_px + 16, axis.short_text(tick), "tick mid");
    free_from = at + half + 6.0;
  }
}

void draw_upright_bar(const Axis& y, double left_px, double width_px, Svg& svg) {
  const double step = (y.from_px() - y.to_px()) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double high = i > 0 ? step + kOver_px : step;
    svg.rect(left_px, y.from_px() - (i + 1) * step, width_px, high, "sharp", "",
             fmt::format("fill=\"{}\"", hex((i + 0.5) / kSteps)));
  }
}

}  // namespace vinerow::study
