#pragma once
/// Simplification of lines for drawing.
///
/// Source: Douglas, Peucker, "Algorithms for the reduction of the number of points required to
/// represent a digitized line or its caricature", Cartographica 10 (1973).

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/math/polyline.h"

namespace vinerow::tools {

/// Line without points that are within a tolerance of it. The first and the last point stay.
/// @param line  points in the plane or in space
template <class Point>
std::vector<Point> simplify_line(const std::vector<Point>& line, double tolerance) {
  if (line.size() < 3) return line;
  std::vector<char> stays(line.size(), 0);
  stays.front() = stays.back() = 1;
  // A list of stretches replaces recursion: plans may have a hundred thousand points.
  std::vector<std::pair<std::size_t, std::size_t>> stretches = {{0, line.size() - 1}};
  while (!stretches.empty()) {
    const auto [begin, end] = stretches.back();
    stretches.pop_back();
    double farthest = tolerance;
    std::size_t at = begin;
    for (std::size_t i = begin + 1; i < end; ++i) {
      const double away =
          distance_to_segment_m<Point::RowsAtCompileTime>(line[i], line[begin], line[end]);
      if (away <= farthest) continue;
      farthest = away;
      at = i;
    }
    if (at == begin) continue;
    stays[at] = 1;
    stretches.push_back({begin, at});
    stretches.push_back({at, end});
  }
  std::vector<Point> kept;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (stays[i]) kept.push_back(line[i]);
  }
  return kept;
}

}  // namespace vinerow::tools
