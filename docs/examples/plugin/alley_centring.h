#pragma once
/// Keeps a rover in the middle of an alley by what two ultrasonic rangers see to the left and to
/// the right.
///
/// Offset e = (right - left) / 2 is positive when the rover is left of the middle; the wanted turn
/// is yaw rate = -k e - d (de/dt). Without a reading on both sides it drives straight on.

#include <vinerow/api/registry.h>

vinerow::PartSpec alley_centring_spec();
std::unique_ptr<vinerow::Controller> make_alley_centring(const vinerow::ParameterSet& parameters,
                                                         const vinerow::ControllerContext& context);
