#pragma once
/// Time law of a run: distance as a function of time, as fast as the wanted speeds and the limits
/// allow, from rest to rest.
///
/// Speeds are limited knot by knot (wanted speed, lateral acceleration, yaw rate and acceleration,
/// climb and descent), then forwards and backwards by the tangential acceleration. The distance as
/// a function of time is averaged over `ease_s`, so that the acceleration changes within that time
/// and not at once. Averaging keeps the limits, because each speed limit also applies to the
/// distance flown within half that time.

#include "controllers/trajectory/smooth_run.h"

namespace vinerow::controllers {

/// Limits of the vehicle's motion.
struct TrajectoryLimits {
  double row_speed_mps = 3.0;
  double transit_speed_mps = 2.0;
  double return_speed_mps = 3.0;
  double climb_speed_mps = 1.5;
  double descent_speed_mps = 1.0;
  double landing_speed_mps = 0.3;
  double landing_zone_m = 0.5;             ///< above the plan's end, flown at landing_speed_mps
  double acceleration_mps2 = 1.0;          ///< tangential, both ways
  double lateral_acceleration_mps2 = 1.5;  ///< normal to the path
  double yaw_rate_radps = 1.5;
  double yaw_acceleration_radps2 = 2.5;
  double ease_s = 0.5;
  double blend_m = 0.8;
};

class TimeLaw {
 public:
  /// Allocates. @param slow_from_m  from here on along the run at most landing_speed_mps
  TimeLaw(const SmoothRun& run, const TrajectoryLimits& limits, double slow_from_m);

  double duration_s() const { return spline_.length(); }
  /// Distance along the run, its speed and acceleration. No heap.
  UniformSpline<double>::Sample at(double time_s) const { return spline_.at(time_s); }
  /// Time at which a distance is reached, s.
  double time_of(double distance_m) const;

 private:
  UniformSpline<double> spline_;
};

}  // namespace vinerow::controllers
