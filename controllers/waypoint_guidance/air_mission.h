#pragma once
/// Mission of a fixed-wing vehicle from the launcher to the ground: a state machine of stages with
/// the wanted course, height and airspeed of each.
///
/// wait -> launch -> (circle up) -> legs -> (circle -> aloft | circle down -> land -> done). Aloft
/// the mission is over and the vehicle continues to circle, because others may still be at work. A
/// vehicle that starts in the air starts on the plan's first leg, at any distance from it; the
/// controller removes the difference.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "controllers/waypoint_guidance/air_state.h"
#include "controllers/waypoint_guidance/flight_legs.h"
#include "controllers/waypoint_guidance/height_reference.h"
#include "controllers/waypoint_guidance/landing_path.h"
#include "controllers/waypoint_guidance/leg_pilot.h"
#include "controllers/waypoint_guidance/loiter_circle.h"
#include "controllers/waypoint_guidance/waypoint_guidance_params.h"
#include "engine/api/messages/flight.h"

namespace vinerow::controllers {

class AirMission {
 public:
  explicit AirMission(const WaypointGuidanceParams& params);

  /// Without it only the height of the ground at the start is known. Before the first tick.
  void see_ground(GroundBelow ground) { ground_ = std::move(ground); }

  /// Before the first tick. Allocates. @param start  the first state known
  void take_plan(FlightLegs plan, const GuidanceState& start);
  bool has_plan() const { return !legs_.empty(); }
  /// Airspeed and ground speed are those of flight.
  bool is_flying(const GuidanceState& state) const;
  /// Starts from the launcher, or from the place in the air.
  void begin(const GuidanceState& state);
  /// One tick after begin(). Allocates sentences only if something has happened.
  void advance(double dt_s, const GuidanceState& state);

  const HeadingGenerator& heading() const { return generator_; }
  const HeightReference& height() const { return height_; }
  AirReference::Phase phase() const;
  bool has_begun() const { return stage_ != Stage::kWait; }
  bool has_power() const { return has_power_; }
  double airspeed_mps() const { return airspeed_mps_; }
  double cross_track_m(const GuidanceState& state) const;
  int waypoint() const;
  double distance_m(const GuidanceState& state) const;
  double length_m() const { return length_m_; }
  /// Event of the last call, "" if none; and whether it is a warning.
  const std::string& event_text() const { return event_text_; }
  bool is_warning() const { return is_warning_; }
  /// Place of the touchdown, once the vehicle is on its way there.
  std::optional<Eigen::Vector2d> touchdown() const;
  /// Why its task has failed, "landed at (1.0, 2.0), 279.8 m from the planned touchdown, at most
  /// 50 m (land_tolerance_m)"; "" if it has not.
  const std::string& failure() const { return failure_; }

 private:
  enum class Stage {
    kWait,
    kLaunch,
    kClimb,
    kTransit,
    kLegs,
    kLoiter,
    kInAir,
    kDescend,
    kLand,
    kDone
  };
  /// Wanted course and height of this tick.
  struct Wanted {
    WantedCourse course;
    double height_m = 0.0;
    double rate_mps = 0.0;
    double climb_max_rad = 0.0;
    double descent_max_rad = 0.0;
  };
  void launch(const GuidanceState& state);
  void join(const GuidanceState& state);
  Wanted hold() const;
  Wanted fly_launch(const GuidanceState& state);
  Wanted fly_climb(const GuidanceState& state);
  Wanted fly_legs(double dt_s, const GuidanceState& state);
  Wanted fly_loiter(double dt_s, const GuidanceState& state);
  Wanted fly_descend(const GuidanceState& state);
  Wanted fly_land(double dt_s, const GuidanceState& state);
  bool is_too_steep(const GuidanceState& state, double share) const;
  void start_transit(const GuidanceState& state);
  void lay_transit(const GuidanceState& state);
  void end_plan(const GuidanceState& state);
  void lay_landing(const GuidanceState& state);
  /// Landing on a course, and its relation to the ground.
  struct Approach {
    double course_rad = 0.0;
    double clearance_m = 1e9;  ///< smallest, of the circle above the ground
    LandingPath path;
    FlightLeg leg;
    LoiterCircle circle;
    /// Penalty of the approach, 0 if it is good.
    double fault = 0.0;
  };
  Approach lay_approach(const Eigen::Vector2d& place, double course_rad) const;
  Approach choose_approach(const GuidanceState& state, const Eigen::Vector2d& place) const;
  bool is_on_final(const GuidanceState& state) const;
  void watch_wind(double dt_s, const GuidanceState& state);
  void report_event(bool is_bad, std::string text);

  WaypointGuidanceParams params_;
  std::vector<FlightLeg> legs_;   // preceded by a path to the plan, if there is one
  std::vector<FlightLeg> final_;  // one leg: the glide
  double length_m_ = 0.0;
  GuidanceState start_;
  GuidanceState launch_;
  Eigen::Vector3d goal_W_ = Eigen::Vector3d::Zero();  // end of the path to the plan
  HeadingGenerator generator_;
  HeightReference height_;
  LegPilot pilot_;
  LoiterCircle circle_;
  GroundBelow ground_;  // of the vehicle's map; empty: unknown
  LandingPath landing_;
  double steepest_fall_ = 0.0;  // of the ground at the landing
  Stage stage_ = Stage::kWait;
  bool has_power_ = false;
  bool is_launched_ = false;          // the launch's height is reached
  bool has_own_first_leg_ = false;    // replaces the plan's, whose first leg leads off the start
  double airspeed_mps_ = 0.0;         // of the reference
  double wanted_airspeed_mps_ = 0.0;  // which airspeed_mps_ approaches at its rate
  double circling_s_ = 0.0;
  double stationary_s_ = 0.0;
  double against_s_ = 0.0;
  bool has_reported_wind_ = false;
  WantedCourse course_;
  std::string event_text_;
  std::string failure_;
  bool is_warning_ = false;
};

}  // namespace vinerow::controllers
