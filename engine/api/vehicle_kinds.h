#pragma once
/// What a vehicle can do, as typed records: wheels, steered axles, rotors, wings. A vehicle fills
/// the records of what it has, whole; controllers, guidance, planners and metrics read them.
///
/// Units stand in the names. Places are in B (x forward, y left, z up, origin at the centre of
/// mass). A number that is not known stays 0 where its comment allows that; find_fault() of
/// vehicle_check.h says what is missing or cannot be.

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "engine/api/flight_model.h"

namespace vinerow {

/// Stands on wheels whose speeds are commanded ("wheel_fl_speed_radps").
struct WheeledVehicle {
  double track_m = 0.0;         ///< between the centres of left and right wheels
  double wheel_base_m = 0.0;    ///< between the first and the last axle
  double wheel_radius_m = 0.0;  ///< rim speed = radius * wheel speed
  double wheel_speed_limit_radps = 0.0;
  /// Of what steers by speed difference: the track of the ideal vehicle that turns as this one
  /// does, yaw rate = (v_right - v_left) / effective track. Wheels that slide sideways make it
  /// wider than the track. 0: not known.
  double effective_track_m = 0.0;
};

/// Has two axles that steer ("axle_front_steer_rad", "axle_rear_steer_rad"), counted as one wheel
/// in the middle of each; angles are positive to the left. Comes with WheeledVehicle.
struct SteeredVehicle {
  double front_axle_m = 0.0;        ///< ahead of B's origin
  double rear_axle_m = 0.0;         ///< behind B's origin, positive
  double max_axle_steer_rad = 0.0;  ///< to either side
  double steer_rate_radps = 0.0;    ///< of the servos, most
  double steer_lag_s = 0.0;         ///< first-order lag of the servos; 0: none
};

/// Steers by its front wheels as a car does ("axle_front_steer_rad", of one wheel in the middle of
/// the axle, positive to the left); the rear axle is fixed. Comes with WheeledVehicle.
struct AckermannVehicle {
  double rear_axle_m = 0.0;         ///< behind B's origin, positive
  double max_axle_steer_rad = 0.0;  ///< to either side
  double steer_rate_radps = 0.0;    ///< of the servo, most
  double steer_lag_s = 0.0;         ///< first-order lag of the servo; 0: none
};

/// One rotor; its thrust is along +z of B.
struct RotorPlace {
  Eigen::Vector2d p_B = {0, 0};  ///< hub, m
  double torque_sign = 1.0;      ///< +1: its drag torque turns the body to the left (+z)
};

/// Flies on rotors that all push along +z of B ("rotor_1_speed_radps", ...).
struct Rotorcraft {
  std::vector<RotorPlace> rotors;  ///< in the order of their actuators
  /// Of the vehicle about B's axes.
  Eigen::Vector3d inertia_kgm2 = Eigen::Vector3d::Zero();
  double thrust_coefficient_Ns2 = 0.0;   ///< k_F of one rotor, thrust = k_F w^2
  double torque_coefficient_Nms2 = 0.0;  ///< k_M of one rotor, drag torque = k_M w^2
  double min_rotor_radps = 0.0;
  double max_rotor_radps = 0.0;
  double rotor_lag_s = 0.0;  ///< first-order lag of a rotor's speed
  /// Of one rotor about its axis. A rotor that is spun up pushes the body the way its drag does.
  /// 0: not known, taken for none.
  double rotor_inertia_kgm2 = 0.0;
  double rotor_drag_Ns_per_m = 0.0;  ///< all rotors together: force = - this * air velocity
  double rotor_radius_m = 0.0;
  /// Of the circle about B's z axis that holds every rotor's disc. 0: not known, the outline
  /// counts.
  double tip_radius_m = 0.0;
  double max_tilt_rad = 0.0;             ///< to be flown at most
  double landing_speed_limit_mps = 0.0;  ///< touching the ground faster than this is a crash
};

/// Flies on wings, driven by a propeller and steered by two elevons ("throttle",
/// "elevon_left_rad", "elevon_right_rad").
struct FixedWingAircraft {
  /// Its flight mechanics as its maker knows them. Never null.
  std::shared_ptr<const FlightModel> flight_model;
  double span_m = 0.0;
  double wing_area_m2 = 0.0;            ///< 0: not known
  double air_density_kgm3 = 1.225;      ///< that trims are worked out for
  double cruise_speed_mps = 0.0;        ///< through the air
  double stall_speed_mps = 0.0;         ///< in level flight, through the air
  double max_bank_rad = 0.0;            ///< to be flown at most
  double throttle_lag_s = 0.0;          ///< first-order lag of the propeller's speed
  double elevon_lag_s = 0.0;            ///< first-order lag of an elevon
  double launch_throttle = 0.0;         ///< a throttle above this launches it
  double landing_sink_limit_mps = 0.0;  ///< touching the ground faster than this is a crash
  double belly_height_m = 0.0;          ///< of B's origin above the lowest point of the hull
  /// Of B's origin above the ground where it waits for its launch. Absent: as it stands.
  std::optional<double> start_height_m;
};

}  // namespace vinerow
