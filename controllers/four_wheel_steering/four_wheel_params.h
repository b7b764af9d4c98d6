#pragma once
/// Parameters of controller `four_wheel_steering`, read once.

#include <vector>

#include "controllers/four_wheel_steering/drive_profile.h"
#include "controllers/four_wheel_steering/path_reference.h"
#include "controllers/four_wheel_steering/steered_vehicle.h"
#include "controllers/four_wheel_steering/steering_law.h"
#include "controllers/four_wheel_steering/wheel_speeds.h"
#include "engine/api/parameters.h"

namespace vinerow {

struct FourWheelParams {
  SteeringParams steering;
  bool feed_forward = true;
  PathReferenceParams reference;
  DriveLimits drive;
  WheelSpeedsParams wheels;
  double slip_learn_s = 0.0;
  double goal_tolerance_m = 0.05;
  double cycle_s = 0.02;
};

std::vector<ParameterSpec> four_wheel_parameters();

FourWheelParams read_four_wheel_params(const ParameterSet& parameters,
                                       const SteeredDrive& vehicle, double cycle_s);

}  // namespace vinerow
