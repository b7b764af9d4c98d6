#pragma once
/// Constants of the physics solver.

#include "engine/core/time.h"

namespace vinerow::physics {

struct PhysicsSettings {
  Duration step{1'000'000};                    ///< 1 ms
  double gravity_mps2 = 9.80665;               ///< standard gravity, along -z
  int solver_iterations = 10;                  ///< sweeps of the contact solver
  double contact_breaking_threshold_m = 0.02;  ///< contact points are kept up to this gap
  double linear_slop_m = 0.0;                  ///< penetration that the solver does not correct
  double restitution_threshold_mps = 0.2;      ///< slower impacts do not bounce
};

}  // namespace vinerow::physics
