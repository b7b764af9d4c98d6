#pragma once
/// Detector of the touchdown: the vehicle is stationary although the reference sinks.

namespace vinerow::controllers {

class LandingWatch {
 public:
  struct Params {
    double landing_speed_mps = 0.3;
    double stationary_s = 0.5;  ///< required duration without motion
    double zone_m = 1.0;        ///< largest height above the plan's end
    double give_up_s = 2.0;     ///< stationary anywhere for this long after the reference's end
  };
  LandingWatch() = default;
  explicit LandingWatch(const Params& params) : params_(params) {}

  struct Observation {
    double wanted_mps = 0.0;    ///< vertical speed of the reference
    double vertical_mps = 0.0;  ///< of the vehicle
    double above_end_m = 0.0;   ///< of the vehicle above the plan's end
    bool is_over = false;       ///< the reference has ended
  };
  /// @returns true once the vehicle has landed
  bool has_landed(const Observation& observation, double dt_s) {
    constexpr double kStationaryShare = 0.25;  // of the landing speed
    const bool stands = observation.vertical_mps > -kStationaryShare * params_.landing_speed_mps &&
                        observation.vertical_mps < params_.landing_speed_mps;
    const bool should_sink = observation.wanted_mps < -0.5 * params_.landing_speed_mps;
    const bool counts = stands && should_sink && observation.above_end_m < params_.zone_m;
    stood_s_ = counts ? stood_s_ + dt_s : 0.0;
    over_s_ = stands && observation.is_over ? over_s_ + dt_s : 0.0;
    return stood_s_ >= params_.stationary_s || over_s_ >= params_.give_up_s;
  }

 private:
  Params params_;
  double stood_s_ = 0.0;
  double over_s_ = 0.0;
};

}  // namespace vinerow::controllers
