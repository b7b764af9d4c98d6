#pragma once
/// 1-cosine gusts of a world: those of its list, and those that come by chance.

#include <Eigen/Core>

#include "engine/api/wind.h"
#include "engine/core/random.h"
#include "engine/core/time.h"

namespace vinerow::vehicles {

/// Unit vector to which a wind from this azimuth (clockwise from north) blows; x east, y north.
Eigen::Vector2d downwind_direction(double from_azimuth_rad);

/// Pulse (1 - cos(2 pi t / duration)) / 2 of a gust, 0 to 1; 0 outside. A gust with a front is
/// late by the way from W's origin along its direction.
double gust_pulse(const WindGust& gust, double time_s, const Eigen::Vector2d& p_W);

/// Its wind in W, m/s.
Eigen::Vector3d calc_gust_W(const WindGust& gust, double time_s, const Eigen::Vector2d& p_W);

/// Gusts by chance, one after the other: after each the air rests for a time that is
/// exponentially distributed with mean interval - duration, so that they come once per interval on
/// average and never overlap. Direction uniform, amplitude and duration as the world says.
/// The schedule follows from the world's seed alone: every probe makes the same one, piece by
/// piece, however long the run. No heap.
class RandomGusts {
 public:
  /// @param wind  random_gust_interval_s == 0: none, else > random_gust_duration_s
  explicit RandomGusts(const Wind& wind);

  /// The gust that is on or comes next. @param time_s  never running back. Meaningless where
  /// the world has none.
  const WindGust& at(double time_s);
  bool none() const { return interval_s_ <= 0.0; }

 private:
  void draw_next();

  double interval_s_;
  RandomStream random_;
  WindGust gust_;
};

}  // namespace vinerow::vehicles
