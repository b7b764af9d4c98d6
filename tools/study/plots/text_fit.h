#pragma once
/// Fitting of texts to the space on a plot.

#include <string>
#include <vector>

namespace vinerow::study {

/// Font sizes on plots, px.
inline constexpr double kTick_px = 12.5;
inline constexpr double kLabel_px = 13.0;

/// Upper bound of a text's width in the fonts of the pages, px.
double widest_px(const std::string& text, double size_px);

/// The text, or as much of its start as fits, followed by "…"; "" if not even that fits.
std::string shortened(const std::string& text, double width_px, double size_px);

/// The text in at most `max_lines` lines, broken between words; the rest is shortened.
/// @pre max_lines > 0
std::vector<std::string> wrapped(const std::string& text, double width_px, double size_px,
                                 std::size_t max_lines);

}  // namespace vinerow::study
