#pragma once
/// The track that a four-wheeled skid-steered vehicle seems to have, because its wheels slide
/// sideways in a turn: yaw rate = (v_right - v_left) / effective track. Derivations in
/// vehicles/parts/README.md.

#include "engine/api/world_model.h"

namespace vinerow::vehicles {

/// Sliding wheels: B + L^2 / B. Exact on the spot on any soil; within 8 % up to a radius of about
/// seven wheel bases. What vehicles tell as "effective_track_m".
double calc_effective_track_m(double track_m, double wheel_base_m);

/// Wheels of small slip, in turns of more than about fifty wheel bases: B (1 + (c_y / c_x)(L /
/// B)^2).
double calc_small_slip_track_m(double track_m, double wheel_base_m, const Soil& soil);

}  // namespace vinerow::vehicles
