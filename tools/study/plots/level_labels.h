#pragma once
/// Labels of levels along an axis, thinned and shortened so that they do not touch.

#include <string>
#include <vector>

#include "tools/report/svg.h"

namespace vinerow::study {

/// Layout of the labels below a plot.
struct LevelLabels {
  std::vector<std::string> texts;  ///< one per level, "" if there is no space
  bool slanted = false;            ///< reads upwards to the right; otherwise horizontal
  double height_px = 0.0;          ///< from the axis down to the lowest letter
};

/// @param pitch_px  > 0, from level to level
/// @param space_px  space to the left of the first level, for slanted labels
LevelLabels fit_level_labels(const std::vector<std::string>& levels, double pitch_px,
                             double space_px);

/// @param first_px  x of the first level @param axis_px  y of the axis
void draw_level_labels(const LevelLabels& labels, double first_px, double pitch_px, double axis_px,
                       tools::report::Svg& svg);

/// Stride of labels that keeps them at least `min_px` apart: 1, 2, 5, 10, ...
/// @pre pitch_px > 0
std::size_t label_stride(double pitch_px, double min_px);

/// Width of the row labels next to a plot, at most `max_px`.
double row_labels_px(const std::vector<std::string>& rows, double max_px);

}  // namespace vinerow::study
