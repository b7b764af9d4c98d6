#pragma once
/// Ultrasonic echoes: strength of each return, and detection of the first one.
///
/// Strength of one ray = its share of the sound x reflectance of the surface x spreading.
/// - Share: solid angle x beam pattern out and back, 2^-(off axis / beam_half_power)^2.
/// - Surface: rough or leafy surfaces scatter with Lambert's cosine (leaves have all orientations,
///   so they lose at most half of it). Hard smooth ones reflect like a mirror,
///   exp(-(incidence / smooth_lobe)^2), and scatter little. The mesh of a round post has flat
///   faces, so posts and trunks always scatter.
/// - Spreading: (1 m / r)^2 for the outgoing sound of a ray and the return from its patch, and the
///   air's absorption in both directions.
/// Strength 1 is a perfect reflector that fills the cone at 1 m. Returns within one pulse length
/// add up. If the sum reaches the threshold, the first of them is the range; otherwise the next is
/// tried.
///
/// Sources. Absorption: ISO 9613-1 gives 1.32 dB/m at 40 kHz, 20 degC, 50 % humidity. Pulse: 8
/// periods of 40 kHz (HC-SR04 data sheet) are 34 mm of range. Threshold, smooth lobe and the
/// scatter of round objects are fitted to a measured HC-SR04 (Dyrkacz, "HC-SR04 beam tests", 2020)
/// and the manufacturer's figures of its twin (Parallax PING))) product guide): a plate of 33 x 38
/// mm is detected at 1.5 m and lost at 1.85 m, a slat of 25 mm detected at 2.15 m and lost at 2.45
/// m, a cylinder of 89 mm detected at 1.66 m and lost at 2.29 m. Leaves and ground: chosen.

#include <span>
#include <vector>

#include "engine/api/parameter_table_fwd.h"
#include "engine/api/surface.h"
#include "engine/math/angles.h"

namespace vinerow::sensors {

struct EchoParams {
  double threshold = 0.0;  ///< 0: every return is detected
  double pulse_m = 0.034;  ///< half of the pulse's length in air
  double beam_half_power_rad = rad_from_deg(15.0);
  double absorption_db_per_m = 1.3;
  double canopy_scatter = 0.2;
  double ground_scatter = 0.05;
  double stem_scatter = 0.2;  ///< posts and trunks
  double smooth_scatter = 0.01;
  double smooth_lobe_rad = rad_from_deg(7.0);
};

/// `echo_threshold`, `echo_pulse_m` and the other names of EchoParams.
const ParameterTable<EchoParams>& echo_table();

/// Two-way beam pattern, 1 on the axis.
double beam_pattern(const EchoParams& params, double off_axis_rad);

/// Echo of a surface, relative to a perfect reflector. @param cos_incidence  1 = normal incidence
double surface_echo(const EchoParams& params, SurfaceClass surface, double cos_incidence);

/// Loss by spreading and absorption, 1 at 1 m. @param distance_m > 0
double echo_spreading(const EchoParams& params, double distance_m);

struct EchoReturn {
  double distance_m;
  double strength;
};

/// @param returns  of one pulse, in any order; sorted by distance on return
/// @returns distance of the first detected return, m; infinity without one. No heap.
double first_echo_m(const EchoParams& params, std::span<EchoReturn> returns);

}  // namespace vinerow::sensors
