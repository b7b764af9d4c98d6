#pragma once
/// Dryden turbulence of MIL-F-8785C (1980), section 3.7, low altitude, along a path through frozen
/// air.
///
/// One-sided spectra over the wave number W in rad/m, with the variance as their integral:
///   u: s_u^2 (2 L_u / pi) / (1 + (L_u W)^2)
///   v, w: s^2 (L / pi) (1 + 3 (L W)^2) / (1 + (L W)^2)^2
/// u along the mean wind, v to its left, w up. Heights in feet, clipped to 10..1000 ft (3.048 to
/// 304.8 m: below and above, the values at the limits hold):
///   L_w = h, L_u = L_v = h / (0.177 + 0.000823 h)^1.2
///   s_w = 0.1 W20, s_u = s_v = s_w / (0.177 + 0.000823 h)^0.4
/// The shaping filters run in x = distance / L with unit variance and are discretised exactly, so
/// that neither the step nor a change of airspeed or height alters variance or spectrum: only the
/// scales change. No heap.

#include <Eigen/Core>

#include "engine/core/random.h"

namespace vinerow::vehicles {

struct DrydenScales {
  double length_uv_m = 0.0;
  double length_w_m = 0.0;
  double sigma_uv_mps = 0.0;
  double sigma_w_mps = 0.0;
};

/// @param height_m  above the ground, any value  @param wind_20ft_mps  >= 0
DrydenScales calc_dryden_scales(double height_m, double wind_20ft_mps);

class DrydenTurbulence {
 public:
  /// Starts in the steady state.
  explicit DrydenTurbulence(RandomStream random);

  /// Advances by a distance through the air. Draws five normal numbers. @param distance_m  >= 0
  void advance(double distance_m, const DrydenScales& scales);
  /// u, v, w in units of their standard deviations.
  Eigen::Vector3d unit() const;

 private:
  /// Second-order filter (1 + sqrt(3) s) / (1 + s)^2 on white noise: output
  /// sqrt(3) a + (1 - sqrt(3)) b with a' = -a + noise, b' = -b + a.
  struct Transverse {
    double a, b;
  };

  RandomStream random_;
  double u_;
  Transverse v_, w_;
};

}  // namespace vinerow::vehicles
