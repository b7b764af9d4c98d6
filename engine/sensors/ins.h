#pragma once
/// Aided inertial unit as a black box (VectorNav VN-200 and similar): position, velocity and
/// attitude of the body with the errors of its data sheet, and the stated uncertainty.
///
/// Every error has a variance, of which `..._white_share` is new at every reading and the rest is a
/// first-order Gauss-Markov process of correlation time `..._time_s`:
///   position  in W, independent for each axis
///   velocity  in W: v_WB_B is the velocity in W with its error, rotated into the body by the
///             attitude of the reading, so that X_WB.q * v_WB_B has this error alone
///   attitude  a rotation vector in W, applied after the true rotation: two level components (roll
///             and pitch), one about the vertical (yaw)
/// The angular rate has white noise. The unit knows its mounting: it reports the state of B.
/// Stated: position variances, standard deviation of yaw. In an outage it sends nothing.
///
/// Paper C (Donati et al., Remote Sensing 2022, table 2) uses such a unit without further details.
/// It has two interpretations here: a fix of 1 m white at 100 Hz (`position_white_share: 1`), or a
/// velocity error of 0.05 m/s with 5 s (the defaults).

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec ins_spec();
std::unique_ptr<Sensor> make_ins(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
