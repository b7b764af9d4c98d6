#pragma once
/// The parameters that every wheeled vehicle offers in scenario files, with units, ranges and
/// defaults.

#include <vector>

#include "engine/api/parameters.h"
#include "vehicles/parts/battery.h"
#include "vehicles/parts/wheel.h"

namespace vinerow::vehicles {

/// Motor, brake, tyre and battery. A vehicle appends them to its own specs.
/// @param motor  the defaults
std::vector<ParameterSpec> drive_parameter_specs(const MotorParams& motor, const TyreParams& tyre,
                                                 const BatteryParams& battery);

MotorParams read_motor_params(const ParameterSet& parameters);
TyreParams read_tyre_params(const ParameterSet& parameters);
BatteryParams read_battery_params(const ParameterSet& parameters);

/// The track that a four-wheeled skid-steered vehicle seems to have, because its wheels slide
/// sideways in a turn: yaw rate = (v_right - v_left) / effective track. Derivations in
/// vehicles/parts/README.md.

/// Sliding wheels: B + L^2 / B. Exact on the spot on any soil; within 8 % up to a radius of about
/// seven wheel bases. What vehicles tell as "effective_track_m".
double calc_effective_track_m(double track_m, double wheel_base_m);

/// Wheels of small slip, in turns of more than about fifty wheel bases: B (1 + (c_y / c_x)(L /
/// B)^2).
double calc_small_slip_track_m(double track_m, double wheel_base_m, const Soil& soil);

}  // namespace vinerow::vehicles
