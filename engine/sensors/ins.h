#pragma once
/// Aided inertial unit as a black box (VectorNav VN-200 and the like): position, velocity and
/// attitude of the body with the errors that its data sheet states, and its statement about them.
///
/// Every error has a variance, of which `..._white_share` is fresh at every reading and the rest is
/// a first-order Gauss-Markov process of correlation time `..._time_s`:
///   position  in W, each axis of its own
///   velocity  in W: what is written as v_WB_B is the velocity in W with its error, turned into the
///             body by the attitude that is written, so that X_WB.q * v_WB_B has this error alone
///   attitude  a rotation vector in W, to be applied after the true one: two components level
///             (roll and pitch), one about the vertical (yaw)
/// The angular rate has white noise. Installation is taken to be known to the unit: it speaks of B.
/// Stated: position variances, yaw's standard deviation. In an outage it is silent.
///
/// Paper C (Donati et al., Remote Sensing 2022, table 2) uses such a unit without saying how. Its
/// two readings here: a fix of 1 m white at 100 Hz (`position_white_share: 1`), or a velocity error
/// of 0.05 m/s with 5 s (the defaults).

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec ins_spec();
std::unique_ptr<Sensor> make_ins(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
