#pragma once
/// Colours for the values of a plot, and the bar that explains them.

#include <string>

#include "tools/report/axis.h"
#include "tools/report/svg.h"
#include "tools/study/plots/quantity.h"

namespace vinerow::study {

/// The colour of a value on viridis as "#1f9e89". @pre range.span() > 0
std::string colour_of(double value, const tools::report::Range& range);

/// Whether white is easier to read on that colour than black, by the contrast of WCAG 2.
bool is_dark(double value, const tools::report::Range& range);

/// Height of a bar that lies, with its title and its ticks; px.
inline constexpr double kLyingBar_px = 56.0;

/// A bar from x = left_px on, its title above it, its ticks below.
/// @param room_px  for texts, at least length_px
void draw_lying_bar(const tools::report::Range& range, const Quantity& quantity, double left_px,
                    double top_px, double length_px, double room_px, tools::report::Svg& svg);

/// The colours alone, upright, along an axis. @param left_px  of the bar
void draw_upright_bar(const tools::report::Axis& y, double left_px, double width_px,
                      tools::report::Svg& svg);

}  // namespace vinerow::study
