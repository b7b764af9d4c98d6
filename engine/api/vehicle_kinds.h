#pragma once
/// Capabilities of a vehicle as typed records: wheels, steered axles, rotors, wings. A vehicle
/// fills each record that applies to it completely; controllers, guidance, planners and metrics
/// read them.
///
/// Names carry the units. Positions are in B (x forward, y left, z up, origin at the centre of
/// mass). An unknown number stays 0 if its comment allows that. find_fault() of vehicle_check.h
/// reports what is missing or impossible.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "engine/api/flight_model.h"

namespace vinerow {

/// One driven wheel.
struct WheelPlace {
  int actuator = 0;              ///< index of its speed in the vehicle's actuators
  Eigen::Vector2d p_B = {0, 0};  ///< hub, m
};

/// Vehicle on wheels with commanded speeds ("wheel_fl_speed_radps").
struct WheeledVehicle {
  double track_m = 0.0;         ///< between the centres of left and right wheels
  double wheel_base_m = 0.0;    ///< between the first and the last axle
  double wheel_radius_m = 0.0;  ///< rim speed = radius * wheel speed
  double wheel_speed_limit_radps = 0.0;
  /// For skid steering: the track of the ideal vehicle that turns as this one does, yaw rate =
  /// (v_right - v_left) / effective track. Lateral wheel slip makes it wider than the track. 0:
  /// unknown.
  double effective_track_m = 0.0;
  std::vector<WheelPlace> wheels = {};  ///< driven ones. Empty: places unknown
};

/// Vehicle with two steered axles ("axle_front_steer_rad", "axle_rear_steer_rad"), each modelled as
/// one wheel in the middle of the axle; angles are positive to the left. Requires WheeledVehicle.
struct SteeredVehicle {
  double front_axle_m = 0.0;        ///< ahead of B's origin
  double rear_axle_m = 0.0;         ///< behind B's origin, positive
  double max_axle_steer_rad = 0.0;  ///< to either side
  double steer_rate_radps = 0.0;    ///< maximum rate of the servos
  double steer_lag_s = 0.0;         ///< first-order lag of the servos; 0: none
};

/// Vehicle that steers by its front wheels as a car does ("axle_front_steer_rad", of one wheel in
/// the middle of the axle, positive to the left); the rear axle is fixed. Requires WheeledVehicle.
struct AckermannVehicle {
  double rear_axle_m = 0.0;         ///< behind B's origin, positive
  double max_axle_steer_rad = 0.0;  ///< to either side
  double steer_rate_radps = 0.0;    ///< maximum rate of the servo
  double steer_lag_s = 0.0;         ///< first-order lag of the servo; 0: none
};

/// One rotor; its thrust is along +z of B.
struct RotorPlace {
  Eigen::Vector2d p_B = {0, 0};  ///< hub, m
  double torque_sign = 1.0;      ///< +1: its drag torque turns the body to the left (+z)
};

/// Vehicle that flies on rotors with thrust along +z of B ("rotor_1_speed_radps", ...).
struct Rotorcraft {
  std::vector<RotorPlace> rotors;  ///< in the order of their actuators
  /// Moments of inertia of the vehicle about B's axes.
  Eigen::Vector3d inertia_kgm2 = Eigen::Vector3d::Zero();
  double thrust_coefficient_Ns2 = 0.0;   ///< k_F of one rotor, thrust = k_F w^2
  double torque_coefficient_Nms2 = 0.0;  ///< k_M of one rotor, drag torque = k_M w^2
  double min_rotor_radps = 0.0;
  double max_rotor_radps = 0.0;
  double rotor_lag_s = 0.0;  ///< first-order lag of a rotor's speed
  /// Of one rotor about its axis. A rotor that spins up exerts a torque on the body in the
  /// direction of its drag torque. 0: unknown, treated as none.
  double rotor_inertia_kgm2 = 0.0;
  double rotor_drag_Ns_per_m = 0.0;  ///< all rotors together: force = - this * air velocity
  double rotor_radius_m = 0.0;
  /// Radius of the circle about B's z axis that contains every rotor disc. 0: unknown, the outline
  /// counts.
  double tip_radius_m = 0.0;
  double max_tilt_rad = 0.0;             ///< operating limit
  double landing_speed_limit_mps = 0.0;  ///< touching the ground faster than this is a crash
};

/// Flies on wings, driven by a propeller and steered by two elevons ("throttle",
/// "elevon_left_rad", "elevon_right_rad").
struct FixedWingAircraft {
  /// Flight mechanics according to the manufacturer. Never null.
  std::shared_ptr<const FlightModel> flight_model;
  double span_m = 0.0;
  double wing_area_m2 = 0.0;            ///< 0: not known
  double air_density_kgm3 = 1.225;      ///< for which trims are computed
  double cruise_speed_mps = 0.0;        ///< through the air
  double stall_speed_mps = 0.0;         ///< in level flight, through the air
  double max_bank_rad = 0.0;            ///< operating limit
  double throttle_lag_s = 0.0;          ///< first-order lag of the propeller's speed
  double elevon_lag_s = 0.0;            ///< first-order lag of an elevon
  double launch_throttle = 0.0;         ///< a throttle above this launches it
  double landing_sink_limit_mps = 0.0;  ///< touching the ground faster than this is a crash
  double belly_height_m = 0.0;          ///< of B's origin above the lowest point of the hull
  /// Height of B's origin above the ground before its launch. Absent: it stands on the ground.
  std::optional<double> start_height_m;
};

}  // namespace vinerow
