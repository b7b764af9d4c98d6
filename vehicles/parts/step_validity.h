#pragma once
/// Physics steps that parts of vehicles are made for. Beyond them they give nonsense: a rover
/// slides off a slope with its brakes closed, a quadrotor crashes in a gust that it can stand.

#include <fmt/format.h>

#include <string>

#include "engine/core/error.h"
#include "engine/core/time.h"

namespace vinerow::vehicles {

/// Struts and tyres: their forces are those of the step's start, first order in the step. With the
/// stiffest modes of the shipped rovers at 50 rad/s this is an eighth of a radian; 3.5 mm after a
/// start and a turn of 2 s.
inline constexpr Duration kMostWheelStep{2'500'000};
/// Of what a strut's fastest motion turns in a step: semi-implicit steps of 0.5 rad are 1 % too
/// fast, and beyond 2 rad they grow without end.
inline constexpr double kMostStrutAngle_rad = 0.5;
/// Damping over mass times the step: twice the angle above where that is damped critically.
inline constexpr double kMostStrutDecay = 1.0;
/// Bodies in the air: engine/physics/README.md, Envelope.
inline constexpr Duration kMostFlightStep{10'000'000};

/// @param vehicle  name  @param part  "its wheels"
/// @throws ConfigError "rover: physics.step_s = 0.025 s is too long for its wheels, which are valid
/// to 0.0025 s"
inline void demand_step(Duration step, Duration most, const std::string& vehicle,
                        const char* part) {
  if (step.ns <= most.ns) return;
  throw ConfigError(
      fmt::format("{}: physics.step_s = {:g} s is too long for {}, which are valid to {:g} s",
                  vehicle, step.s(), part, most.s()));
}

}  // namespace vinerow::vehicles
