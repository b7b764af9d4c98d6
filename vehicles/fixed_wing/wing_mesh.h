#pragma once
/// Meshes of wing, elevons and fins for display: lofted four-digit sections with a little reflex.

#include "vehicles/fixed_wing/fixed_wing_params.h"
#include "vehicles/parts/mesh_builder.h"

namespace vinerow::vehicles {

// The aircraft's paint.
constexpr unsigned kPaintWhite = 0xf3f4f0, kPaintOrange = 0xe8641b, kPaintDark = 0x22262b;
constexpr unsigned kPaintGrey = 0x8f969c;

/// A half wing in B, without its elevon. @param side  +1 left, -1 right
void append_half_wing(const FixedWingParams& params, double side, MeshBuilder& builder);
/// Its elevon in the builder's frame. @param X_BE  the hinge in B
void append_elevon(const FixedWingParams& params, double side, const Pose& X_BE,
                   MeshBuilder& builder);
/// The fin at its tip, in B.
void append_fin(const FixedWingParams& params, double side, MeshBuilder& builder);

}  // namespace vinerow::vehicles
