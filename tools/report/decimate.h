#pragma once
/// Decimation of a line that keeps every visible peak.

#include <cstddef>
#include <vector>

namespace vinerow::tools::report {

/// Points of a line with increasing x. A y that is not finite is a gap.
struct Samples {
  std::vector<double> x, y;

  std::size_t size() const { return x.size(); }
  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
};

/// Line with at most about `max_points` points. Keeps the lowest and the highest point of each of
/// most / 2 equal buckets, in their order; the first and the last point; and each gap between
/// points as one point that is not finite.
Samples decimate(const Samples& line, std::size_t max_points = 1500);

}  // namespace vinerow::tools::report
