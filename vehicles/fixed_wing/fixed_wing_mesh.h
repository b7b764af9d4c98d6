#pragma once
/// Meshes of a flying wing for display: swept wing with fins at the tips, fuselage with hatch and
/// camera window, elevons, pusher propeller. Collision shapes: fixed_wing_shapes.h.

#include "engine/api/mesh.h"
#include "engine/math/pose.h"
#include "vehicles/fixed_wing/fixed_wing_params.h"

namespace vinerow::vehicles {

/// x forward, y left, z up, origin at B.
TriangleMesh make_fixed_wing_body(const FixedWingParams& params);

/// Hinge frame of an elevon: origin at its inner end, y along the hinge line to the left.
/// @param side  +1 left, -1 right
Pose elevon_hinge_X_BE(const FixedWingParams& params, double side);
/// Mesh in the frame of its hinge.
TriangleMesh make_fixed_wing_elevon(const FixedWingParams& params, double side);

/// Middle of the propeller; x forward along its axis.
Eigen::Vector3d propeller_B(const FixedWingParams& params);
/// Origin at its middle, x along its axis.
TriangleMesh make_fixed_wing_propeller(const FixedWingParams& params);

}  // namespace vinerow::vehicles
