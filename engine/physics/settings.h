#pragma once
/// Every constant of the solver, in one place.

#include "engine/core/time.h"

namespace vinerow::physics {

struct PhysicsSettings {
  Duration step{1'000'000};                    ///< 1 ms
  double gravity_mps2 = 9.80665;               ///< standard gravity, along -z
  int solver_iterations = 10;                  ///< sweeps of the contact solver
  double contact_breaking_threshold_m = 0.02;  ///< contact points are kept up to this gap
  double linear_slop_m = 0.0;                  ///< penetration the solver leaves alone
  double restitution_threshold_mps = 0.2;      ///< slower impacts do not bounce
};

}  // namespace vinerow::physics
