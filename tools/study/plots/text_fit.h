#pragma once
/// Texts that must fit a place on a plot.

#include <string>
#include <vector>

namespace vinerow::study {

/// Sizes of texts on plots, px.
inline constexpr double kTick_px = 12.5;
inline constexpr double kLabel_px = 13.0;

/// No less than a text takes in the fonts of the pages, letter by letter.
double widest_px(const std::string& text, double size_px);

/// The text, or as much of its beginning as fits, with "…" behind it; "" where not even that fits.
std::string shortened(const std::string& text, double width_px, double size_px);

/// The text in at most so many lines, broken between words; what does not fit is shortened.
/// @pre most_lines > 0
std::vector<std::string> wrapped(const std::string& text, double width_px, double size_px,
                                 std::size_t most_lines);

}  // namespace vinerow::study
