#pragma once
/// Texts of levels along an axis: as many, and as long, as fit without touching.

#include <string>
#include <vector>

#include "tools/report/svg.h"

namespace vinerow::study {

/// How the texts of levels stand below a plot.
struct LevelLabels {
  std::vector<std::string> texts;  ///< one for each level, "" where there is no room
  bool slanted = false;            ///< reading upwards to the right, else level
  double height_px = 0.0;          ///< from the axis down to the lowest letter
};

/// @param pitch_px  > 0, from level to level
/// @param room_px   to the left of the first level's place, for slanted texts
LevelLabels fit_level_labels(const std::vector<std::string>& levels, double pitch_px,
                             double room_px);

/// @param first_px  x of the first level @param axis_px  y of the axis
void draw_level_labels(const LevelLabels& labels, double first_px, double pitch_px, double axis_px,
                       tools::report::Svg& svg);

/// Every how many levels one has its text, so that texts lie `least_px` apart: 1, 2, 5, 10, ...
/// @pre pitch_px > 0
std::size_t label_stride(double pitch_px, double least_px);

/// Room that the texts of rows take beside a plot, at most `most_px`.
double row_labels_px(const std::vector<std::string>& rows, double most_px);

}  // namespace vinerow::study
