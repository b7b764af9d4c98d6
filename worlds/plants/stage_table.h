#pragma once
/// Tables over growth stages.

#include <cstddef>
#include <span>

namespace vinerow::worlds {

struct StagePoint {
  double bbch, value;
};

/// Straight lines between points, constant beyond them. @param points  ascending, not empty
inline double interpolate(std::span<const StagePoint> points, double bbch) {
  if (bbch <= points.front().bbch) return points.front().value;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (bbch > points[i].bbch) continue;
    const StagePoint &a = points[i - 1], &b = points[i];
    return a.value + (b.value - a.value) * (bbch - a.bbch) / (b.bbch - a.bbch);
  }
  return points.back().value;
}

}  // namespace vinerow::worlds
