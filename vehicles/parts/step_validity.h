#pragma once
/// Longest physics steps for which parts of vehicles are valid. With longer steps results are
/// wrong: a rover slides down a slope with closed brakes, or a quadrotor crashes in a harmless
/// gust.

#include <fmt/format.h>

#include <string>

#include "engine/core/error.h"
#include "engine/core/time.h"

namespace vinerow::vehicles {

/// Struts and tyres: their forces are evaluated at the start of the step, first order in the step.
/// The stiffest modes of the shipped rovers have 50 rad/s, an eighth of a radian in this step. The
/// error is 3.5 mm after a start and a turn of 2 s.
inline constexpr Duration kMaxWheelStep{2'500'000};
/// Phase of a strut's fastest mode in one step. Semi-implicit steps of 0.5 rad are 1 % too fast;
/// beyond 2 rad they are unstable.
inline constexpr double kMaxStrutAngle_rad = 0.5;
/// Damping over mass times the step: twice the angle above, as for a critically damped mode.
inline constexpr double kMaxStrutDecay = 1.0;
/// Flying bodies: engine/physics/README.md, Envelope.
inline constexpr Duration kMaxFlightStep{10'000'000};

/// @param vehicle  name  @param part  "its wheels"
/// @throws ConfigError "rover: physics.step_s = 0.025 s is too long for its wheels, which are valid
/// to 0.0025 s"
inline void demand_step(Duration step, Duration max_step, const std::string& vehicle,
                        const char* part) {
  if (step.ns <= max_step.ns) return;
  throw ConfigError(
      fmt::format("{}: physics.step_s = {:g} s is too long for {}, which are valid to {:g} s",
                  vehicle, step.s(), part, max_step.s()));
}

}  // namespace vinerow::vehicles
