#pragma once
/// Fewer points of a line that look the same: no peak is lost.

#include <cstddef>
#include <vector>

namespace vinerow::tools::report {

/// Points of a line in rising x. A y that is not finite is a gap.
struct Samples {
  std::vector<double> x, y;

  std::size_t size() const { return x.size(); }
  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
};

/// At most about `most` points: of each of most / 2 buckets of as many points the lowest and the
/// highest, in their order; the first and the last point of the line; every gap that separates
/// points as one point that is not finite.
Samples decimate(const Samples& line, std::size_t most = 1500);

}  // namespace vinerow::tools::report
