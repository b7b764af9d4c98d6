#pragma once
/// Drawable propeller blade of constant pitch.

#include "vehicles/parts/mesh_builder.h"

namespace vinerow::vehicles {

/// A blade along x of the builder's frame, turning about z; dark with a coloured tip.
/// @param mirror  +1: counter-clockwise seen from +z, -1: the other way
void append_blade(double radius_m, double mirror, unsigned blade_srgb, unsigned tip_srgb,
                  MeshBuilder& builder);

}  // namespace vinerow::vehicles
