#pragma once
/// Watch for a window of weak wind over the middle of the rows.

#include <deque>

#include "engine/api/forward.h"
#include "engine/api/wind.h"
#include "engine/core/time.h"
#include "engine/scenario/scenario.h"

namespace vinerow {

class WeatherWatch {
 public:
  /// @param world  outlives the watch
  WeatherWatch(const scenario::WeatherWindow& window, const WorldModel& world);

  enum class Verdict { kWait, kGo, kGiveUp };
  /// Called at every instant while its phase waits. Reads the wind once a second: the mean wind
  /// and the gusts, which are common to all vehicles, without turbulence.
  Verdict look(Time now);
  /// Mean speed over the last `over_s`, or over the readings so far if they are fewer, m/s.
  double mean_mps() const;

 private:
  scenario::WeatherWindow window_;
  const Wind& wind_;
  Eigen::Vector2d p_W_;  ///< middle of the rows
  bool began_ = false;
  Time begin_, next_;
  std::deque<double> speeds_mps_;
};

}  // namespace vinerow
