#pragma once
/// Common elements of all plots of a study: figure, size on the page, axes.

#include <string>

#include "tools/report/axis.h"
#include "tools/report/svg.h"

namespace vinerow::study {

/// Width of a plot that takes half of the page, and of one that takes the full width; px.
inline constexpr double kHalfWidth_px = 640.0;
inline constexpr double kFullWidth_px = 1100.0;

/// Texts around a plot. They are plain text; the plots escape them.
struct PlotTexts {
  std::string title;
  std::string caption;  ///< one or two sentences, or empty
};

/// Empty picture. It scales with the page within the sizes at which its texts are readable, and
/// scrolls if the page is narrower.
tools::report::Svg study_svg(double width_px, double height_px, const std::string& title);

/// <figure> with title, legend, picture and caption.
/// @param legend  entries of legend_key(), or empty
std::string study_figure(const PlotTexts& texts, const std::string& legend, const std::string& svg,
                         double width_px);

/// The same with a sentence instead of the picture. @param reason  plain text
std::string empty_figure(const PlotTexts& texts, const std::string& reason);

/// Legend entry without a mark.
std::string legend_words(const std::string& words);

/// Space that a vertical axis takes to its left for tick labels and title, px.
double upright_axis_px(const tools::report::Axis& y);

/// Draws grid, ticks and title of an axis at the left of the plot, from x = left_px to right_px.
void draw_upright_axis(const tools::report::Axis& y, double left_px, double right_px,
                       const std::string& title, tools::report::Svg& svg);

/// Draws ticks and title of an axis below the plot, at y = axis_px.
/// @param grid_to_px  upper end of the grid lines; axis_px: none
void draw_level_axis(const tools::report::Axis& x, double axis_px, double grid_to_px,
                     const std::string& title, tools::report::Svg& svg);

/// Titles below and at the side of a plot, shortened to the length of their axis.
void draw_title_below(double from_px, double to_px, double baseline_px, const std::string& title,
                      tools::report::Svg& svg);
void draw_title_left(double from_px, double to_px, const std::string& title,
                     tools::report::Svg& svg);

/// Number of ticks that fit along a length. @param wide  whether their labels are in one line
int ticks_for(double length_px, bool wide);

}  // namespace vinerow::study
