#pragma once
/// Parameters of controller `four_wheel_steering`, read once.

#include <string>

#include "controllers/four_wheel_steering/drive_profile.h"
#include "controllers/four_wheel_steering/path_reference.h"
#include "controllers/four_wheel_steering/steered_vehicle.h"
#include "controllers/four_wheel_steering/steering_law.h"
#include "controllers/four_wheel_steering/wheel_speeds.h"
#include "controllers/parts/paths/path_watch.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/parameters.h"

namespace vinerow::controllers {

struct FourWheelParams {
  SteeringParams steering;
  bool feed_forward = true;
  PathReferenceParams reference;
  DriveLimits drive;
  WheelSpeedsParams wheels;
  double response_s = 0.03;              ///< lag of the vehicle, in addition to the steering servos
  double wheel_acceleration_mps2 = 0.0;  ///< of each rim; 0: no limit
  double slip_learn_s = 0.4;
  double goal_tolerance_m = 0.05;
  PathWatchParams watch;
  double cycle_s = 0.02;
};

const ParameterTable<FourWheelParams>& four_wheel_table();

/// Also derives values from the vehicle and the cycle. @param who  part name in errors
FourWheelParams read_four_wheel_params(const ParameterSet& parameters, const SteeredDrive& vehicle,
                                       double cycle_s, const std::string& who);

}  // namespace vinerow::controllers
