#pragma once
/// Errors of a receiver's position and velocity in each of its modes.
///
/// Per axis: error = s (white_std n + walk_std g), with n white and g a first-order Gauss-Markov
/// process of unit variance and the mode's `walk_time_s` (each mode has its own g, which runs on
/// while another mode rules), and s the dilution of that axis over the usual one, at which the
/// mode's figures hold: that of code for standalone and SBAS, of carrier phase for float and fixed.
/// Velocity: white, s of the dilution of position as a whole. RTK's walk has beside its own 1 mm
/// per km of `baseline_m` (ZED-F9P data sheet: 1 ppm).

#include <array>
#include <string>
#include <vector>

#include "engine/api/messages/sensors.h"
#include "engine/api/parameters.h"
#include "engine/core/random.h"
#include "engine/sensors/gauss_markov.h"
#include "engine/sensors/gnss_geometry.h"

namespace vinerow {

/// Of one mode, at the usual dilution.
struct GnssModeError {
  double white_std_m[2];  ///< horizontal (each axis), vertical
  double walk_std_m[2];
  double walk_time_s;
  double velocity_std_mps;
  double usual_dop[2];  ///< horizontal, vertical, at which these hold
};

/// Indexed by mode - 1: standalone, SBAS, float, fixed.
using GnssModeErrors = std::array<GnssModeError, 4>;

/// `standalone_white_std_m` [horizontal, vertical], `standalone_walk_std_m`,
/// `standalone_walk_time_s`, `standalone_velocity_std_mps`, the same of `sbas`, `float` and
/// `fixed`; `code_usual_dop` [horizontal, vertical], `carrier_usual_dop`, `baseline_m`.
std::vector<ParameterSpec> gnss_error_parameters();
GnssModeErrors read_gnss_errors(const ParameterSet& parameters);

class GnssError {
 public:
  GnssError(const GnssModeErrors& modes, double period_s, RandomStream random);

  /// One tick, whether there is a fix or not: always draws the same count of numbers.
  void draw();

  /// Adds errors to an exact fix, and says how large they may be.
  /// @param fix  its mode is not kNone
  void apply(const Dilution& dilution, GnssFix& fix) const;

 private:
  GnssModeErrors modes_;
  RandomStream random_;
  std::array<std::array<GaussMarkov, 3>, 4> walks_;  ///< of mode and axis
  Eigen::Vector3d white_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_white_ = Eigen::Vector3d::Zero();
};

}  // namespace vinerow
