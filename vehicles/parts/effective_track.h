#pragma once
/// Effective track of a four-wheeled skid-steered vehicle, larger than its track because the wheels
/// slide sideways in a turn: yaw rate = (v_right - v_left) / effective track. Derivations in
/// vehicles/parts/README.md.

namespace vinerow::vehicles {

/// Sliding wheels: B + L^2 / B. Exact on the spot on any soil; within 8 % up to a radius of about
/// seven wheel bases. It is the number "effective_track_m" of vehicle descriptions.
double calc_effective_track_m(double track_m, double wheel_base_m);

}  // namespace vinerow::vehicles
