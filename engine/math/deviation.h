#pragma once
/// Deviation of a driven track from a planned polyline: mean, maximum and number of oscillations.
///
/// Source: Martelli, Mocera, Soma, "Autonomous Driving Strategy for a Specialized Four-Wheel
/// Differential-Drive Agricultural Rover", AgriEngineering 6(3), 2024, section 3: average
/// trajectory deviation (ATD), oscillating factor (OF), relative accuracy RA = 1/(ATD OF) (eq. 8).
/// The paper leaves some definitions open. Here the deviation is the distance to the waypoint
/// polyline (not to the nearest waypoint). OF counts the local maxima of the whole mission's
/// deviation curve as MATLAB's findpeaks does (a plateau once, the ends never), with a minimum
/// prominence of 1e-6 m so that rounding on straight rows is not counted.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/math/polyline.h"

namespace vinerow {

/// Online counter of the local maxima of a curve; it does not store the curve.
///
/// A maximum counts if the curve rose by at least `min_prominence` before it and falls by as much
/// after it, relative to the lowest values between it and the next maximum that counts: the peaks
/// that MATLAB's findpeaks(y, 'MinPeakProminence', min_prominence) returns. With 0: every strict
/// local maximum, a plateau once. The first and the last value are never maxima.
class PeakCounter {
 public:
  explicit PeakCounter(double min_prominence = 1e-6) : min_prominence_(min_prominence) {}
  void add(double value);
  std::int64_t count() const { return count_; }

 private:
  double min_prominence_;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = 0.0;
  bool rising_ = false;
  std::int64_t count_ = 0;
};

/// Online ATD, OF and RA of a series of distances. Memory does not grow with the mission.
class DeviationStatistics {
 public:
  static constexpr double kMinProminence_m = 1e-6;

  explicit DeviationStatistics(double min_prominence_m = kMinProminence_m)
      : peaks_(min_prominence_m) {}

  /// @param distance_m  from the path, not negative
  void add(double distance_m);

  std::int64_t samples() const { return samples_; }
  double average_m() const;  ///< ATD; NaN without samples
  double max_m() const { return max_m_; }
  std::int64_t oscillations() const { return peaks_.count(); }
  /// 1/(ATD OF), 1/m; NaN if either is zero.
  double relative_accuracy_per_m() const;

 private:
  PeakCounter peaks_;
  std::int64_t samples_ = 0;
  double sum_m_ = 0.0;
  double max_m_ = 0.0;
};

/// Deviation statistics of a track in the plane.
class DeviationMeter : public DeviationStatistics {
 public:
  explicit DeviationMeter(std::vector<Eigen::Vector2d> path,
                          double min_prominence_m = kMinProminence_m)
      : DeviationStatistics(min_prominence_m), path_(std::move(path)) {}

  /// @param p  true position in the plane, m
  /// @returns nearest place on the path
  Polyline::Nearest add(const Eigen::Vector2d& p);

  const Polyline& path() const { return path_; }

 private:
  Polyline path_;
  int segment_ = 0;
};

}  // namespace vinerow
