#pragma once
/// Guidance along legs: straight, turn, straight (paper A, 2.1, the three phases of its figure 7).
///
/// Straight, law `smooth`: chi - atan(e / length) with e left of the leg; its rate of change is fed
/// forward. Law `paper`: the bearing to the next waypoint if |e| is beyond the tolerance of eq. 3,
/// else the leg's course. A turn starts when it would lead onto the next leg: `predicted` simulates
/// it in the mean wind, `formula` is the tangent fly-by of the reference,
/// L - s <= R tan(|dchi| / 2) + V (phi_max / (2 phi_rate) + lags). It ends when the vehicle's
/// course is within 5 deg of the leg's.
///
/// Angles positive to the left, courses over ground. No heap.

#include <vector>

#include "controllers/waypoint_guidance/air_state.h"
#include "controllers/waypoint_guidance/flight_legs.h"
#include "controllers/waypoint_guidance/heading_generator.h"

namespace vinerow::controllers {

struct LegPilotOptions {
  bool is_smooth = true;
  bool is_predicted = true;
  double cross_track_length_m = 15.0;
  double tolerance_max_m = 4.0;  ///< eps_0 of eq. 3
  double tolerance_min_m = 1.0;  ///< eps_min
  double turn_end_rad = 0.0873;
};

class LegPilot {
 public:
  LegPilot() = default;
  explicit LegPilot(const LegPilotOptions& options) : options_(options) {}

  /// Starts on a leg. @param heading_rad  of the reference: the leg's course becomes the angle
  /// nearest to it  @param turns  whether it has to turn onto the leg first
  void start(const std::vector<FlightLeg>& legs, std::size_t leg, const GuidanceState& state,
             double heading_rad, bool turns);
  /// The leg has been replaced, e.g. by one from the vehicle's present position.
  void aim(const LegFrame& frame);
  /// Takes the next leg when its turn starts, then evaluates the law.
  WantedCourse advance(const std::vector<FlightLeg>& legs, const GuidanceState& state,
                       const HeadingGenerator& generator, double dt_s);

  std::size_t leg() const { return leg_; }
  bool is_turning() const { return is_turning_; }
  /// The last leg has been flown to its end.
  bool has_ended() const { return has_ended_; }
  /// Position on the present leg's ramp, m; negative: still on that of earlier legs.
  double ramp_along_m() const { return ramp_along_m_; }
  double ramp_speed_mps() const { return ramp_speed_mps_; }

 private:
  bool is_time_to_turn(const std::vector<FlightLeg>& legs, const GuidanceState& state,
                       const HeadingGenerator& generator, double dt_s) const;
  void take_next(const std::vector<FlightLeg>& legs, const GuidanceState& state,
                 const HeadingGenerator& generator);
  void watch_turn(const FlightLeg& leg, const GuidanceState& state,
                  const HeadingGenerator& generator, double dt_s);
  WantedCourse query_law(const LegFrame& frame, const GuidanceState& state) const;

  LegPilotOptions options_;
  std::size_t leg_ = 0;
  bool is_turning_ = false;
  bool has_ended_ = false;
  double course_rad_ = 0.0;  // of the leg, not wrapped
  double turned_s_ = 0.0;    // since the reference has turned, while the vehicle has not
  // The turn's ramp: between these distances while the reference turns by turn_angle_rad_.
  double turn_from_m_ = 0.0;
  double turn_to_m_ = 0.0;
  double turn_angle_rad_ = 0.0;
  double ramp_along_m_ = 0.0;
  double ramp_speed_mps_ = 0.0;
};

/// Distance before the waypoint at which the tangent fly-by of the reference starts.
double calc_fly_by_m(const TurnLimits& limits, double corner_rad, double ground_speed_mps,
                     double airspeed_mps);

}  // namespace vinerow::controllers
