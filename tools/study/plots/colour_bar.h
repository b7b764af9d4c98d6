#pragma once
/// Colours for the values of a plot, and colour bars.

#include <string>

#include "tools/report/axis.h"
#include "tools/report/svg.h"
#include "tools/study/plots/quantity.h"

namespace vinerow::study {

/// Colour of a value on viridis as "#1f9e89". @pre range.span() > 0
std::string colour_of(double value, const tools::report::Range& range);

/// Whether white is easier to read on that colour than black, by the contrast of WCAG 2.
bool is_dark(double value, const tools::report::Range& range);

/// Height of a horizontal bar with its title and its ticks, px.
inline constexpr double kLyingBar_px = 56.0;

/// Draws a horizontal bar from x = left_px, with its title above and its ticks below.
/// @param space_px  width for texts, at least length_px
void draw_lying_bar(const tools::report::Range& range, const Quantity& quantity, double left_px,
                    double top_px, double length_px, double space_px, tools::report::Svg& svg);

/// Draws a vertical bar of colours along an axis. @param left_px  left edge of the bar
void draw_upright_bar(const tools::report::Axis& y, double left_px, double width_px,
                      tools::report::Svg& svg);

}  // namespace vinerow::study
