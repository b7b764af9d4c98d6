#pragma once
/// Mesh of the rover's body for display: steel frame, white shell with green panels, battery box,
/// sensor bar, mast with GNSS antenna. The collision hull is in diff_drive_rover.cpp.

#include "engine/api/mesh.h"

namespace vinerow::vehicles {

struct ChassisParams;

/// x forward, y left, z up, origin at B.
TriangleMesh make_rover_mesh(const ChassisParams& params);

}  // namespace vinerow::vehicles
