#pragma once
/// Collision shapes of a flying wing (fuselage, wings and fins) for physics, canopy and outline,
/// and the rule by which contacts wreck it. The propeller folds away.

#include <string>

#include "engine/api/vehicle.h"
#include "engine/physics/physics_world.h"
#include "vehicles/fixed_wing/fixed_wing_params.h"
#include "vehicles/parts/foliage_watch.h"

namespace vinerow::vehicles {

/// Section of a half wing.
struct WingStation {
  Eigen::Vector3d leading_B;  ///< leading edge
  double chord_m = 0.0;       ///< straight back from the leading edge
};

/// @param share  of the half span, 0 root to 1 tip  @param side  +1 left, -1 right
WingStation wing_station(const FixedWingParams& params, double share, double side);

/// Thickness over chord of wing and fins.
constexpr double kWingThickness = 0.10;
/// Foremost point of the nose ahead of the root's leading edge, in root chords.
constexpr double kNose = 0.20;
/// Half width of the fuselage in root chords.
constexpr double kHalfWidth = 0.15;

std::vector<physics::PlacedShape> make_fixed_wing_shapes(const FixedWingParams& params);
FoliageWatch make_foliage_watch(const FixedWingParams& params);
/// Collision box and footprint, seen from above.
void describe_outline(const FixedWingParams& params, VehicleDescription& description);

/// @param before  state at the start of the step whose contacts are judged
/// @returns the reason for a wreck, e.g. "hit the ground with its nose, sinking at 4.1 m/s"; empty
/// without a wreck, and then no heap
std::string judge_fixed_wing(const physics::PhysicsWorld& world, physics::BodyId body,
                             const physics::BodyState& before, const FixedWingParams& params);

}  // namespace vinerow::vehicles
