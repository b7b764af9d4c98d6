#pragma once
/// Mesh of a propeller blade of constant pitch, for display.

#include "vehicles/parts/mesh_builder.h"

namespace vinerow::vehicles {

/// Appends a blade along x of the builder's frame that turns about z, dark with a coloured tip.
/// @param mirror  +1: turns counter-clockwise seen from +z, -1: clockwise
void append_blade(double radius_m, double mirror, unsigned blade_srgb, unsigned tip_srgb,
                  MeshBuilder& builder);

}  // namespace vinerow::vehicles
