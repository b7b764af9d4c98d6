#pragma once
/// What all plots of a study share: figure, size on the page, axes.

#include <string>

#include "tools/report/axis.h"
#include "tools/report/svg.h"

namespace vinerow::study {

/// Width of a plot that takes half of the page, and of one that takes all of it; px.
inline constexpr double kHalfWidth_px = 640.0;
inline constexpr double kFullWidth_px = 1100.0;

/// Texts around a plot. They are plain text; the plots escape them.
struct PlotTexts {
  std::string title;
  std::string caption;  ///< a sentence or two, or nothing
};

/// An empty picture. It grows and shrinks with the page within the sizes at which its texts are
/// readable, and scrolls where the page is narrower.
tools::report::Svg study_svg(double width_px, double height_px, const std::string& title);

/// <figure> with title, legend, picture and caption.
/// @param legend  entries of legend_key(), or nothing
std::string study_figure(const PlotTexts& texts, const std::string& legend, const std::string& svg,
                         double width_px);

/// The same with a sentence in place of the picture. @param reason  plain text
std::string empty_figure(const PlotTexts& texts, const std::string& reason);

/// A legend's entry of words alone.
std::string legend_words(const std::string& words);

/// Room that an upright axis takes to its left: its ticks' texts and its title.
double upright_axis_px(const tools::report::Axis& y);

/// Grid, ticks and title of an axis at the left of the plot, from x = left_px to right_px.
void draw_upright_axis(const tools::report::Axis& y, double left_px, double right_px,
                       const std::string& title, tools::report::Svg& svg);

/// Ticks and title of an axis below the plot, at y = axis_px.
/// @param grid_to_px  grid lines go up to there; axis_px for none
void draw_level_axis(const tools::report::Axis& x, double axis_px, double grid_to_px,
                     const std::string& title, tools::report::Svg& svg);

/// Title below a plot, and beside it; shortened to the length of their axis.
void draw_title_below(double from_px, double to_px, double baseline_px, const std::string& title,
                      tools::report::Svg& svg);
void draw_title_beside(double from_px, double to_px, const std::string& title,
                       tools::report::Svg& svg);

/// As many ticks as have room along so many pixels. @param wide  whether their texts stand in a row
int ticks_for(double length_px, bool wide);

}  // namespace vinerow::study
