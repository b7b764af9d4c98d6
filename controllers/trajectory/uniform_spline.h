#pragma once
/// Cubic B-spline over evenly spaced knots. The control points are its smoothed values: the curve
/// starts in the first and ends in the last, reproduces straights exactly, and its second
/// derivative is continuous.

#include <algorithm>
#include <vector>

namespace vinerow::controllers {

template <class T>
class UniformSpline {
 public:
  struct Sample {
    T value, first, second;  ///< with respect to the parameter
  };

  UniformSpline() = default;
  /// @param points  >= 2, at 0, step, 2 step ..; allocates
  UniformSpline(double step, const std::vector<T>& points) : step_(step) {
    points_.reserve(points.size() + 2);
    points_.push_back(2.0 * points[0] - points[1]);
    points_.insert(points_.end(), points.begin(), points.end());
    points_.push_back(2.0 * points.back() - points[points.size() - 2]);
  }

  /// Number of pieces between knots.
  int pieces() const { return static_cast<int>(points_.size()) - 3; }
  double step() const { return step_; }
  double length() const { return pieces() * step_; }
  int piece_at(double u) const {
    return std::min(static_cast<int>(std::clamp(u, 0.0, length()) / step_), pieces() - 1);
  }

  /// Clamped to [0, length()]. No heap.
  Sample at(double u) const {
    const int i = piece_at(u);
    const double x = std::clamp(u / step_ - i, 0.0, 1.0), y = 1.0 - x;
    const T &a = points_[i], &b = points_[i + 1], &c = points_[i + 2], &d = points_[i + 3];
    Sample sample;
    sample.value = (y * y * y * a + (3.0 * x * x * x - 6.0 * x * x + 4.0) * b +
                    (3.0 * y * y * y - 6.0 * y * y + 4.0) * c + x * x * x * d) /
                   6.0;
    sample.first =
        (-y * y * a + (3.0 * x * x - 4.0 * x) * b + (4.0 * y - 3.0 * y * y) * c + x * x * d) /
        (2.0 * step_);
    sample.second = (y * a + (3.0 * x - 2.0) * b + (3.0 * y - 2.0) * c + x * d) / (step_ * step_);
    return sample;
  }

 private:
  double step_ = 1.0;
  std::vector<T> points_;
};

}  // namespace vinerow::controllers
