#include "tools/study/plots/level_labels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/study/plots/text_fit.h"

namespace vinerow::study {
namespace {

constexpr double kGap_px = 8.0;
constexpr double kLineHeight_px = 15.0;
/// Maximum length of slanted labels.
constexpr double kLongestSlanted_px = 150.0;
/// Labels up to this width are thinned rather than slanted.
constexpr double kShort_px = 46.0;

}  // namespace

std::size_t label_stride(double pitch_px, double min_px) {
  for (std::size_t power = 1;; power *= 10) {
    for (const std::size_t factor : {1, 2, 5}) {
      if (static_cast<double>(factor * power) * pitch_px >= min_px) return factor * power;
    }
  }
}

double row_labels_px(const std::vector<std::string>& rows, double max_px) {
  double widest = 0.0;
  for (const std::string& row : rows) widest = std::max(widest, widest_px(row, kTick_px));
  return std::min(widest, max_px);
}

LevelLabels fit_level_labels(const std::vector<std::string>& levels, double pitch_px,
                             double space_px) {
  LevelLabels labels;
  labels.texts.resize(levels.size());
  const double widest = row_labels_px(levels, 1e9);
  std::size_t stride = 1;
  if (widest + kGap_px > pitch_px) {
    labels.slanted = widest > kShort_px;
    stride = label_stride(pitch_px,
                          labels.slanted ? kLineHeight_px * std::numbers::sqrt2 : widest + kGap_px);
  }
  double longest = 0.0;
  for (std::size_t i = 0; i < levels.size(); i += stride) {
    // A slanted label ends below its level and starts to the left of it.
    const double available_px =
        (space_px + static_cast<double>(i) * pitch_px - kGap_px) * std::numbers::sqrt2;
    labels.texts[i] =
        labels.slanted ? shortened(levels[i], std::min(kLongestSlanted_px, available_px), kTick_px)
                       : levels[i];
    longest = std::max(longest, widest_px(labels.texts[i], kTick_px));
  }
  labels.height_px = labels.slanted ? 14.0 + longest / std::numbers::sqrt2 : 22.0;
  return labels;
}

void draw_level_labels(const LevelLabels& labels, double first_px, double pitch_px, double axis_px,
                       tools::report::Svg& svg) {
  for (std::size_t i = 0; i < labels.texts.size(); ++i) {
    if (labels.texts[i].empty()) continue;
    const double x = first_px + static_cast<double>(i) * pitch_px;
    svg.line(x, axis_px, x, axis_px + 4, "axis");
    if (labels.slanted) {
      svg.turned_text(x + 4, axis_px + 14, -45, labels.texts[i], "tick end");
    } else {
      svg.text(x, axis_px + 18, labels.texts[i], "tick mid");
    }
  }
}

}  // namespace vinerow::study
