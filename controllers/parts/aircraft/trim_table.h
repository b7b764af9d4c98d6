#pragma once
/// Table of trims over airspeed, climb angle and bank, computed once and interpolated in a step.

#include <string>
#include <vector>

#include "controllers/parts/aircraft/flight_trim.h"

namespace vinerow::controllers {

/// Trim between the points of the table.
struct TrimPoint {
  AircraftControls controls;
  double u_mps = 0.0, v_mps = 0.0, w_mps = 0.0;
  double p_radps = 0.0, q_radps = 0.0, r_radps = 0.0;
  double pitch_rad = 0.0, roll_rad = 0.0;
};

class TrimTable {
 public:
  /// Climb angles range from that of the least throttle to that of full throttle, banks up to
  /// `max_bank_rad` to either side, or as far as trims exist. If a bank allows a smaller range of
  /// climb than level wings do, the table holds the nearest trim, at the end of the throttle.
  /// @throws ConfigError "<who>: <why there is no trim in level flight>"
  TrimTable(const Aircraft& aircraft, double airspeed_mps, double max_bank_rad,
            const std::string& who);

  /// Bilinear. Climb angle and bank are clamped to the table, and taken as 0 if not finite.
  /// No heap.
  TrimPoint at(double climb_angle_rad, double bank_rad) const;

  double airspeed_mps() const { return airspeed_mps_; }
  double climb_min_rad() const { return climb_min_rad_; }
  double climb_max_rad() const { return climb_max_rad_; }
  double bank_max_rad() const { return bank_max_rad_; }
  const Trim& level() const { return level_; }

 private:
  double airspeed_mps_ = 0.0;
  double climb_min_rad_ = 0.0, climb_max_rad_ = 0.0, bank_max_rad_ = 0.0;
  int climbs_ = 0, half_banks_ = 0;  // intervals of climb; of bank to one side
  std::vector<TrimPoint> points_;    // climbs_ + 1 x 2 half_banks_ + 1, climbs fastest
  Trim level_;
};

/// Trim tables at several airspeeds about the cruise speed, kSpeedStep_mps apart.
class TrimTables {
 public:
  static constexpr double kSpeedStep_mps = 1.0;

  /// Airspeeds at which level flight is possible, from the cruise speed down to `min_mps` and up to
  /// `max_mps`. @throws ConfigError as TrimTable does at the cruise speed
  TrimTables(const Aircraft& aircraft, double min_mps, double max_mps, double max_bank_rad,
             const std::string& who);

  /// Linear in the airspeed, which is clamped to the tables; exactly the table's trim at the cruise
  /// speed. No heap.
  TrimPoint at(double airspeed_mps, double climb_angle_rad, double bank_rad) const;
  /// The airspeed clamped to the tables; the cruise speed if it is not given (0, NaN).
  double within(double airspeed_mps) const;

  double min_mps() const { return tables_.front().airspeed_mps(); }
  double max_mps() const { return tables_.back().airspeed_mps(); }
  /// At the cruise speed.
  const TrimTable& cruise() const { return tables_[cruise_]; }

 private:
  std::vector<TrimTable> tables_;  // airspeed rises by kSpeedStep_mps
  std::size_t cruise_ = 0;
};

}  // namespace vinerow::controllers
