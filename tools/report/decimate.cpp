#include "tools/report/decimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vinerow::tools::report {
namespace {

/// Decimates the points [begin, end) of one stretch without gaps.
void add_stretch(const Samples& line, std::size_t begin, std::size_t end, std::size_t buckets,
                 Samples& out) {
  const std::size_t count = end - begin;
  if (count <= 2 * buckets + 2) {
    for (std::size_t i = begin; i < end; ++i) out.add(line.x[i], line.y[i]);
    return;
  }
  out.add(line.x[begin], line.y[begin]);
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    // The two end points are kept separately.
    const std::size_t from = begin + 1 + (count - 2) * bucket / buckets;
    const std::size_t to = begin + 1 + (count - 2) * (bucket + 1) / buckets;
    if (from == to) continue;
    std::size_t low = from, high = from;
    for (std::size_t i = from; i < to; ++i) {
      if (line.y[i] < line.y[low]) low = i;
      if (line.y[i] > line.y[high]) high = i;
    }
    out.add(line.x[std::min(low, high)], line.y[std::min(low, high)]);
    if (low != high) out.add(line.x[std::max(low, high)], line.y[std::max(low, high)]);
  }
  out.add(line.x[end - 1], line.y[end - 1]);
}

}  // namespace

Samples decimate(const Samples& line, std::size_t max_points) {
  const std::size_t count = line.size();
  Samples out;
  for (std::size_t begin = 0; begin < count;) {
    while (begin < count && !std::isfinite(line.y[begin])) ++begin;
    std::size_t end = begin;
    while (end < count && std::isfinite(line.y[end])) ++end;
    if (begin == end) break;
    if (out.size() > 0) out.add(line.x[begin], std::numeric_limits<double>::quiet_NaN());
    const std::size_t buckets = std::max<std::size_t>(1, max_points * (end - begin) / (2 * count));
    add_stretch(line, begin, end, buckets, out);
    begin = end;
  }
  return out;
}

}  // namespace vinerow::tools::report
