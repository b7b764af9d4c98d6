#pragma once
/// Every constant of the solver, in one place.

#include "engine/core/time.h"

namespace vinerow::physics {

struct PhysicsSettings {
  Duration step{1'000'000};       ///< 1 ms
  double gravity_mps2 = 9.80665;  ///< standard gravity, along -z
  int solver_iterations = 10;
  double contact_breaking_threshold_m = 0.02;
  double linear_slop_m = 0.0;  ///< penetration the solver leaves alone
};

}  // namespace vinerow::physics
